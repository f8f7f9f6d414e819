"""docs/features.md: written from the code, and its examples run as they stand there."""

import re
import shlex
from pathlib import Path

import numpy as np
import pandas
import pytest
from command_line import run
from marked_tables import write_marked

from datagen.benchmark.feature_table import COLUMNS, OF_ROW
from labels.features.table import FEATURE_NAMES

PAGE = (Path(__file__).parents[2] / "docs" / "features.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
LINES = re.findall(r"^```bash\n(.*?)\n```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture
def beside_a_corpus(tiny_corpus, tmp_path, monkeypatch, short_records_are_judged):
    """A user's folder with a corpus, of records shorter than are judged otherwise."""
    (tmp_path / "quickstart-corpus").symlink_to(tiny_corpus, target_is_directory=True)
    monkeypatch.chdir(tmp_path)


def test_the_table_is_what_the_script_writes(load_script, tmp_path):
    script, copy = load_script("make_features"), tmp_path / "page.md"
    copy.write_text(PAGE, encoding="utf-8")
    write_marked(copy, "features", script.__file__, script.table())
    assert copy.read_text(encoding="utf-8") == PAGE, "run: python docs/make_features.py"


def test_the_page_explains_every_column():
    section = PAGE.split("## How to get them")[1]
    named = re.findall(r"`(\w+)`", "".join(re.findall(r"^(\|[^|]*\|)", section, re.MULTILINE)))
    assert set(named) >= set(COLUMNS) - set(FEATURE_NAMES)
    assert set(OF_ROW) <= set(named)


@pytest.mark.usefixtures("beside_a_corpus")
def test_the_command_runs_as_it_stands():
    (line,) = LINES
    done = run(*shlex.split(line.removeprefix("spallgen ")))
    assert done.exit_code == 0, done.output
    assert tuple(pandas.read_csv("features.csv").columns) == COLUMNS


@pytest.mark.usefixtures("beside_a_corpus")
def test_the_python_examples_run_as_they_stand():
    names = {}
    for block in BLOCKS:
        exec(block, names)
    assert names["values"].shape == (len(names["judged"]), len(FEATURE_NAMES))
    assert len(names["judged"])
    assert np.isfinite(names["values"]).all()
    assert names["machines"].str.startswith("quickstart-corpus/tiny-").all()
    assert tuple(names["found"]) == FEATURE_NAMES
    assert names["found"]["kurtosis"] == pytest.approx(np.log(3.0), abs=0.1)  # of white noise
