"""From pydantic's list of errors to one clear line about the first of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args, get_origin

from pydantic import BaseModel, ValidationError

from datagen.errors import BadInput, at_line
from datagen.settings.toml_lines import Location, line_of
from physics.spelling import suggestion

MOST_LISTED = 16
# What settings are called elsewhere, where another name lies nearer by its letters.
CALLED_ELSEWHERE = {
    **dict.fromkeys(("fs", "sr", "sample_rate", "sampling_rate", "sampling_frequency"), "rate_hz"),
    **dict.fromkeys(("label", "fault", "fault_type"), "location"),
    "sensitivity": "scale",
    "geometry": "bearing",
}
# Errors of a value that is no number of the kind wanted, which do not tell its range.
NO_NUMBER = ("int_type", "int_from_float", "float_type", "finite_number")
SCALARS = ("str", "float", "int", "bool")
EXPECTED = {
    "string_type": "a text in quotes",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "bool_type": "true or false",
    "tuple_type": "a list (a list of tables has double brackets: [[part]])",
    "model_type": "a table",
    "model_attributes_type": "a table",
    "dict_type": "a table",
    "finite_number": "a finite number",
    "greater_than": "above {gt}",
    "greater_than_equal": "at least {ge}",
    "less_than_equal": "at most {le}",
    "literal_error": "{expected}",
    "string_too_short": "at least {min_length} character",
    "string_too_long": "at most {max_length} characters",
    "too_short": "at least {min_length}",
    "too_long": "at most {max_length}",
    "string_pattern_mismatch": "letters, digits, - and _, starting with a letter or digit",
}


@dataclass(frozen=True)
class _Error:
    """One error as pydantic tells it: its `kind`, the `steps` that lead to it, the value that was `given` there, and
    more in `context` and `sentence`."""

    kind: str
    steps: Location
    given: Any
    context: dict[str, Any]
    sentence: str

    @property
    def unknown_key(self) -> bool:
        """Whether the last step is a key that nobody knows, whatever it looks like."""
        return self.kind == "extra_forbidden"

    @property
    def place(self) -> Location:
        """Where the setting is, without the names of the kinds of value that pydantic tried there."""
        steps, unknown = (self.steps[:-1], self.steps[-1:]) if self.unknown_key else (self.steps, ())
        return (*(step for step in steps if isinstance(step, int) or not _is_kind(step)), *unknown)

    @property
    def field(self) -> tuple[str, ...]:
        """The setting in the table at that place which a rule of the whole table points at; none if it is the place."""
        name = self.context.get("field", "")
        return tuple(name.split(".")) if name else ()

    @property
    def of_a_kind(self) -> bool:
        """Whether it is of one kind of value among several that pydantic tried at the place."""
        return not self.unknown_key and any(map(_is_kind, self.steps[-1:]))

    @property
    def of_a_scalar(self) -> bool:
        """Whether a table was tried as a single value, which says less than what is wrong in the table."""
        return isinstance(self.given, dict) and any(step in SCALARS for step in self.steps[-1:])

    def follows_from(self, errors: list[_Error]) -> bool:
        """True of a list that counts as too short because what stands in it is wrong, by others of the `errors`."""
        size = len(self.steps)
        return self.kind == "too_short" and any(more.steps[:size] == self.steps != more.steps for more in errors)


def bad_settings(invalid: ValidationError, model: type[BaseModel], path: Path | str, text: str) -> BadInput:
    """BadInput naming file, line, setting, value and what is allowed of the first error (misspelt keys come first)."""
    errors = [
        _Error(told["type"], told["loc"], told["input"], told.get("ctx", {}), told["msg"]) for told in invalid.errors()
    ]
    causes = [error for error in errors if not error.follows_from(errors)]
    first = min(causes, key=lambda error: (not error.unknown_key, error.of_a_scalar))
    location = first.place + first.field
    return BadInput(
        _problem(first, location, model),
        file=at_line(path, line_of(text, location)),
        field=dotted(location),
        value=_value(first, location),
        allowed=_allowed(first, [error for error in errors if error.place == first.place])
        + (_range_at(location, model) if first.kind in NO_NUMBER else ""),
    )


def _is_kind(step: str | int) -> bool:
    return isinstance(step, str) and (step in SCALARS or (step[:1].isupper() and step in _tables(BaseModel)))


def _tables(model: type[BaseModel]) -> Iterator[str]:
    """Names of all tables of settings, by which pydantic calls these kinds of value."""
    for kind in model.__subclasses__():
        yield kind.__name__
        yield from _tables(kind)


def _allowed(first: _Error, alike: list[_Error]) -> str:
    """What is allowed; where several kinds of value were tried at the place, all of them."""
    words = [
        error.context.get("allowed") or EXPECTED.get(error.kind, "").format(**error.context)
        for error in (alike if first.of_a_kind else [first])
    ]
    return " or ".join(dict.fromkeys(word for word in words if word))


def _problem(first: _Error, location: Location, model: type[BaseModel]) -> str:
    if first.kind == "missing":
        return "one more value is needed" if isinstance(location[-1], int) else "this setting is missing"
    if first.unknown_key:
        homes = _homes(str(location[-1]), model)
        if homes:
            return f"unknown key here; it belongs {' or '.join(homes)}"
        known = _keys_beside(location, model)
        meant = CALLED_ELSEWHERE.get(str(location[-1]).lower())
        hint = f'; did you mean "{meant}"?' if meant in known else suggestion(str(location[-1]), known)
        listed = f" (known here: {', '.join(known)})" if not hint or len(known) <= MOST_LISTED else ""
        return f"unknown key{hint}{listed}"
    misplaced = _settings_beside(first, location, model) if first.kind == "distribution" else []
    if misplaced:
        place = dotted((*location[:-1], misplaced[0]))
        return f"{', '.join(misplaced)}: this is a separate setting; write it beside this one as {place}"
    problem = first.context.get("problem")
    return str(problem) if problem else "" if first.kind in EXPECTED or first.kind == "allowed" else first.sentence


def _value(first: _Error, location: Location) -> object:
    if first.kind == "missing" or first.unknown_key:
        return None
    given = first.given
    if not first.field:
        return None if isinstance(given, BaseModel) or location == ("part",) else given
    for key in first.field:
        given = given.get(key) if isinstance(given, dict) else None
    return None if first.field == ("part",) else given


def _settings_beside(first: _Error, location: Location, model: type[BaseModel]) -> list[str]:
    """Keys of a value that was to be a distribution, if all of them are names of settings beside it."""
    keys = list(map(str, first.given)) if isinstance(first.given, dict) else []
    return keys if set(keys) <= set(_keys_beside(location, model)) else []


def _range_at(location: Location, model: type[BaseModel]) -> str:
    """The range of the number at `location`, as " from 1 to 200"; empty where the setting has none on both sides."""
    field = _table_around(location, model).model_fields.get(str(location[-1]))
    limits = [] if field is None else field.metadata
    ends = [getattr(limit, side) for side in ("ge", "le") for limit in limits if hasattr(limit, side)]
    shown = [f"{end:g}" if isinstance(end, float) else str(end) for end in ends]
    return f" from {shown[0]} to {shown[1]}" if len(shown) == 2 else ""


def _keys_beside(location: Location, model: type[BaseModel]) -> list[str]:
    return [name for name, field in _table_around(location, model).model_fields.items() if not field.exclude]


def _table_around(location: Location, model: type[BaseModel]) -> type[BaseModel]:
    """The table of the setting at `location`."""
    table = model
    for step in location[:-1]:
        if isinstance(step, str):
            table = _table_type(table.model_fields[step].annotation) or table
    return table


def _homes(key: str, model: type[BaseModel]) -> list[str]:
    """Where in the file a `key` is known: at its top level, or directly in which tables."""
    homes = []
    if key in model.model_fields:
        annotation = model.model_fields[key].annotation
        place = f"as {_header(key, annotation)}" if _table_type(annotation) else "above the first table of the file"
        homes.append(f"to the top level, {place}")
    for name, field in model.model_fields.items():
        table = _table_type(field.annotation)
        if table is not None and key in table.model_fields:
            homes.append(f"in {_header(name, field.annotation)}")
    return homes


def _header(name: str, annotation: Any) -> str:
    """How a table of that `name` begins in a file: in double brackets where there may be several."""
    return f"[[{name}]]" if get_origin(annotation) is tuple else f"[{name}]"


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
