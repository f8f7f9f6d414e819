"""The examples of docs/own_estimators.md, run as they stand on the page, and its tables."""

import re
import shlex
import sys
from dataclasses import fields
from pathlib import Path

import numpy as np
import pandas
import pytest
from command_line import run
from marked_tables import write_marked

from datagen.benchmark.impulse_signal import Ingredients
from labels.classifier.classes import CLASSES

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "own_estimators.md").read_text(encoding="utf-8")
BLOCKS = dict(re.findall(r"^```python\n# (\w+)\.py\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL))
LINES = re.findall(r"^```bash\n(.*?)\n```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture
def where_the_examples_are(tmp_path, monkeypatch, short_records_are_judged):
    """A user's folder with the modules of the page; records shorter than are judged otherwise count."""
    for name, text in BLOCKS.items():
        (tmp_path / f"{name}.py").write_text(text)
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))


@pytest.fixture
def divided(copy):
    """A copy of the tiny corpus in which every fourth bearing is of the split test."""
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index["split"] = np.where(index["bearing_id"].isin(sorted(index["bearing_id"].unique())[::4]), "test", "train")
    index.to_csv(copy / "index.csv", index=False)
    return copy


# A forest of so many trees learns for twenty seconds.
@pytest.mark.parametrize(
    "line", [pytest.param(line, marks=pytest.mark.slow if "my_forest" in line else ()) for line in LINES]
)
def test_every_example_runs_as_it_stands(line, divided, where_the_examples_are):
    command = re.sub(r"out/\w+", str(divided), line).removeprefix("spallgen ")
    done = run(*shlex.split(command), "--json", "result.json")
    assert done.exit_code == 0, done.output


def test_the_page_has_an_example_of_each_kind_and_a_command_for_each_module():
    assert [re.search(r"--estimator (\w+):", line).group(1) for line in LINES] == list(BLOCKS)
    assert sum("--input windows" in line for line in LINES) == 1
    assert sum(line.startswith("spallgen size") for line in LINES) == 1


def test_the_page_names_the_classes_in_their_order():
    assert f"    {', '.join(CLASSES)}\n" in PAGE


def test_the_page_names_every_ingredient_of_an_impulse_train():
    section = PAGE.split("impulse-trains-without-INGREDIENT")[1].split("\n## ")[0]
    assert re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE) == [field.name for field in fields(Ingredients)]


def test_the_tables_are_those_that_the_script_writes(load_script, tmp_path):
    script = load_script("make_own_estimators")
    copy = tmp_path / "page.md"
    copy.write_text(PAGE, encoding="utf-8")
    for name, text in script.tables().items():
        write_marked(copy, name, script.__file__, text)
    assert copy.read_text(encoding="utf-8") == PAGE, "run: python docs/make_own_estimators.py"
