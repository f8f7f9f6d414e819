"""The page on accuracy holds what was measured, and its picture every scene that it counts."""

import json

import numpy as np
from make_accuracy import DOCS, SETS, draw, judged_rows, table


def test_the_scenes_that_are_judged_are_those_that_the_benchmark_counted():
    for name in SETS.values():
        assert len(judged_rows(name)) == json.loads((DOCS / name).read_text(encoding="utf-8"))["summary"]["judged"]


def test_the_page_holds_the_table_of_the_stored_measurements():
    assert f"-->\n{table()}\n<!--" in (DOCS / "accuracy.md").read_text(encoding="utf-8")


def test_every_dot_that_the_legend_counts_lies_on_the_panel():
    [axes] = draw().axes
    for dots in axes.lines[: len(SETS)]:
        place, (low, high), (bottom, top) = dots.get_xydata(), axes.get_xlim(), axes.get_ylim()
        assert str(dots.get_label()).startswith(f"{len(place)} scenes")
        assert np.all((low < place[:, 0]) & (place[:, 0] < high))
        assert np.all((bottom < place[:, 1]) & (place[:, 1] < top))
