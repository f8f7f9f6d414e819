"""Columns of how the energy runs through each event of a leading pair, in windows that scale with the lag."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from labels.spall_size.events.leading import LeadingView
from labels.spall_size.events.pairs import EVENTS
from labels.spall_size.signal.mean_pass import Channel
from labels.spall_size.signal.running_energy import RunningEnergy
from physics.arrays import Array

# Lags from an event at which one window ends and the next begins.
EDGES = (-0.5, -0.35, -0.25, -0.17, -0.1, -0.05, -0.02, 0.02, 0.05, 0.1, 0.17, 0.25, 0.35, 0.5)
# Least half width of a window, samples.
LEAST_HALF = 0.5
# Channels whose course is a feature.
PROFILED = (Channel.ALL, Channel.LOW, Channel.HIGH)
WINDOWS = tuple(f"{start:g}_to_{stop:g}" for start, stop in pairwise(EDGES))
NAMES = tuple(f"{event}_{channel.word}_{window}" for event in EVENTS for channel in PROFILED for window in WINDOWS)


def measure(view: LeadingView) -> dict[str, Array]:
    """Columns (L,) by NAMES: log energies in 13 windows round either event, of the whole signal and of its low and high
    band, in medians of the record."""
    summed = RunningEnergy(view.evidence.mean)
    edges = np.array(EDGES) * view.lag[:, None]
    middle, half = 0.5 * (edges[:, 1:] + edges[:, :-1]), np.maximum(0.5 * np.diff(edges, axis=1), LEAST_HALF)
    found: dict[str, Array] = {}
    for event, place in zip(EVENTS, (view.entry, view.exit), strict=True):
        level = summed.level(place[:, None] + middle - half, place[:, None] + middle + half)
        for channel in PROFILED:
            names = (f"{event}_{channel.word}_{window}" for window in WINDOWS)
            found |= dict(zip(names, level[channel].T, strict=True))
    return found
