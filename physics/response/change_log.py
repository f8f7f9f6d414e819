"""How many changes of contact a march has room to log."""

from __future__ import annotations

import math

from physics.outcome import Outcome, SimulationFailed

# Changes; room for this many at first, and so many times as many whenever it is full.
FIRST_ROOM, LARGEST_ROOM, GROWTH = 4096, 2_097_152, 8


def room_for_changes(full: int, duration: float, most: float = math.inf) -> int:
    """The room for changes to try once room for `full` of them was too little; `full` is 0 before the first try.

    Raises SimulationFailed if that room was LARGEST_ROOM already, or the `most` that can be: the record of `duration`
    (s) has too many changes.
    """
    if full == 0:
        return FIRST_ROOM
    room = int(min(GROWTH * full, LARGEST_ROOM, most))
    if room <= full:
        raise SimulationFailed(Outcome.TOO_MANY_CHANGES, f"more than {full} changes of contact in {duration:g} s")
    return room
