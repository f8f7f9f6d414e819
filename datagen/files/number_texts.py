"""Numbers in texts: as `float` and `int` read them, but not 105_2, which is a name or a date and not 1052."""

from __future__ import annotations

import math


def whole_number(text: str) -> int:
    """The whole number that a `text` is; raises ValueError if it is none."""
    _refuse_parted(text)
    return int(text)


def number(text: str) -> float:
    """The number that a `text` is, with a point as decimal sign; NaN if it is none."""
    try:
        _refuse_parted(text)
        return float(text)
    except ValueError:
        return math.nan


def may_be_parted(text: str) -> bool:
    """Whether a `text` has the sign in it that Python and NumPy take for one between thousands."""
    return "_" in text


def _refuse_parted(text: str) -> None:
    if may_be_parted(text):
        raise ValueError(f"{text} has a sign between figures")
