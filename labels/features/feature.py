"""The description of one column of the feature table."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Feature:
    """One number of a record: `dimension` says what it is counted in ("1", "ln nat", "log10"), `source` where from."""

    name: str
    dimension: str
    sentence: str
    source: str
