"""Columns of the energy at, before and after both events of a pair, in every channel of the mean pass."""

from __future__ import annotations

import numpy as np

from labels.spall_size.events.pairs import EVENTS, PairView
from labels.spall_size.signal.mean_pass import Channel
from physics.arrays import Array

# Samples by which the windows before and after an event reach beyond its core at least.
LEAST_BESIDE = 2.0
# Samples between a core and the windows beside it.
GAP = 1.0
# Samples from an event at which the windows just before and just after it begin and end.
JUST_BESIDE = (2.0, 6.0)
# Channels in which the cores of both events are compared.
COMPARED = (Channel.LOW, Channel.HIGH)
SIDES = ("core", "before", "after", "just_before", "just_after")
NAMES = (
    *(f"{event}_{side}_{channel.word}" for event in EVENTS for channel in Channel for side in SIDES),
    *(f"exit_over_entry_{channel.word}" for channel in COMPARED),
)


def measure(view: PairView) -> dict[str, Array]:
    """Columns (P,) by NAMES: log energies in windows that grow with the lag, and just beside an event, in medians of
    the record; how far the exit's core lies above the entry's, logarithm."""
    found: dict[str, Array] = {}
    for event, place in view.events.items():
        for side, level in _levels(view, event, place).items():
            found |= {f"{event}_{side}_{channel.word}": level[channel] for channel in Channel}
    first, last = (view.cores[event] for event in EVENTS)
    return found | {f"exit_over_entry_{channel.word}": last[channel] - first[channel] for channel in COMPARED}


def _levels(view: PairView, event: str, place: Array) -> dict[str, Array]:
    """Log energy (4, P) on each of the SIDES of an event."""
    core, level = view.core, view.summed.level
    half = np.maximum(0.5 * view.lag, core + LEAST_BESIDE)
    near, far = JUST_BESIDE
    return {
        "core": view.cores[event],
        "before": level(place - half, place - core - GAP),
        "after": level(place + core + GAP, place + half),
        "just_before": level(place - far, place - near),
        "just_after": level(place + near, place + far),
    }
