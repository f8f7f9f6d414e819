"""The noise of a virtual machine: what a sensor shows besides the bearing."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Background:
    """Levels of the background layers of a machine, in absolute units.

    `white_rms` (m/s²) is the standard deviation of white noise on each axis; a record's noise is drawn from its stream
    "white_noise". `white_snr_db`, if given, takes its place: power of the clean y axis over that of the noise.
    """

    white_rms: float = 0.0
    white_snr_db: float | None = None
