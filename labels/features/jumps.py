"""Jumps: the bias of a sensor that goes from one level to another and stays there. The levels are made one.

A step holds every frequency at once: one of 30 times the RMS in the middle of a record hides most of what a fault says.
"""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from labels.features.whole_turns import whole_turns
from physics.arrays import Array

# Height of a jump over the usual standard deviation within a turn. Right at a place a drift makes 0.9 of its own, and
# a swing or a square wave once a turn makes 2; pulses once a turn make 3 at most, and are gone over whole turns.
OVER_SPREAD = 4.0
# Turns to both sides of a jump from which its height is taken, and from which it must show that it is no drift.
REACH, NEAR = 2.0, 0.25
# Turns for each jump; what comes oftener belongs to the machine and is left alone.
TURNS_EACH = 8


def without_jumps(signal: Array, turns: float) -> tuple[Array, int]:
    """The signal (T,) with all behind a jump moved back by its height, and how many jumps there were.

    The signal as it is and 0 where there is none, or more than one in TURNS_EACH `turns`, or in too few turns to tell.
    """
    cut = whole_turns(signal, turns)
    if cut is None:
        return signal, 0
    edges, spread = cut.edges, cut.spread
    middle = np.array([np.median(part) for part in cut.parts])
    away = np.pad(np.abs(middle[2:] - middle[:-2]) > OVER_SPREAD * spread, 1)
    # A jump shows in the one or two turns whose neighbours it parts.
    if spread == 0.0 or not 0 < np.count_nonzero(away) <= 2.0 * turns / TURNS_EACH:
        return signal, 0
    places = [_place(signal, edges[run.start - 1], edges[run.stop + 1]) for run in _runs(away)]
    jumps = [place for place in places if _is_jump(signal, place, cut.length, OVER_SPREAD * spread)]
    level = signal.copy() if jumps else signal
    for place in jumps:
        level[place:] -= _height(signal, place, REACH * cut.length)
    return level, len(jumps)


def _runs(away: Array) -> list[slice]:
    """The runs of true values in `away` (B,)."""
    return [found[0] for found in ndimage.find_objects(ndimage.label(away)[0])]


def _place(signal: Array, start: int, stop: int) -> int:
    """First sample behind the step that fits the samples from `start` to before `stop` best, by least squares."""
    part = signal[start:stop] - signal[start:stop].mean()
    before = np.cumsum(part)[:-1]
    count = np.arange(1, part.size)
    return int(start + 1 + np.argmax(before**2 / (count * (part.size - count))))


def _is_jump(signal: Array, place: int, turn: float, least: float) -> bool:
    """Whether the signal changes by more than `least` right at a place and for good; a `turn` is so many samples."""
    return all(abs(_height(signal, place, reach * turn)) > least for reach in (NEAR, REACH))


def _height(signal: Array, place: int, reach: float) -> float:
    """By how much the signal lies higher behind a place than before it, from `reach` samples to both sides."""
    before, behind = signal[max(place - int(reach), 0) : place], signal[place : place + int(reach)]
    return float(np.median(behind) - np.median(before))
