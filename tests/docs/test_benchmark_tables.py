"""The tables that benchmarks write into pages follow from the measurements stored beside these."""

import json

import make_crossfitted
import pytest
from marked_tables import ROOT

from datagen.versions import in_words
from tests.benchmarks import changed_scenes, costs, judging, orders, pipeline, reference_scenes

DOCS = ROOT / "docs"


def stored(name):
    return json.loads((DOCS / f"{name}.json").read_text(encoding="utf-8"))


def reference_table(report):
    """The table of the README."""
    made = f"Measured on {in_words(report['made_with'])}."
    return reference_scenes.table(report["scenes"], report["rival_real_time_factor"], made)


def had_repeated(names):
    """The same, had these scenes repeated in the longer record."""
    report = stored("reference_scenes")
    rows = {name: row | {"long_repeated": name in names} for name, row in report["scenes"].items()}
    return reference_table(report | {"scenes": rows})


@pytest.mark.parametrize(
    ("page", "name", "table"),
    [
        ("docs/accuracy.md", "changed_scenes", changed_scenes.table),
        ("docs/accuracy.md", "orders", orders.page),
        ("docs/pipeline.md", "costs", costs.page),
        ("docs/pipeline.md", "judging", judging.page),
        ("docs/pipeline.md", "pipeline", pipeline.page),
        ("docs/transfer.md", "crossfitted", make_crossfitted.table),
        ("README.md", "reference_scenes", reference_table),
    ],
)
def test_a_page_holds_the_table_of_the_stored_measurement(page, name, table):
    assert f"-->\n{table(stored(name))}\n<!--" in (ROOT / page).read_text(encoding="utf-8")


def test_the_page_tells_how_line_and_extended_spalls_are_told_apart():
    table = make_crossfitted.conditions(stored("crossfitted"))
    assert f"-->\n{table}\n<!--" in (DOCS / "transfer.md").read_text(encoding="utf-8")


def test_scenes_that_do_not_repeat_in_the_longer_record_are_not_said_to():
    assert "; in 5 s all)" in had_repeated(set(stored("reference_scenes")["scenes"]))
    assert "; in 5 s G1, F1)" in had_repeated({"F1", "G1"})
    assert "; in 5 s none)" in had_repeated(set())
