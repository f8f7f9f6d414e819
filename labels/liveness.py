"""Whether a record shows a running machine at all, before anybody asks what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from labels.features.analysis import Analysis
from labels.features.conditioning import Array

STILL_VELOCITY = 0.071e-3
"""m/s: a tenth of the limit between zones A and B of ISO 10816-1 for the smallest machines (0.71 mm/s RMS)."""
STILL_BAND = (10.0, 1000.0)
TURNING_EVIDENCE = 30.0
"""Nats of shaft harmonics that show a turning shaft however little it shakes."""
FEWEST_LEVELS = 4
STOPPED, DEAD = "machine stopped", "no signal"


@dataclass(frozen=True)
class Liveness:
    """RMS velocity (m/s) from 10 Hz to 1 kHz and the evidence (nats) of a turning shaft or of passing balls."""

    velocity: float
    evidence: float

    @property
    def reason(self) -> str:
        """Why the record must not be classified; empty if it shows a running machine."""
        return STOPPED if self.velocity < STILL_VELOCITY and self.evidence < TURNING_EVIDENCE else ""


def liveness(analysis: Analysis, samples: int) -> Liveness:
    """Liveness of an analysed record of that many `samples`, in m/s² as the sensor gives it."""
    spectrum, step = analysis.record.raw, analysis.record.step
    frequency = np.arange(spectrum.size) * step
    inside = (frequency >= STILL_BAND[0]) & (frequency <= STILL_BAND[1])
    amplitude = np.abs(spectrum[inside]) * (2.0 / samples) / (2.0 * np.pi * frequency[inside])
    passing = max(float(analysis.outer.evidence.max()), float(analysis.inner.evidence.max()))
    return Liveness(float(np.sqrt(0.5 * np.sum(amplitude**2))), max(analysis.speed.evidence, passing))


def is_dead(signal: Array) -> bool:
    """True if a signal (T,) has NaN or fewer than four different values: no sensor was connected."""
    return not np.isfinite(signal).all() or np.unique(signal[:4096]).size < FEWEST_LEVELS
