"""One sentence says what all charts were measured on, so they must have been measured on the same."""

import json

import pytest
from make_charts_page import CHARTS, PAGE, SCENES, accuracies, made_with, simpler, speeds


def test_charts_of_different_machines_are_refused():
    one, other = {"made_with": {"processor": "a"}}, {"made_with": {"processor": "b"}}
    assert made_with({"G1": one, "F1": one}) == {"processor": "a"}
    with pytest.raises(ValueError, match="F1: not measured on"):
        made_with({"G1": one, "F1": other})


@pytest.mark.parametrize("table", [speeds, accuracies, simpler])
def test_the_page_holds_the_tables_of_the_charts_beside_it(table):
    charts = {name: json.loads((CHARTS / f"{name}.json").read_text(encoding="utf-8")) for name in SCENES}
    lines = table(charts)
    assert f"-->\n{lines}\n<!--" in PAGE.read_text(encoding="utf-8")
