"""The JSON Schema of recipes: current, complete, and of one opinion with the reader of recipes."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from datagen.distributions.kinds import NAMES
from datagen.recipes.recipe_files import shipped_recipes
from datagen.recipes.recipe_schema import recipe_schema, schema_text

DATASETS = Path(__file__).parents[3] / "datasets"
TYPES = {"number": (int, float), "integer": int, "string": str, "boolean": bool, "array": list, "object": dict}
SCHEMA = recipe_schema()
SUFFIXES = {
    "µm": "_um", "mm": "_mm", "degrees": "_deg", "rpm": "_rpm", "Hz": "_hz", "kg": "_kg", "N/m": "_n_per_m",
    "N s/m": "_n_s_per_m", "N": "_n", "m/s²": "_m_s2", "s": "_s", "dB": "_db", "µs": "_us", "mm/s": "_mm_per_s",
    "N/mⁿ": "_n_per_m_to_n",
}  # fmt: skip


def accepts(schema: dict[str, Any], value: Any) -> bool:
    """Whether `value` is valid: the keywords that the schema of recipes uses, and no other."""
    rules = {
        "$ref": lambda to: accepts(SCHEMA["$defs"][to.removeprefix("#/$defs/")], value),
        "allOf": lambda schemas: all(accepts(one, value) for one in schemas),
        "anyOf": lambda options: any(accepts(option, value) for option in options),
        "enum": lambda allowed: any(type(option) is type(value) and option == value for option in allowed),
        "const": lambda only: only == value,
        "type": lambda name: isinstance(value, TYPES[name]) and (name == "boolean") == isinstance(value, bool),
        "minimum": lambda low: value >= low,
        "exclusiveMinimum": lambda low: value > low,
        "maximum": lambda high: value <= high,
        "pattern": lambda text: re.search(text, value) is not None,
        "minLength": lambda length: len(value) >= length,
        "maxLength": lambda length: len(value) <= length,
        "minItems": lambda length: len(value) >= length,
        "maxItems": lambda length: len(value) <= length,
        "items": lambda item: all(accepts(item, one) for one in value),
        "prefixItems": lambda items: all(map(accepts, items, value)),
        "required": lambda keys: set(keys) <= set(value),
        "properties": lambda known: all(accepts(known[key], value[key]) for key in value if key in known),
        "additionalProperties": lambda free: free or set(value) <= set(schema["properties"]),
    }
    ignored = {"$schema", "$defs", "description", "default"}
    in_order = sorted(schema.keys() - ignored, key=lambda rule: rule != "type")
    return all(rules[rule](schema[rule]) for rule in in_order)


def test_the_committed_schema_is_the_current_one() -> None:
    committed = (DATASETS / "recipe.schema.json").read_text(encoding="utf-8")
    assert committed == schema_text(), "run: spallgen schema --out datasets/recipe.schema.json"


@pytest.mark.parametrize("name", sorted(shipped_recipes()))
def test_every_shipped_recipe_is_valid_and_points_editors_to_the_schema(name: str) -> None:
    text = shipped_recipes()[name].read_text(encoding="utf-8")
    assert text.splitlines()[0] == "#:schema ../recipe.schema.json"
    assert accepts(SCHEMA, tomllib.loads(text))


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("depth_um", "depht_um"),
        ("log_uniform = [4, 25]", "log_unifrom = [4, 25]"),
        ("log_uniform = [4, 25]", "log_uniform = [-4, 25]"),
        ("log_uniform = [4, 25]", "log_uniform = [4, 25, 26]"),
        ('condition = {choice = ["healthy"', 'condition = {choice = ["healty"'),
        ("rate_hz = 65536", 'rate_hz = "fast"'),
        ("seed = 2097", ""),
        ('compression = "zlib"', 'compression = "zip"'),
        ("clean = true", "clean = 1"),
        ("records = 15", "records = 0"),
    ],
)
def test_what_the_reader_refuses_the_schema_refuses(right: str, wrong: str) -> None:
    text = shipped_recipes()["quickstart"].read_text(encoding="utf-8")
    assert right in text
    assert not accepts(SCHEMA, tomllib.loads(text.replace(right, wrong, 1)))


def test_every_key_has_a_description_and_no_null() -> None:
    undescribed = [
        (name, key)
        for name, table in SCHEMA["$defs"].items()
        for key, value in table.get("properties", {}).items()
        if "description" not in value
    ]
    assert undescribed == []
    assert '"null"' not in schema_text()
    assert ": null" not in schema_text()


def test_every_default_is_a_value_that_a_recipe_may_give() -> None:
    refused = [
        (name, key, value["default"])
        for name, table in SCHEMA["$defs"].items()
        for key, value in table.get("properties", {}).items()
        if "default" in value and not accepts(value, value["default"])
    ]
    assert refused == []


def test_a_key_carries_the_unit_that_its_description_states_and_no_other() -> None:
    units = "|".join(re.escape(unit) for unit in sorted(SUFFIXES, key=len, reverse=True))
    for table in SCHEMA["$defs"].values():
        for key, value in table.get("properties", {}).items():
            stated = re.findall(rf", ({units})(?=[.;,:]|$)", value["description"])
            carried = [suffix for suffix in SUFFIXES.values() if key.endswith(suffix)]
            assert bool(stated) == bool(carried), key
            assert not stated or any(SUFFIXES[unit] in carried for unit in stated), key


def test_a_setting_takes_a_bare_value_of_its_range_or_any_distribution_of_such_values() -> None:
    spall = SCHEMA["$defs"]["SpallSettings"]
    assert spall["additionalProperties"] is False
    depth = spall["properties"]["depth_um"]
    assert "µm" in depth["description"]
    assert accepts(depth, 12)
    assert not accepts(depth, -12)
    kind = SCHEMA["$defs"][depth["allOf"][0]["$ref"].removeprefix("#/$defs/")]["anyOf"]
    assert kind[0] == {"type": "number", "minimum": 0.0, "maximum": 10000.0}
    assert [next(iter(table["properties"])) for table in kind[1:]] == list(NAMES)
    race = SCHEMA["$defs"]["DefectSettings"]["properties"]["race"]
    assert accepts(race, {"balanced": ["outer", "inner"], "weights": [2, 1]})
    assert not accepts(race, {"balanced": ["outer", "inner"], "weights": [2.5, 1]})


def test_the_schema_is_plain_json() -> None:
    assert json.loads(schema_text()) == SCHEMA
