"""Drift: a level that wanders, as that of a sensor that settles after it was switched on. It is taken out where large.

A spectrum takes a record as going round. Where its ends do not meet there is a step, which holds every frequency at
once and, in bands that are raised to the level of noise, looks like a blow.
"""

from __future__ import annotations

import numpy as np

from labels.features.whole_turns import whole_turns
from physics.arrays import Array

# How far apart the ends may lie, in usual standard deviations within a turn. Over whole turns the level of a running
# machine is about the same everywhere: without drift two of 119 recordings of test rigs are farther apart.
OVER_SPREAD = 1.0


def without_drift(signal: Array, turns: float) -> Array:
    """The signal (T,) less the course of its means over whole turns; as it is where its ends meet, or in too few turns
    of the shaft to tell."""
    cut = whole_turns(signal, turns)
    if cut is None:
        return signal
    level = np.array([part.mean() for part in cut.parts])
    # Straight on to the very ends, from the two turns next to each.
    first, last = 1.5 * level[0] - 0.5 * level[1], 1.5 * level[-1] - 0.5 * level[-2]
    if abs(last - first) <= OVER_SPREAD * cut.spread:
        return signal
    middles = 0.5 * (cut.edges[:-1] + cut.edges[1:] - 1)
    places = np.concatenate([[-0.5], middles, [signal.size - 0.5]])
    course = np.interp(np.arange(signal.size), places, np.concatenate([[first], level, [last]]))
    return np.asarray(signal - course)
