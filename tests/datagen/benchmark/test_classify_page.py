"""docs/classify.md explains what reports of `classify` hold."""

import json
import re
from pathlib import Path

import pytest

from labels.features.table import FEATURE_NAMES

pytestmark = pytest.mark.usefixtures("short_records_are_judged")


def explained(head):
    """The names in the first column of a table of docs/classify.md that begins with this head."""
    page = (Path(__file__).parents[3] / "docs" / "classify.md").read_text(encoding="utf-8")
    rows = page.split(f"| {head} | meaning |\n")[1].split("\n\n")[0].splitlines()[1:]
    return [name for row in rows for name in re.findall(r"`([^`]+)`", row.split("|")[1])]


def test_the_page_explains_every_column_and_key_of_the_reports(classify, tmp_path):
    done, report = classify("--estimator", "own_estimators:Guesser", "--out", tmp_path / "scores")
    assert done.exit_code == 0, done.output
    assert {path.name for path in (tmp_path / "scores").iterdir()} == {"report.csv", "report.json", "report.png"}
    assert (tmp_path / "scores" / "report.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads((tmp_path / "scores" / "report.json").read_text()) == report
    assert set(report["importances"]["Guesser"]) == set(FEATURE_NAMES)
    (tested,) = report["tests"]
    keys = explained("key of `report.json`")
    assert set(keys) == {*report, "learning_curve", *tested}
    scores = explained("key of a model's scores")
    assert set(scores) == {*tested["models"]["Guesser"], *tested["models"]["rule"]}
    columns = explained("column of `report.csv`")
    shown = [column.replace("MODEL", model) for model in ("rule", "Guesser") for column in columns if "MODEL" in column]
    with (tmp_path / "scores" / "report.csv").open() as file:
        assert file.readline().strip().split(",") == [*(one for one in columns if "MODEL" not in one), *shown]
    assert {"faults", "race", "AUC", "false alarms", "rejected"} <= set(explained("in that line"))
