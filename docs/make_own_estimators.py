"""Writes the tables of docs/own_estimators.md from the code: python docs/make_own_estimators.py."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from marked_tables import write_marked

from datagen.files.text_tables import markdown_table
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome

PAGE = Path(__file__).with_name("own_estimators.md")
OF_SITUATION = {
    "balls": "rolling elements in each row",
    "rows": "rows of them",
    "pitch_diameter": "diameter of the circle through their centres, m",
    "ball_diameter": "their diameter, m",
    "shaft_speed": "rad/s, to about ±2 %",
    "contact_angle": "rad",
    "load": "static radial load, N; None if unknown, and with `--blind`",
    "load_deflection": "Hertz factor K of F = K δⁿ, N/mⁿ; None if unknown, and with `--blind`",
    "exponent": "n of the same law",
    "race": "outer or inner; None if it is to be found out, as in every record that `spallgen size` asks about",
    "polarity_known": "False if a push upwards may show as a negative acceleration",
}
OF_ESTIMATE = {
    "outcome": "how it ended: one of the table below",
    "method": "what the size follows from, in your words",
    "race": "outer or inner",
    "lag": "time between the events at both ends of the spall, s",
    "lag_interval": "its 90 % interval, s",
    "lag_arc": "arc of the race that a ball covers in it, rad",
    "extent": "arc of the spall, rad; a finite one is what counts as an estimate",
    "extent_interval": "its 90 % interval, rad",
    "extent_mm": "length of the spall along its race, mm",
    "extent_mm_interval": "its 90 % interval, mm",
    "candidates": "extents that give the same timing, rad: `extent`, then those whole ball spacings longer",
    "pass_period": "time between two ball passes as heard, s",
    "trust": "1 less the relative error to be expected of the lag, 0 to 1",
    "event_times": "array (K, 2), s: both events of each pass that was heard; others count as missed",
}


def tables() -> dict[str, str]:
    """Text of each table of the page, by the name in its marks; KeyError for a field without a meaning above."""
    outcomes = [[f"`SizeOutcome.{outcome.name}`", outcome.value] for outcome in SizeOutcome]
    return {
        "situation": _table(Situation, OF_SITUATION),
        "size estimate": _table(SizeEstimate, OF_ESTIMATE),
        "size outcomes": markdown_table(["outcome", "meaning"], outcomes),
    }


def _table(kind: Any, meanings: Mapping[str, str]) -> str:
    rows = [[f"`{field.name}`", f"`{_type(field)}`", _default(field), meanings[field.name]] for field in fields(kind)]
    return markdown_table(["field", "type", "if left out", "meaning"], rows)


def _type(field: Any) -> str:
    return str(field.type).replace("|", "or")


def _default(field: Any) -> str:
    if field.default is MISSING and field.default_factory is MISSING:
        return "**required**"
    if field.default is MISSING:
        return "no rows"
    values = field.default if isinstance(field.default, tuple) else (field.default,)
    if all(isinstance(value, float) and math.isnan(value) for value in values) and values:
        return "unknown"
    return f"`{field.default!r}`"


if __name__ == "__main__":
    for name, text in tables().items():
        write_marked(PAGE, name, __file__, text)
