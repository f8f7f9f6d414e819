"""Plain data as TOML text, for people to read and to use again."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

MOST_INLINE = 4


def toml_text(data: Mapping[str, Any]) -> str:
    """The TOML of nested mappings, lists, texts, numbers and truth values; None and empty lists are left out.

    An empty mapping is written: a table of settings that are all as by default is not the same as none, which leaves
    them to what is said elsewhere.
    """
    return "\n".join(_table(data, "")).strip() + "\n"


def _table(data: Mapping[str, Any], path: str) -> Iterator[str]:
    known = {key: value for key, value in data.items() if value is not None and value != []}
    tables = {key: value for key, value in known.items() if _is_section(value)}
    for key, value in known.items():
        if key not in tables:
            yield f"{_key(key)} = {_value(value)}"
    for key, value in tables.items():
        name = f"{path}{_key(key)}"
        if isinstance(value, Mapping):
            if not all(map(_is_section, value.values())):
                yield f"\n[{name}]"
            yield from _table(value, f"{name}.")
        else:
            for element in value:
                yield f"\n[[{name}]]"
                yield from _table(element, f"{name}.")


def _is_section(value: Any) -> bool:
    if isinstance(value, Mapping):
        return len(value) > MOST_INLINE or any(isinstance(inner, Mapping) for inner in value.values())
    return (
        isinstance(value, Sequence)
        and not isinstance(value, str)
        and all(isinstance(entry, Mapping) for entry in value)
    )


def _key(key: str) -> str:
    return key if key and all(sign.isalnum() or sign in "-_" for sign in key) and key.isascii() else _text(key)


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        inside = ", ".join(f"{_key(key)} = {_value(held)}" for key, held in value.items() if held is not None)
        return f"{{{inside}}}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(held) for held in value) + "]"
    if isinstance(value, float):
        return repr(value)
    return _text(value) if isinstance(value, str) else json.dumps(value)


def _text(text: str) -> str:
    """A text in quotes, escaped as in JSON but for two things: TOML has no escapes of halves of a letter, which JSON
    makes of letters such as 😀, and no bare sign of deletion."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
