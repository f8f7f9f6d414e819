"""Columns of how the bearing moves between two events: the sway, and the displacement that goes with it."""

from __future__ import annotations

import numpy as np

from labels.spall_size.events.pairs import PairView
from labels.spall_size.signal.mean_pass import MeanPass
from physics.arrays import Array

# Lags from the entry up to which the sway after the exit is averaged, a period at most.
AFTER = 1.5
NAMES = ("sway_inside", "sway_after", "give_at_entry", "give_inside", "give_at_exit")


def measure(view: PairView) -> dict[str, Array]:
    """Columns (P,) by NAMES: mean sway between the events and behind them, displacement at the entry, half way and at
    the exit, all in standard deviations of the mean pass."""
    mean, entry, lag = view.mean, view.entry, view.lag
    return {
        "sway_inside": _mean_sway(mean, entry, entry + lag),
        "sway_after": _mean_sway(mean, entry + lag, entry + np.minimum(AFTER * lag, mean.period)),
        "give_at_entry": _give(mean, entry),
        "give_inside": _give(mean, entry + 0.5 * lag),
        "give_at_exit": _give(mean, entry + lag),
    }


def _give(mean: MeanPass, place: Array) -> Array:
    shift = np.where(place > mean.offset[-1], mean.period, 0.0)
    return np.interp(place - shift, mean.offset, mean.give)


def _mean_sway(mean: MeanPass, start: Array, stop: Array) -> Array:
    """Mean (P,) of the sway between two offsets, which wrap round one period."""
    shift = np.where(stop > mean.offset[-1], mean.period, 0.0)
    running = np.concatenate([[0.0], np.cumsum(mean.sway)])
    left, right = (
        np.interp(place - shift - mean.offset[0], np.arange(running.size), running) for place in (start, stop)
    )
    return np.asarray((right - left) / np.maximum(stop - start, 1.0))
