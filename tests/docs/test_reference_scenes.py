"""The table of the reference scenes follows from what was measured."""

import json

from marked_tables import ROOT

from datagen.versions import in_words
from tests.benchmarks.reference_scenes import table

FACTS = json.loads((ROOT / "docs" / "reference_scenes.json").read_text(encoding="utf-8"))


def said(long_repeated: set[str]) -> str:
    rows = {name: row | {"long_repeated": name in long_repeated} for name, row in FACTS["scenes"].items()}
    return table(rows, FACTS["rival_real_time_factor"], f"Measured on {in_words(FACTS['made_with'])}.")


def test_the_table_of_the_readme_is_that_of_the_stored_measurement():
    assert f"\n{said(set(FACTS['scenes']))}\n" in (ROOT / "README.md").read_text(encoding="utf-8")


def test_scenes_that_do_not_repeat_in_the_longer_record_are_not_said_to():
    assert "; in 5 s all)" in said(set(FACTS["scenes"]))
    assert "; in 5 s G1, F1)" in said({"F1", "G1"})
    assert "; in 5 s none)" in said(set())
