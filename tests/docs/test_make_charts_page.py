"""One sentence says what all charts were measured on, so they must have been measured on the same."""

import pytest
from make_charts_page import PAGE, TABLES, made_with, read


def test_charts_of_different_machines_are_refused():
    one, other = {"made_with": {"processor": "a"}}, {"made_with": {"processor": "b"}}
    assert made_with({"G1": one, "F1": one}) == {"processor": "a"}
    with pytest.raises(ValueError, match="F1: not measured on"):
        made_with({"G1": one, "F1": other})


@pytest.mark.parametrize("name", TABLES)
def test_the_page_holds_the_tables_of_the_charts_beside_it(name):
    table, scenes = TABLES[name]
    made = table(read(scenes))
    assert f"<!-- {name}: begin (written by docs/make_charts_page.py) -->\n{made}\n<!--" in PAGE.read_text("utf-8")
