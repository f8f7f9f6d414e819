"""What the paper prints, read from the one file where it is typed."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path


@dataclass(frozen=True)
class Published:
    """One statement of the paper: a number with its unit, or a `claim` in words, and where it stands.

    `sense` says how ours has to lie to it: "equal" within `tolerance` (half a unit of the last digit printed), or "at
    most" or "at least" (the end of an axis, which the curve does not cross).
    """

    where: str
    value: float | None = None
    unit: str = ""
    tolerance: float = 0.0
    sense: str = "equal"
    claim: str = ""

    def holds(self, ours: float) -> bool | None:
        """Whether our number agrees with the printed one; None where the paper prints no number."""
        if self.value is None:
            return None
        if self.sense == "at most":
            return bool(ours <= self.value)
        if self.sense == "at least":
            return bool(ours >= self.value)
        return bool(abs(ours - self.value) <= self.tolerance * (1.0 + 1e-9))


@cache
def _typed() -> dict[str, dict[str, dict[str, object]]]:
    return tomllib.loads(Path(__file__).with_name("published.toml").read_text(encoding="utf-8"))


def published(chapter: str, key: str) -> Published:
    """One statement of the paper by chapter ("figure5") and key; KeyError if it is not typed."""
    return Published(**_typed()[chapter][key])  # type: ignore[arg-type]


def published_value(chapter: str, key: str) -> float:
    """The number that the paper prints under `key`; KeyError if it is not typed, ValueError if it is in words alone."""
    value = published(chapter, key).value
    if value is None:
        raise ValueError(f"the paper prints no number for {key} of {chapter}")
    return value
