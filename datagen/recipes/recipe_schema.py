"""JSON Schema of recipes: completion, help and checks while a recipe is written, in any editor that reads schemas."""

from __future__ import annotations

import json
import re
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from datagen.distributions.distribution import Distribution
from datagen.recipes.recipe import Recipe
from datagen.settings.docstrings import setting_docstrings

DIALECT = "https://json-schema.org/draft/2020-12/schema"
NULL = {"type": "null"}


class _AsWritten(GenerateJsonSchema):
    """Defaults as a recipe writes them, and every setting with what is said of it."""

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        table = super().model_schema(schema)
        shown = table["properties"]
        said = setting_docstrings(schema["cls"])
        shown |= {name: {"description": said[name]} | shown[name] for name in said.keys() & shown.keys()}
        return table

    def encode_default(self, dft: Any) -> Any:
        return dft.to_toml() if isinstance(dft, Distribution) else super().encode_default(dft)


def recipe_schema() -> dict[str, Any]:
    """JSON Schema of a recipe; each kind of setting, such as "a number from 0", is defined once."""
    raw = Recipe.model_json_schema(schema_generator=_AsWritten)
    kinds: dict[str, Any] = {}
    defined = {name: _tidy(table, kinds) for name, table in raw.pop("$defs").items()}
    return {"$schema": DIALECT} | _tidy(raw, kinds) | {"$defs": dict(sorted((defined | kinds).items()))}


def schema_text() -> str:
    """The schema as the text of a file."""
    return json.dumps(recipe_schema(), indent=1, ensure_ascii=False) + "\n"


def _is_noise(key: str, value: Any) -> bool:
    """True for a default of null and for the title that repeats a key (a setting called "title" is a table)."""
    return (key == "default" and value is None) or (key == "title" and isinstance(value, str))


def _repeats(key: str, node: dict[str, Any]) -> bool:
    """True for the default of a table, which only repeats those of its settings."""
    return key == "default" and "$ref" in node


def _tidy(node: Any, kinds: dict[str, Any]) -> Any:
    """`node` without null, which TOML lacks, and without noise, its settings moved to `kinds` and referred to."""
    if isinstance(node, list):
        return [_tidy(item, kinds) for item in node]
    if not isinstance(node, dict):
        return node
    kept = {key: value for key, value in node.items() if not _is_noise(key, value) and not _repeats(key, node)}
    options = [option for option in kept.get("anyOf", []) if option != NULL]
    if len(options) == 1:
        kept = {key: value for key, value in kept.items() if key != "anyOf"} | options[0]
    if "setting" not in kept:
        return {key: _tidy(value, kinds) for key, value in kept.items()}
    name = re.sub(r"[^A-Za-z0-9.-]+", "_", kept.pop("setting"))
    kinds[name] = {"anyOf": kept.pop("anyOf")}
    # Older drafts, which editors still follow, read nothing beside a bare reference.
    return {"allOf": [{"$ref": f"#/$defs/{name}"}]} | kept
