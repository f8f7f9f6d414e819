"""The card of each dataset says what its recipe says, and the page of all datasets what their cards say."""

from __future__ import annotations

import json
import re
import tomllib
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from drawn_settings import as_written, drawn_settings, stated_values

from datagen.inspection.recipe_check import check_recipe
from datagen.recipes.recipe import load_recipe

DATASETS = Path(__file__).resolve().parents[2] / "datasets"
EVERY = sorted(path.parent.name for path in DATASETS.glob("*/recipe.toml"))
LONG = ("corpus", "size_imperfect", "size_training", "transfer")  # every scenario is drawn: seven seconds and more
SHORT_CARDS = [name for name in EVERY if name != "corpus"]  # whose page gives its ranges with their reasons
FACTS = re.compile(r"<!-- facts: begin \(written by docs/make_cards\.py\) -->\n(.*?)\n<!-- facts: end -->", re.DOTALL)


def page(name: str) -> str:
    return (DATASETS / name / "README.md").read_text(encoding="utf-8")


def facts(name: str) -> str:
    """The table of facts as the card has it."""
    (found,) = FACTS.findall(page(name))
    return str(found)


def fact(name: str, of: str) -> str:
    (found,) = re.findall(rf"^\| {of} \| (.+) \|$", facts(name), re.MULTILINE)
    return str(found)


@pytest.fixture
def cards(load_script: Callable[..., ModuleType]) -> ModuleType:
    """The script that writes the facts."""
    return load_script("make_cards")


@pytest.mark.parametrize("name", EVERY)
def test_the_facts_are_those_of_recipe_and_expected_statistics(name: str, cards: ModuleType) -> None:
    expected = json.loads((DATASETS / name / "expected.json").read_text(encoding="utf-8"))
    written = cards.card(load_recipe(name), expected, fact(name, "on the disk"))
    assert facts(name) == written, f"run: python docs/make_cards.py {name}"


@pytest.mark.parametrize("name", EVERY)
def test_records_machines_seed_rate_and_lengths_are_those_of_the_recipes_file(name: str) -> None:
    content = tomllib.loads((DATASETS / name / "recipe.toml").read_text(encoding="utf-8"))
    records = sum(part["records"] for part in content["part"])
    machines = sum(part["records"] // part.get("records_per_machine", 1) for part in content["part"])
    assert fact(name, "records").startswith(f"{records} of {machines} virtual machines, ")
    assert fact(name, "seed") == str(content["seed"])
    length = content["signal"]["duration_s"]
    lengths = length["choice"] if isinstance(length, dict) else [length]
    said = re.fullmatch(r"(.+) s each at (\d+) Hz", fact(name, "signal"))
    assert said is not None
    assert [float(word) for word in re.split(", | or ", said[1])] == lengths
    assert int(said[2]) == content["signal"]["rate_hz"]


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow if n in LONG else ()) for n in EVERY])
def test_the_size_on_the_disk_is_what_check_says(name: str, cards: ModuleType) -> None:
    assert fact(name, "on the disk") == cards.disk_text(check_recipe(name)), f"run: python docs/make_cards.py {name}"


@pytest.mark.parametrize("name", SHORT_CARDS)
def test_each_range_is_the_one_of_the_recipe(name: str) -> None:
    values, kinds = defaultdict(set), defaultdict(set)
    for setting, drawn in drawn_settings(tomllib.loads((DATASETS / name / "recipe.toml").read_text(encoding="utf-8"))):
        values[setting] |= set(map(as_written, stated_values(drawn)))
        kinds[setting] |= set(drawn)
    rows = re.findall(r"^\| `([\w.]+)` \| (.+?) \|$", page(name), re.MULTILINE)
    assert len(rows) == 8
    for setting, stated in rows:
        words = set(re.findall(r"[\w.]+\w|\w", stated))
        assert setting in values
        assert values[setting] <= words, setting
        assert {word for word in words if word[0].isdigit()} <= values[setting], setting
        assert ("log" in words) == ("log_uniform" in kinds[setting]), setting


@pytest.mark.parametrize("name", SHORT_CARDS)
def test_a_card_is_short_and_names_the_command_that_makes_its_dataset(name: str) -> None:
    lines = page(name).splitlines()
    assert len(lines) <= 40
    assert max(map(len, lines)) <= 120
    assert f"spallgen generate {name} --out out/{name}" in lines


def test_the_page_of_all_datasets_names_each_with_its_card_records_and_size() -> None:
    text = (DATASETS / "README.md").read_text(encoding="utf-8")
    rows: dict[str, Any] = {}
    for name, folder, records, purpose in re.findall(
        r"^\| \[`(\w+)`\]\((\w+)/README\.md\) \| (\d+) \| (.+) \|$", text, re.MULTILINE
    ):
        assert name == folder
        rows[name] = (records, re.findall(r"\(about (.+?)\)", purpose))
    assert set(rows) == set(EVERY)
    for name, (records, sizes) in rows.items():
        assert fact(name, "records").startswith(f"{records} of ")
        assert sizes == [re.findall(r"^about (.+?) in ", fact(name, "on the disk"))[0]]
