"""Which settings of a recipe have changed."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import zip_longest
from typing import Any

# What stands for a setting that one of both recipes does not have.
ABSENT = "not set"
LONGEST = 40


def differing_settings(before: Any, now: Any) -> tuple[str, ...]:
    """The settings in which a recipe differs from one `before` it, both as JSON: each as it was, "seed = 7"."""
    return tuple(f"{place} = {_shown(value)}" for place, value in _differences(before, now, ""))


def _differences(before: Any, now: Any, place: str) -> Iterator[tuple[str, Any]]:
    """The place and the value before of each that differs; lists count from 1, as in messages."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in dict.fromkeys((*before, *now)):
            inner = f"{place}.{key}" if place else key
            yield from _differences(before.get(key, ABSENT), now.get(key, ABSENT), inner)
    elif isinstance(before, list) and isinstance(now, list):
        for number, (old, new) in enumerate(zip_longest(before, now, fillvalue=ABSENT), start=1):
            yield from _differences(old, new, f"{place}[{number}]")
    elif before != now:
        yield place, before


def _shown(value: Any) -> str:
    text = value if value == ABSENT else json.dumps(value, ensure_ascii=False)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."
