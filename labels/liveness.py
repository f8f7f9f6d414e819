"""Whether a record shows a running machine at all, before anybody asks what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from labels.features.analysis import Analysis
from labels.features.conditioning import Array, local_mean_power
from labels.features.families import find_family, lines_in, near_mains

STILL_VELOCITY = 0.071e-3
"""m/s: a tenth of the limit between zones A and B of ISO 10816-1 for the smallest machines (0.71 mm/s RMS)."""
STILL_BAND = (10.0, 1000.0)
TURNING_EVIDENCE = 30.0
"""Nats of shaft harmonics or passing balls that show a turning shaft however little it shakes."""
FEWEST_TURNS = 15.0
"""In fewer turns the lines of a machine that runs quietly do not stand out, so that they lack says nothing."""
FEWEST_LEVELS = 4
STOPPED, DEAD = "machine stopped", "no signal"


@dataclass(frozen=True)
class Liveness:
    """RMS velocity (m/s) from 10 Hz to 1 kHz, evidence (nats) of a turning shaft or of passing balls, and the turns
    that the shaft would have made."""

    velocity: float
    evidence: float
    turns: float

    @property
    def reason(self) -> str:
        """Why the record must not be classified; empty if it shows a running machine."""
        silent = self.velocity < STILL_VELOCITY and self.evidence < TURNING_EVIDENCE
        return STOPPED if silent and self.turns >= FEWEST_TURNS else ""


def liveness(analysis: Analysis, samples: int) -> Liveness:
    """Liveness of an analysed record of that many `samples`, in m/s² as the sensor gives it."""
    spectrum, step = analysis.record.raw, analysis.record.step
    frequency = np.arange(spectrum.size) * step
    inside = (frequency >= STILL_BAND[0]) & (frequency <= STILL_BAND[1])
    amplitude = np.abs(spectrum[inside]) * (2.0 / samples) / (2.0 * np.pi * frequency[inside])
    turns = analysis.given.shaft_hz * analysis.record.duration
    return Liveness(float(np.sqrt(0.5 * np.sum(amplitude**2))), _turning(analysis), turns)


def _turning(analysis: Analysis) -> float:
    """Evidence (nats) of shaft harmonics or passing balls in the vibration, without mains tones and strongest line."""
    spectrum, step = analysis.record.raw, analysis.record.step
    power = np.abs(spectrum[None, : int(STILL_BAND[1] / step)]) ** 2
    floor = local_mean_power(power[:, 1:], max(24, int(3.0 * analysis.given.shaft_hz / step)))
    excess = np.ones_like(power)
    excess[:, 1:] = power[:, 1:] / np.maximum(floor, np.finfo(np.float64).tiny)
    frequency = np.arange(excess.shape[-1]) * step
    # Wider than for the envelopes, however short the record: hum alone must not pass for a turning shaft.
    hum = near_mains(frequency, 2.0 * step + 0.002 * frequency) | (frequency <= 2.0 * step)
    lines = lines_in(np.where(hum, 1.0, excess), step)
    known = analysis.given
    found = [
        find_family(lines, order * known.shaft_hz, 0.022, known.shaft_hz, harmonics=6).parts[0]
        for order in (1.0, known.bpfo, known.bpfi)
    ]
    return float(max(parts.sum() - parts.max() for parts in found))


def is_dead(signal: Array) -> bool:
    """True if a signal (T,) has NaN or fewer than four different values: no sensor was connected."""
    return not np.isfinite(signal).all() or np.unique(signal).size < FEWEST_LEVELS
