"""What tests of the benchmark share."""

import json
import shutil
import sys

import numpy as np
import pandas
import pytest
from command_line import run

from datagen.recipes.recipe import load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine


@pytest.fixture(scope="session")
def other_corpus(tiny_recipe, tmp_path_factory):
    """The whole corpus of the tiny recipe with another seed, that is of other machines."""
    place = tmp_path_factory.mktemp("other")
    (place / "recipe.toml").write_text(tiny_recipe.read_text().replace("seed = 7", "seed = 8"))
    assert generate(load_recipe(place / "recipe.toml"), place / "corpus", engine=Engine(workers=1)).complete
    return place / "corpus"


@pytest.fixture
def classify(tiny_corpus, other_corpus, tmp_path, monkeypatch):
    """Function (*options) → results of `spallgen classify` learned from the tiny corpus and scored on another."""
    (tmp_path / "own_estimators.py").write_text(
        f"import sys\nsys.path.insert(0, {str(tmp_path)!r})\n"
        "import numpy as np\n"
        "class Guesser:\n"
        "    def fit(self, X, y):\n"
        "        self.classes_, counts = np.unique(y, return_counts=True)\n"
        "        self.shares = counts / counts.sum()\n"
        "        return self\n"
        "    def predict_proba(self, X):\n"
        "        return np.tile(self.shares, (len(X), 1))\n"
        "def always_outer(table):\n"
        "    return np.full(len(table), 'line outer')\n"
        "def of_two(table, rate):\n"
        "    return None\n"
        "def rule(table):\n"  # as another model and a column of facts are called in reports
        "    return np.full(len(table), 'line outer')\n"
        "def rejected(table):\n"
        "    return np.full(len(table), 'line outer')\n"
        "nothing = None\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    for module in ("own_estimators", "own_curves"):
        monkeypatch.delitem(sys.modules, module, raising=False)

    def classified(*options):
        file = tmp_path / "results.json"
        command = [
            "classify",
            "--train",
            tiny_corpus,
            "--test",
            other_corpus,
            "--workers",
            "1",
            "--json",
            file,
            *options,
        ]
        done = run(*command)
        return done, json.loads(file.read_text()) if done.exit_code == 0 else None

    return classified


@pytest.fixture
def divided(tiny_corpus, tmp_path):
    """A copy of the tiny corpus in which every fourth bearing is of the split test and every second of validation."""
    copy = tmp_path / "divided"
    shutil.copytree(tiny_corpus, copy)
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    bearings = sorted(index["bearing_id"].unique())
    index["split"] = np.where(index["bearing_id"].isin(bearings[1::2]), "validation", "train")
    index.loc[index["bearing_id"].isin(bearings[::4]), "split"] = "test"
    index.to_csv(copy / "index.csv", index=False)
    return copy
