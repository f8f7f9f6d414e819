"""The bands that signals are searched in."""

from labels.band_tree import band_edges, usable_bandwidth


def test_bands_are_a_tree_and_never_narrower_than_asked():
    assert len(band_edges(8000.0, 500.0)) == 15
    assert len(band_edges(8000.0, 1000.0)) == 15  # eighths are as wide as that
    assert len(band_edges(8000.0, 1500.0)) == 7
    assert band_edges(1000.0, 5000.0).tolist() == [[0.0, 1.0]]


def test_nothing_is_looked_at_above_20_khz_or_next_to_half_the_rate():
    assert usable_bandwidth(100_000.0) == 20_000.0
    assert usable_bandwidth(10_000.0) == 4750.0
    assert usable_bandwidth(10_000.0, 1000.0) == 1000.0
