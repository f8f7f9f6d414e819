"""Columns of how two events go together: which is the anchor, what lies between and beside them, how alike they are."""

from __future__ import annotations

import numpy as np

from labels.spall_size.events.pairs import EVENTS, PairView
from labels.spall_size.signal.mean_pass import Channel, MeanPass
from labels.spall_size.signal.running_energy import ENERGY_FLOOR
from physics.arrays import Array

# Samples: an event nearer to the anchor than this is the anchor.
AT_ANCHOR = 1.0
# Samples between the core of an event and the stretch that is searched for other events.
GAP = 1.0
# Log energy that stands where there is no sample between two events.
NO_ROOM = -9.0
# Samples on either side of an event whose waveforms are compared.
WAVE_REACH = 8
# Samples by which one of two waveforms may be shifted.
WAVE_SHIFT = 2
# Samples on either side of an event over which its coherence is taken.
COHERENT_REACH = 3
NAMES = ("entry_is_anchor", "exit_is_anchor", "inside", "outside", "alike", "entry_coherence", "exit_coherence")


def measure(view: PairView) -> dict[str, Array]:
    """Columns (P,) by NAMES: 1 where an event is the anchor; log of the largest energy inside and outside the pair over
    that of its weaker core; correlation of the waveforms; log share of the energy that all passes have in phase."""
    entry, leave, core = view.entry, view.exit, view.core
    weaker = np.minimum(*(view.cores[event][Channel.ALL] for event in EVENTS))
    inside = _largest_between(view.mean, entry + core + GAP, entry + view.lag - core - GAP)
    outside = _largest_between(view.mean, entry + view.lag + core + GAP, entry + view.mean.period - core - GAP)
    return {
        "entry_is_anchor": (np.abs(entry) < AT_ANCHOR).astype(float),
        "exit_is_anchor": (np.abs(leave) < AT_ANCHOR).astype(float),
        "inside": inside - weaker,
        "outside": outside - weaker,
        "alike": _alike(view.mean, entry, leave),
        "entry_coherence": _coherence(view.mean, entry),
        "exit_coherence": _coherence(view.mean, leave),
    }


def _largest_between(mean: MeanPass, start: Array, stop: Array) -> Array:
    """Log of the largest energy between two offsets (P,): from the sample at or before `start` up to, but without, the
    one at or before `stop`; NO_ROOM where there is none."""
    level = np.log(mean.energy[Channel.ALL] + ENERGY_FLOOR)
    found = np.full(start.size, NO_ROOM)
    size, period = level.size, round(mean.period)
    for k in range(start.size):
        left, right = int(start[k] - mean.offset[0]), int(stop[k] - mean.offset[0])
        if right <= left:
            continue
        if right >= size:
            left, right = left - period, right - period
        found[k] = level[max(left, 0) : right].max() if right > max(left, 0) else NO_ROOM
    return found


def _alike(mean: MeanPass, entry: Array, leave: Array) -> Array:
    """Largest signed correlation (P,) of the mean waveforms round both places, shifted by at most WAVE_SHIFT."""
    first = mean.waveform[mean.around(entry, WAVE_REACH)]
    second = mean.waveform[mean.around(leave, WAVE_REACH + WAVE_SHIFT)]
    best = np.zeros(entry.size)
    for shift in range(2 * WAVE_SHIFT + 1):
        part = second[:, shift : shift + 2 * WAVE_REACH + 1]
        size = np.sqrt((first**2).sum(axis=1) * (part**2).sum(axis=1)) + 1e-12
        value = (first * part).sum(axis=1) / size
        best = np.where(np.abs(value) > np.abs(best), value, best)
    return best


def _coherence(mean: MeanPass, place: Array) -> Array:
    """Log of the energy of the mean waveform over the mean energy round a place (P,)."""
    near = mean.around(place, COHERENT_REACH)
    shared, all_of_it = (mean.waveform[near] ** 2).mean(axis=1), mean.energy[Channel.ALL][near].mean(axis=1)
    return np.log(shared + ENERGY_FLOOR) - np.log(all_of_it + ENERGY_FLOOR)
