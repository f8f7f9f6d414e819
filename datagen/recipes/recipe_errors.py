"""From pydantic's list of errors to one clear line about the first of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from datagen.errors import BadInput
from datagen.recipes.spelling import suggestion
from datagen.recipes.toml_lines import Location, line_of

MOST_LISTED = 16
EXPECTED = {
    "string_type": "a text in quotes",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "bool_type": "true or false",
    "tuple_type": "a list (a list of tables has double brackets: [[part]])",
    "model_type": "a table",
    "finite_number": "a finite number",
    "greater_than_equal": "at least {ge}",
    "less_than_equal": "at most {le}",
    "literal_error": "{expected}",
    "string_too_short": "at least {min_length} character",
    "string_too_long": "at most {max_length} characters",
    "too_short": "at least {min_length}",
    "too_long": "exactly {max_length}",
    "string_pattern_mismatch": "letters, digits, - and _, starting with a letter or digit",
}


def bad_recipe(error: ValidationError, model: type[BaseModel], path: Path | str, text: str) -> BadInput:
    """BadInput naming file, line, setting, value and what is allowed of the first error (misspelt keys come first)."""
    errors = sorted(error.errors(), key=lambda one: one["type"] != "extra_forbidden")
    first: dict[str, Any] = dict(errors[0])
    context = first.get("ctx", {})
    location: Location = tuple(first["loc"]) + ((context["field"],) if context.get("field") else ())
    line = line_of(text, location)
    return BadInput(
        _problem(first, location, model),
        f"{path}, line {line}" if line else str(path),
        dotted(location),
        _value(first, location, context.get("field", "")),
        context.get("allowed") or EXPECTED.get(first["type"], "").format(**context),
    )


def _problem(first: dict[str, Any], location: Location, model: type[BaseModel]) -> str:
    kind = first["type"]
    if kind == "missing":
        return "one more value is needed" if isinstance(location[-1], int) else "this setting is missing"
    if kind == "extra_forbidden":
        known = _keys_beside(location, model)
        hint = suggestion(str(location[-1]), known)
        listed = f" (known here: {', '.join(known)})" if not hint or len(known) <= MOST_LISTED else ""
        return f"unknown key{hint}{listed}"
    problem = first.get("ctx", {}).get("problem")
    return str(problem) if problem else "" if kind in EXPECTED or kind == "allowed" else str(first["msg"])


def _value(first: dict[str, Any], location: Location, field: str) -> object:
    if first["type"] in ("missing", "extra_forbidden"):
        return None
    given = first["input"]
    if not field:
        return None if isinstance(given, BaseModel) or location == ("part",) else given
    value = given.get(field) if isinstance(given, dict) else None
    return None if field == "part" else value


def _keys_beside(location: Location, model: type[BaseModel]) -> list[str]:
    table = model
    for step in location[:-1]:
        if isinstance(step, str):
            table = _table_type(table.model_fields[step].annotation) or table
    return list(table.model_fields)


def _table_type(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((found for inner in get_args(annotation) if (found := _table_type(inner))), None)


def dotted(location: Location) -> str:
    """The setting at `location` as a message names it: part[2].defect.depth_um."""
    text = ""
    for step in location:
        text += f"[{step + 1}]" if isinstance(step, int) else f".{step}" if text else step
    return text
