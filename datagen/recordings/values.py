"""Numbers of a SPEC: stated, or read from a variable of the recording's own file; and words of closed lists."""

from __future__ import annotations

import math
from difflib import SequenceMatcher
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, field_validator
from pydantic_core import PydanticCustomError

from datagen.recipes.operation_settings import FASTEST_RPM
from datagen.recipes.quantities import EXTENTS_MM, RATES_HZ, RATIOS_DB
from datagen.settings.table import Between, Table, refuse
from physics.angular_speed import RPM_PER_HZ
from physics.operation import HEAVIEST_LOAD
from physics.spelling import suggestion

LOWEST_ORDER = 1e-3
# Wide enough for any machine where recipes have no such setting, and not for a slip of units.
RANGES = {
    "rate_hz": RATES_HZ,
    "scale": Between(),
    "speed_rpm": Between(0.0, FASTEST_RPM),
    "speed_hz": Between(0.0, FASTEST_RPM / RPM_PER_HZ),
    "nominal_speed_rpm": Between(0.0, FASTEST_RPM),
    "extent_mm": EXTENTS_MM,
    "extent_deg": Between(0.0, 360.0, above=True),
    "depth_um": Between(0.0, 1e5, above=True),
    "load_n": Between(0.0, HEAVIEST_LOAD),
    "snr_db": RATIOS_DB,
    **dict.fromkeys(("bpfo", "bpfi", "bsf"), Between(LOWEST_ORDER, 1e3)),
    "ftf": Between(LOWEST_ORDER, 1.0),
}

# Likeness from which a word is one of a closed list with a slip in it: of "faulty" and "healthy" it is 0.62.
MISSPELT = 0.75


class FromVariable(Table):
    """A number that the recording's file holds."""

    variable: str
    """Name of the variable, as for the channels."""
    factor: Annotated[float, Field(allow_inf_nan=False)] = 1.0
    """What it is multiplied by to have the unit of the setting."""
    times: bool = False
    """True for a sampling rate whose variable holds the times of the samples, s, or the one step between them."""

    @field_validator("factor")
    @classmethod
    def _not_nothing(cls, factor: float) -> float:
        if factor == 0.0:
            raise PydanticCustomError("allowed", "allowed: {allowed}", {"allowed": "a number other than 0"})
        return factor


def number(name: str) -> BeforeValidator:
    """The check of a stated number by its range in RANGES; a table says where it is read."""

    def check(value: Any) -> Any:
        if isinstance(value, dict | FromVariable):
            if name != "rate_hz" and isinstance(value, dict) and value.get("times"):
                raise refuse("times can only give a sampling rate", "times")
            return value
        if not in_range(name, value):
            words = f'{RANGES[name].allowed()}, or {{variable = "NAME"}}'
            raise PydanticCustomError("allowed", "allowed: {allowed}", {"allowed": words})
        return float(value)

    return BeforeValidator(check)


def in_range(name: str, value: Any) -> bool:
    """True if a number is finite and in the range of the setting `name`, stated or read from a file."""
    return RANGES[name].accepts(value) and math.isfinite(value)


def finite_notes(notes: dict[str, Any]) -> dict[str, Any]:
    """The notes as they are; raises PydanticCustomError for a number that JSON does not have."""
    wild = next((name for name, value in notes.items() if isinstance(value, float) and not math.isfinite(value)), None)
    if wild is not None:
        raise refuse("not a finite number", wild, "texts, finite numbers, true or false")
    return notes


def word(*options: str, remark: str = "") -> AfterValidator:
    """The check of a text that is one of `options`; where it is none, a `remark` says more than these."""

    def check(value: str) -> str:
        if value not in options:
            meant = [option for option in options if _is_meant(value.casefold(), option)]
            hint = ", ".join(options) + (suggestion(value.casefold(), meant) or (f"; {remark}" if remark else ""))
            raise PydanticCustomError("allowed", "allowed: {allowed}", {"allowed": hint})
        return value

    return AfterValidator(check)


def _is_meant(value: str, option: str) -> bool:
    """Whether a text is a word with a slip in it, or with more words behind it."""
    return value.split()[:1] == [option] or SequenceMatcher(None, value, option).ratio() >= MISSPELT
