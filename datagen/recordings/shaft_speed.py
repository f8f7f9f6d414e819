"""The speed of the shaft in a recording: stated, measured beside the vibration, from a tach, or nominal."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.recordings.settings import Tach
from datagen.recordings.source import Source, Span
from datagen.recordings.values import RANGES, in_range
from labels.schema import UNKNOWN

HYSTERESIS = 0.1
FEWEST_PULSES = 3


def shaft_speeds(source: Source, rate: float, size: int, pieces: list[tuple[int, int]]) -> list[tuple[float, str]]:
    """Mean speed (rpm, NaN if unknown) in each piece and its basis, a value of the label `speed_basis`.

    `rate` is the vibration's, Hz; pieces are a first sample and the one after the last, of `size` in all.
    """
    tach = source.setting("tach")
    if tach is None:
        return [_stated_speed(source, (Fraction(start, size), Fraction(stop, size))) for start, stop in pieces]
    times = _pulse_times(source, tach, rate, size)
    return [(tach_speed(source, tach, times, start / rate, stop / rate), "tach") for start, stop in pieces]


def _stated_speed(source: Source, span: Span) -> tuple[float, str]:
    nominal = source.number("nominal_speed_rpm", span)
    for name, factor in (("speed_rpm", 1.0), ("speed_hz", 60.0)):
        measured = source.number(name, span) if nominal is None else source.or_none(name, span)
        if measured is not None:
            return measured * factor, "measured"
    return (math.nan, UNKNOWN) if nominal is None else (nominal, "nominal")


def _pulse_times(source: Source, tach: Tach, rate: float, size: int) -> NDArray[np.float64]:
    """When the pulses rise, s; raises BadInput if they cannot be timed by the vibration of `size` samples at `rate`."""
    pulses = source.array(tach.variable, "tach.variable")
    if tach.rate_hz is None and pulses.size != size:
        raise BadInput(
            f"holds {pulses.size} samples and the vibration {size}", str(source.path), "tach.variable", tach.variable,
            "as many, or the sampling rate of the pulses in tach.rate_hz",
        )  # fmt: skip
    return rising_edges(pulses, tach.threshold) / (tach.rate_hz or rate)


def tach_speed(source: Source, tach: Tach, times: NDArray[np.float64], start: float, stop: float) -> float:
    """Mean speed, rpm, over the pulses at `times` from `start` to `stop`, s; raises BadInput if they are under 3."""
    inside = times[(times >= start) & (times < stop)]
    if inside.size < FEWEST_PULSES:
        raise BadInput(
            f"{inside.size} pulses from {start:g} to {stop:g} s", str(source.path), "tach.variable", tach.variable,
            f"at least {FEWEST_PULSES} pulses; tach.threshold may move their level",
        )  # fmt: skip
    speed = float((inside.size - 1) / (inside[-1] - inside[0]) / tach.pulses_per_rev * 60.0)
    if not in_range("speed_rpm", speed):
        raise BadInput(
            f"its pulses say {speed:.4g} revolutions per minute", str(source.path), "tach.pulses_per_rev",
            tach.pulses_per_rev, f"what gives {RANGES['speed_rpm'].allowed()}",
        )  # fmt: skip
    return speed


def rising_edges(pulses: NDArray[np.float64], threshold: float | None = None) -> NDArray[np.float64]:
    """Places (N,), in samples, at which `pulses` (T,) rise through the threshold, by linear interpolation.

    Without a threshold it is half-way between the extremes. A pulse counts only if the signal was a tenth of its range
    below the threshold since the pulse before, so that noise on an edge is not counted.
    """
    low, high = float(pulses.min()), float(pulses.max())
    level = (low + high) / 2.0 if threshold is None else threshold
    up = np.flatnonzero((pulses[:-1] < level) & (pulses[1:] >= level))
    armed = np.flatnonzero(pulses < level - HYSTERESIS * (high - low))
    kept, last = [], -1
    for place in up.tolist():
        first_armed = np.searchsorted(armed, last, side="right")
        if first_armed < armed.size and armed[first_armed] <= place:
            kept.append(place)
            last = place
    edges = np.array(kept, dtype=np.int64)
    return edges + (level - pulses[edges]) / (pulses[edges + 1] - pulses[edges])
