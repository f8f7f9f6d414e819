"""Whether a record shows a running machine at all, before anybody asks what is wrong with it.

No scale is trusted for that: units are misread, and gains forgotten. What stands still has no lines of a shaft or of
passing balls, and a floor as white as the recorder's own. Its level is either that of the recorder's last digit or too
low for a machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.features.analysis import Analysis
from labels.features.families import find_family
from labels.features.known_lines import near_mains
from labels.features.lines import lines_in
from labels.features.speed import vibration_excess
from physics.arrays import Array, ComplexArray

# m/s: a tenth of the limit between zones A and B of ISO 10816-1 for the smallest machines (0.71 mm/s RMS).
STILL_VELOCITY = 0.071e-3
STILL_BAND = (10.0, 1000.0)
# RMS, in steps of the recorder, below which little but its own noise is recorded.
LAST_DIGITS = 2.0
# dB between the arithmetic and geometric means of the floor's level over the band, beyond what chance puts there: 0 for
# white noise, 0.02 at most in the eight recordings of a stopped machine in IMS, 0.27 at least in its 96 running ones.
WHITE = 0.05
WHITE_BANDS = 24
# Shares of the bandwidth that are looked at: below and above recorders let through less.
WHITE_FROM, WHITE_TO = 0.1, 0.8
# Lines of the shaft and of passing balls that are looked for; those of a fast shaft lie above STILL_BAND too.
LINES = 6
# Nats of shaft harmonics or passing balls that show a turning shaft however little it shakes.
TURNING_EVIDENCE = 30.0
# In fewer turns the lines of a quietly running machine do not stand out, so their absence proves nothing.
FEWEST_TURNS = 15.0
STOPPED, DEAD = "machine stopped", "no signal"


@dataclass(frozen=True)
class Liveness:
    """What a record shows of a running machine.

    `velocity` is the RMS (m/s) from 10 Hz to 1 kHz without hum, `digits` the RMS in steps of the recorder, `colour` how
    far the floor is from white (dB). `evidence` (nats) is that of a turning shaft or of passing balls, and `turns` are
    those that the shaft would have made.
    """

    velocity: float
    digits: float
    colour: float
    evidence: float
    turns: float

    @property
    def reason(self) -> str:
        """Why the record must not be classified; empty if it may show a running machine."""
        still = self.velocity < STILL_VELOCITY or self.digits < LAST_DIGITS
        silent = still and self.colour < WHITE and self.evidence < TURNING_EVIDENCE
        return STOPPED if silent and self.turns >= FEWEST_TURNS else ""


def liveness(analysis: Analysis, signal: Array, step: float) -> Liveness:
    """Liveness of a `signal` (T,), in m/s², and its analysis; `step` (m/s²) is that of its recorder."""
    return Liveness(
        _velocity(analysis),
        float(signal.std()) / step,
        _colour(analysis),
        _turning(analysis),
        analysis.given.shaft_hz * analysis.record.duration,
    )


def recorder_step(signal: Array) -> float:
    """Smallest difference between two values of a `signal` (T,) as it was recorded; what was mended has no step.

    Infinite if all are the same.
    """
    return float(np.diff(np.unique(signal)).min(initial=np.inf))


def _velocity(analysis: Analysis) -> float:
    """RMS velocity in STILL_BAND without mains and their harmonics."""
    step = analysis.record.step
    amplitude = np.abs(_windowed(analysis)) * (2.0 / analysis.record.samples)
    frequency = np.arange(1, amplitude.size + 1) * step
    inside = (frequency >= STILL_BAND[0]) & (frequency <= STILL_BAND[1]) & ~_hum(frequency, step)
    amplitude = amplitude[inside] / (2.0 * np.pi * frequency[inside])
    # The mean square of a Hann window of mean 1 is 3/2.
    return float(np.sqrt(0.5 * np.sum(amplitude**2) / 1.5))


def _windowed(analysis: Analysis) -> ComplexArray:
    """Fourier components (F - 2,) but the first and last in a Hann window of mean 1, so that no drift or hum leaks."""
    spectrum = analysis.record.raw
    return np.asarray(spectrum[1:-1] - 0.5 * (spectrum[:-2] + spectrum[2:]))


def _colour(analysis: Analysis) -> float:
    """How far the floor is from white, dB: the mean level of bands of equal width over their geometric mean."""
    power = np.abs(_windowed(analysis)) ** 2
    power = power[int(WHITE_FROM * power.size) : int(WHITE_TO * power.size)]
    # Medians do not see lines.
    bands = min(WHITE_BANDS, power.size)
    levels = np.array([np.median(part) for part in np.array_split(power, bands)])
    levels = np.maximum(levels, np.finfo(np.float64).tiny)
    # The logarithm of a median of m exponentials has a variance of 1 / (m ln² 2), half as much again in a Hann window.
    chance = 0.5 * 1.5 / (power.size / bands * np.log(2.0) ** 2)
    return float(10.0 * np.log10(levels.mean()) - 10.0 * np.log10(levels).mean() - chance * 10.0 / np.log(10.0))


def _turning(analysis: Analysis) -> float:
    """Evidence (nats) of shaft harmonics or passing balls in the vibration, without mains tones and strongest line."""
    spectrum, step = analysis.record.raw, analysis.record.step
    known = analysis.given
    top = max(STILL_BAND[1], (LINES + 1) * known.shaft_hz)
    power = np.abs(spectrum[None, : int(top / step)]) ** 2
    excess = vibration_excess(power, step, known.shaft_hz)
    frequency = np.arange(excess.shape[-1]) * step
    hum = _hum(frequency, step) & (frequency <= STILL_BAND[1])  # beyond, its margins would cover the axis
    lines = lines_in(np.where(hum | (frequency <= 2.0 * step), 1.0, excess), step)
    found = [
        find_family(lines, order * known.shaft_hz, known.speed_within, known.shaft_hz, harmonics=LINES).parts[0]
        for order in (1.0, known.bpfo, known.bpfi)
    ]
    return float(max(parts.sum() - parts.max() for parts in found))


def _hum(frequency: NDArray[Any], step: float) -> NDArray[np.bool_]:
    """True where a frequency (F,) is of the mains; wider than for the envelopes, however short the record, since hum
    alone must not pass for a turning shaft."""
    return near_mains(frequency, 2.0 * step + 0.002 * frequency)
