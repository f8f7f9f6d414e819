"""What load and Hertz factor add to a size is told of the records that are given one both ways."""

import make_size_page

RECORD = {"true_lag": 1e-3, "rate": 65536.0, "pass_period": 1e-2, "extent_spacing": 0.2, "true_extent": 0.1}


def rows(extents, **others):
    """A record of a bearing of its own for each of the estimated extents, rad."""
    return [
        RECORD | {"record": place, "bearing_id": f"b{place}", "extent": extent} | others
        for place, extent in enumerate(extents)
    ]


def test_errors_are_compared_on_records_sized_both_ways_alone():
    known, blind = rows([0.11, 0.098, None, 0.2]), rows([0.12, 0.096, 0.1, None])
    # Errors of 10 and 2 % against 20 and 4 %: 6 instead of 12 %, the gains 10 and 2 points.
    said = make_size_page.both_ways(known, blind)
    assert said.startswith("- Of the 2 records")
    assert "smaller by 6.0 (2.0 to 10.0) points: 6.0 % instead of 12.0 % (medians 6.0 % and 12.0 %)." in said


def test_records_that_ask_for_no_size_are_left_out():
    for unasked in ({"true_lag": None, "extent_spacing": None}, {"true_lag": 1e-5}, {"extent_spacing": 1.2}):
        (row,) = rows([0.1], **unasked)
        assert not make_size_page.is_sized(row)
    assert make_size_page.is_sized(RECORD | {"extent": 0.1})
