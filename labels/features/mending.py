"""What is taken out of a signal before anything is read from it: jumps and drift of its bias, glitches and shocks."""

from __future__ import annotations

from dataclasses import dataclass

from labels.dead_sensor import is_dead
from labels.features.drift import without_drift
from labels.features.glitches import without_glitches
from labels.features.jumps import without_jumps
from labels.features.shocks import without_shocks
from physics.arrays import Array


@dataclass(frozen=True)
class Mended:
    """The `signal` (T,) of one axis, and how many `jumps` were levelled, `glitches` replaced and `shocks` cut in it."""

    signal: Array
    jumps: int = 0
    glitches: int = 0
    shocks: int = 0


def mended(signal: Array, turns: float) -> Mended:
    """The `signal` (T,), in which the shaft makes so many `turns`, with all of them taken out; as it is where the
    sensor is dead."""
    if is_dead(signal):
        return Mended(signal)
    signal, jumps = without_jumps(signal, turns)
    signal = without_drift(signal, turns)
    signal, glitches = without_glitches(signal, turns)
    signal, shocks = without_shocks(signal, turns)
    return Mended(signal, jumps, glitches, shocks)
