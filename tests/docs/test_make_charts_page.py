"""One sentence says what all charts were measured on, so they must have been measured on the same."""

import json

import pytest
from make_charts_page import CHARTS, SCENES, made_with


def test_charts_of_different_machines_are_refused():
    one, other = {"made_with": {"processor": "a"}}, {"made_with": {"processor": "b"}}
    assert made_with({"G1": one, "F1": one}) == {"processor": "a"}
    with pytest.raises(ValueError, match="F1: not measured on"):
        made_with({"G1": one, "F1": other})


def test_those_of_the_page_are_of_one_machine():
    charts = {name: json.loads((CHARTS / f"{name}.json").read_text(encoding="utf-8")) for name in SCENES}
    assert made_with(charts)["processor"]
