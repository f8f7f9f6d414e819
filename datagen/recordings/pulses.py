"""Pulses of a tach: where they rise, and which are missing or double, as the speed of a shaft cannot jump."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from physics.arrays import Array

HYSTERESIS = 0.1
# Intervals whose median is the usual one.
NEIGHBOURS = 9
# An interval this near to two or more usual ones lacks pulses; two intervals that are together this near to one usual
# one have a pulse too many: the speed changes by no more than a tenth from turn to turn.
NEAR_WHOLE = 0.2
# An interval of so many usual ones lacks pulses in any case, as no shaft slows down so much from one pulse to the next.
LONG = 3.0
# Wrong pulses that are more frequent than this (a turn) may belong to the wheel, as missing teeth do.
MOST_A_TURN = 0.5
# Share of the odd pulses that must be odd a turn later too if they do. At 5 % lost by chance 5 % are.
REGULAR = 0.9
# Share of the pulses that may be missing or double; a signal with more of them may not be a tach's.
MOST_MENDED = 0.1


def rising_edges(pulses: NDArray[np.float64], threshold: float | None = None) -> NDArray[np.float64]:
    """Places (N,), in samples, at which `pulses` (T,) rise through the threshold, by linear interpolation.

    If no threshold is given, it is half-way between the extremes. A pulse counts only if the signal has been a tenth of
    its range below the threshold since the previous pulse, so that noise on an edge is not counted.
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


def mended(times: Array, pulses_per_rev: float) -> tuple[Array, int]:
    """Times (N,), s, of pulses without those that came twice and with those that were lost, evenly between their
    neighbours, and how many these were; unchanged, with 0, if the odd ones come again turn after turn, as those of a
    wheel that is irregular itself.

    Pulses of teeth that a wheel lacks are put in, and not counted, if `pulses_per_rev` counts them.
    """
    if times.size <= NEIGHBOURS:
        return times, 0
    single = _without_doubles(times)
    steps = _steps(single)
    numbers = np.concatenate([[0], np.cumsum(steps)])
    doubles, gaps = times.size - single.size, steps > 1
    wrong = doubles + int(gaps.sum())
    if wrong == 0:
        return times, 0
    frequent = wrong > MOST_A_TURN * times.size / pulses_per_rev
    wheel_lacks_teeth = frequent and _come_again(numbers[:-1][gaps], pulses_per_rev)
    if frequent and not wheel_lacks_teeth and _come_again(_odd(times), pulses_per_rev):  # the wheel is irregular
        return times, 0
    whole = np.interp(np.arange(numbers[-1] + 1), numbers, single)
    return whole, doubles + (0 if wheel_lacks_teeth else int((steps - 1).sum()))


def _steps(times: Array) -> NDArray[np.int64]:
    """How many pulses on (N - 1,) each of those at `times` (N,) the next one is: 1, or more where some are missing."""
    interval = np.diff(times)
    ratio = interval / _usual(interval)
    steps = np.maximum(np.round(ratio), 1.0).astype(np.int64)
    steps[(np.abs(ratio - steps) > NEAR_WHOLE) & (ratio < LONG)] = 1
    return steps


def _usual(interval: Array) -> Array:
    """The usual one of the intervals (N,) about each."""
    return np.asarray(median_filter(interval, NEIGHBOURS, mode="mirror"))


def _odd(times: Array) -> NDArray[np.int64]:
    """Numbers of the pulses, at `times` (N,), behind which the interval is not the usual one."""
    interval = np.diff(times)
    return np.flatnonzero(np.abs(interval / _usual(interval) - 1.0) > NEAR_WHOLE)


def _come_again(numbers: NDArray[np.int64], pulses_per_rev: float) -> bool:
    """Whether the pulses of these `numbers` (N,) are the same ones in nearly every turn, and so are of the wheel."""
    turn = max(1, round(pulses_per_rev))
    followed = numbers[numbers + turn <= numbers.max(initial=0)]
    return bool(followed.size and np.mean(np.isin(followed + turn, numbers)) >= REGULAR)


def _without_doubles(times: Array) -> Array:
    interval = np.diff(times)
    off = np.abs((interval[:-1] + interval[1:]) / _usual(interval)[:-1] - 1.0)
    off = np.pad(np.where(off < NEAR_WHOLE, off, np.inf), 1, constant_values=np.inf)
    # Beside a pulse too many its neighbour may seem one too, but what it leaves is less like the other intervals.
    double = (off[1:-1] < off[:-2]) & (off[1:-1] <= off[2:]) & np.isfinite(off[1:-1])
    return np.delete(times, 1 + np.flatnonzero(double))
