"""How exactly a record is simulated."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Accuracy:
    """The error a record may have: `relative` RMS of the clean acceleration over its own, or, if that is more,
    `below_noise_db` below the white noise at the recorder, or below the background at a given signal-to-noise ratio."""

    relative: float = 1e-3
    below_noise_db: float | None = None
