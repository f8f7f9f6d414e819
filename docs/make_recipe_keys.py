"""Writes docs/recipe_keys.md, every key of a recipe, from its settings: python docs/make_recipe_keys.py."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from datagen.cards.toml_text import toml_text
from datagen.distributions.distribution import Distribution
from datagen.files.text_tables import markdown_table
from datagen.recipes.recipe import Recipe
from datagen.recipes.recipe_schema import recipe_schema
from datagen.settings.docstrings import setting_docstrings
from datagen.settings.table import Table

PAGE = Path(__file__).with_name("recipe_keys.md")
HEAD = """# Every key of a recipe

Written by `docs/make_recipe_keys.py` from the settings themselves (`datagen/recipes/`), by which recipes are checked.
[datasets/README.md](../datasets/README.md) says how to write one. A unit is the end of a key and stands
in its meaning. *Drawn* marks what may be drawn from a distribution, `{uniform = [4, 25]}` and the like, and must be in
that range however it is drawn. Where no other reason is given, a range reaches far beyond all machines; past its ends
numbers overflow, lose their decimals or no longer fit what is stored. A key without a default may be left out unless it
is **required**; what holds then is in its meaning, in `[part.machine]` the rig's number in the catalogue, and where
nothing is said there is none of it.
"""
TOP = "top level"


def page() -> str:
    """The page's text."""
    return HEAD + "".join(_section(table, paths) for table, paths in _places().items())


def _places() -> dict[type[BaseModel], list[str]]:
    """Every table of a recipe, with the headings under which it may stand."""
    found: dict[type[BaseModel], list[str]] = {}
    for table, path in _walk(Recipe, "", False):
        owners = [base for base in table.__mro__ if issubclass(base, Table) and base is not Table]
        for owner in owners:
            found.setdefault(owner, []).append(path)
    return found


def _walk(table: type[BaseModel], path: str, listed: bool) -> Iterator[tuple[type[BaseModel], str]]:
    heading = f"[[{path}]]" if listed else f"[{path}]"
    yield table, f"`{heading}`" if path else TOP
    for name, field in _fields(table).items():
        inner = _table_of(field)
        if inner is not None:
            yield from _walk(inner, f"{path}.{name}" if path else name, _is_list(field))


def _fields(table: type[BaseModel]) -> dict[str, FieldInfo]:
    """The keys that a recipe may write; what is found out while it is read is no key."""
    return {name: field for name, field in table.model_fields.items() if not field.exclude}


def _section(table: type[BaseModel], paths: list[str]) -> str:
    stated = {name: field for name, field in _fields(table).items() if name in table.__annotations__}
    meanings = setting_docstrings(table)
    rows = [[f"`{name}`", _kind(table, name), _default(field), meanings[name]] for name, field in stated.items()]
    said = " ".join((table.__doc__ or "").split())
    keys = markdown_table(["key", "takes", "default", "meaning"], rows)
    return "\n".join(["", f"## {', '.join(paths)}", "", said, "", keys, ""])


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "**required**"
    value = field.default
    if isinstance(value, Distribution):
        value = value.to_toml()
    if value is None or isinstance(value, BaseModel) or value in ("", ()) or _is_placeholder(value, field):
        return ""
    return f"`{toml_text({'key': value}).strip().removeprefix('key = ')}`"


def _is_placeholder(value: Any, field: FieldInfo) -> bool:
    """True for a default that a recipe could not state, which stands for what is found out on reading."""
    if not isinstance(value, int | float):
        return False
    above, least = ([getattr(note, name, -math.inf) for note in field.metadata] for name in ("gt", "ge"))
    return any(value <= bound for bound in above) or any(value < bound for bound in least)


def _kind(table: type[BaseModel], name: str) -> str:
    """What the key takes, in words."""
    field = table.model_fields[name]
    inner = _table_of(field)
    if inner is not None:
        return "list of tables" if _is_list(field) else "table"
    settings = [note for note in (*field.metadata, *_notes(field.annotation)) if hasattr(note, "allowed")]
    if settings:
        return f"{_words(settings[0].allowed())}, *drawn*"
    schemas = _schemas()
    owner = schemas if table is Recipe else schemas["$defs"][table.__name__]
    return _plain(owner["properties"][name])


@cache
def _schemas() -> dict[str, Any]:
    """The JSON Schema of recipes, of which every key asks for its part."""
    return recipe_schema()


def _plain(schema: dict[str, Any]) -> str:
    """What a key that is never drawn takes, from its JSON Schema."""
    if "enum" in schema:
        return _words(", ".join(schema["enum"]))
    kind = {"string": "text", "boolean": "true, false", "integer": "a whole number", "number": "a number"}
    if schema["type"] == "array":
        inner = schema.get("prefixItems", [schema.get("items")])[0]
        least, most = schema["minItems"], schema["maxItems"]
        return f"list of {least if least == most else f'{least} or {most}'}: {_plain(inner)}"
    above, low, high = schema.get("exclusiveMinimum"), schema.get("minimum"), schema.get("maximum")
    words = kind[schema["type"]]
    words += "" if above is None else f" above {above:g}"
    words += "" if low is None else f" from {low:g}"
    return words + ("" if high is None else f" to {high if isinstance(high, int) else format(high, 'g')}")


def _words(allowed: str) -> str:
    """A closed list of words as they are written in a recipe; other text as it is."""
    if allowed.startswith("a "):
        return allowed
    return ", ".join(f"`{word.lower()}`" for word in allowed.split(", "))


def _notes(annotation: Any) -> Iterator[Any]:
    """The annotations inside `Annotated[…] | None`."""
    for part in get_args(annotation):
        yield from getattr(part, "__metadata__", ())


def _is_list(field: FieldInfo) -> bool:
    return getattr(field.annotation, "__origin__", None) is tuple


def _table_of(field: FieldInfo) -> type[BaseModel] | None:
    """The table that a key holds, alone or in a list; None for a plain value."""
    for kind in (field.annotation, *get_args(field.annotation)):
        if isinstance(kind, type) and issubclass(kind, Table):
            return kind
    return None


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
