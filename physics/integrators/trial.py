"""A step that was tried with the contact set frozen, before it is known whether it can be taken."""

from __future__ import annotations

from typing import NamedTuple

from physics._jit import njit_inline
from physics.arrays import Array

# No step is made over less than this share of the full one: times so near to each other differ by rounding alone.
SMALLEST_STEP_SHARE = 1e-7
# So many changes of contact are located in one full step; further ones are taken over at the end of a trial instead.
MOST_CHANGES_PER_STEP = 100


class Trial(NamedTuple):
    """A step from the state `now` at `time` (s), where the contacts' `force` (N, N) is known, over `step` (s) to the
    state `then`, where it is `after`; and how many balls `contradicted` the contact set at the stages inside it.

    States and forces are as the method that makes the step takes them: physical ones, or amplitudes of the modes and
    the force that remains beside their spring and damper.
    """

    time: float
    step: float
    now: Array
    force: tuple[float, float]
    then: Array
    after: tuple[float, float]
    contradicted: int


@njit_inline
def take_over(now: Array, then: Array) -> None:
    """Make `now` (n,) the first n of `then`. A slice set to another would compile a message for unequal sizes."""
    for i in range(now.size):
        now[i] = then[i]
