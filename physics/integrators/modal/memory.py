"""What a march on the modes remembers, and the grid on which it walks."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from physics.arrays import Array, Index
from physics.integrators.modal.flow import AMPLITUDES, LinearFlow
from physics.integrators.modal.layout import POWERS

# Units of a sample: a step of a sample or less is a whole number of them, or ends off the grid.
UNITS = 16
# Steps of more than a sample, in samples, and where the weights of the samples inside each begin.
STRIDES = (2, 3, 4, 6, 8, 12, 16, 24)
FIRST_INSIDE = tuple(sum(STRIDES[:k]) - k for k in range(len(STRIDES)))
# Rows of weights: of steps of 0 to 16 units, of the strides, and one for a length between.
BETWEEN = UNITS + 1 + len(STRIDES)
ROWS = BETWEEN + 1
# Shortest step that an error may ask for, as a share of a unit.
SHORTEST = 1.0 / 64.0
NO_BALL = -1
# Lengths that differ by less than this share of a unit are one.
NEARLY = 1e-6
# Entries of `clock`.
CLOCK_ENTRIES = 9
(
    TIME,  # s
    PACE,  # longest next step, s
    BEFORE,  # length of the step before, s; 0 if its past is of no use
    LEFT,  # what is left to the contact change ahead, s
    GRADED,  # longest step next to that change, s
    ON_WAY,  # longest step on the way to it, s
    TOLERANCE,  # N s
    SQUARES,  # sum of the squares of the acceleration, m²/s⁴
    SPENT,  # sum of the squares of the errors, N² s²
) = range(CLOCK_ENTRIES)
# Entries of `marks`.
MARKS_ENTRIES = 11
(
    PASSED,  # units passed
    CAREFUL,  # unit before which no stride starts
    STOP,  # number of the next kink
    TRIED,  # changes located in this sample
    BALL,  # ball of the contact change ahead, or NO_BALL
    ON_GRID,  # 1 where the time is a whole number of units
    PULLING,  # how many balls pull now
    RETUNE,  # sample from which on the tolerance is to be set anew
    BUMPY,  # 1 where a step may pass over bumps of a path unseen
    AT_WALL,  # 1 where the contact change ahead is at a wall of the path
    EXACT,  # unit before which no loss of contact is put on the grid
) = range(MARKS_ENTRIES)


class Memory(NamedTuple):
    """What a march remembers between its steps, and scratch that it uses again and again; G cages of M balls.

    - `states` (2, 12): amplitudes at both ends of a step, by turns; `between` (12,): of a sample inside a step
    - `weights` (26, 168): of every step length; `inside` (67, 172): of the samples inside strides (modal/layout.py)
    - `course` (2, 5): contact force of the step along x and y (N), a polynomial in the share of the step
    - `phi` (2, 6, 12): scratch of modal/weights.py: φ-functions over half a step and the whole of it
    - `rest` (2, 11): readings of what the loads alone do, at the time of the contacts
    - `ends` (2, 3, 2): scratch of modal/location.py: both ends of the step in which a change is located
    - `suspects` (G, M): share of the step at which a ball was seen to contradict the contact set, 0 if it was not
    - `past` (2, 2): contact force (N) at the beginning and in the middle of the step before
    - `noted`, `midway` (G, 2, M): compression (m) and its rate (m/s) of the balls at the step's beginning and midway
    - `clock`, `marks`: the entries named above; `fastest` (1/s): the largest size of an eigenvalue;
      `longest` (s): that of any step; `fine`: whether a step to a kink goes on over the nudge behind it
    """

    states: Array
    between: Array
    weights: Array
    inside: Array
    course: Array
    phi: Array
    rest: Array
    ends: Array
    suspects: Array
    past: Array
    noted: Array
    midway: Array
    clock: Array
    marks: Index
    fastest: float
    longest: float
    fine: bool


class ModalGrid(NamedTuple):
    """`samples` instants, `interval` (s) apart; steps of at most a sample, or the first `levels` of the `STRIDES`.

    One step may be wrong by the momentum (N s) `share` times the root mean square of the resonator's acceleration
    (m/s²) seen so far, or by `least` if that is more. `seen` (m²/s⁴) is what to take for the mean square at the start,
    with the weight of `seen_samples`. The squares of the momenta by which a sample may be wrong on average: `spending`
    times the square of that tolerance.
    """

    samples: int
    interval: float
    levels: int
    share: float
    least: float
    seen: float
    seen_samples: float
    spending: float


def memory_for(
    flow: LinearFlow,
    start: Array,
    tables: tuple[Array, Array],
    shape: tuple[int, ...],
    longest: float = math.inf,
    fine: bool = False,
) -> Memory:
    """Memory for a march from the amplitudes `start` (12,) of contacts whose balls are an array of this `shape`, in
    steps of `longest` (s) at most; a `fine` one leaves out no time behind a kink.

    `tables` (modal/tables.py) may serve several marches at once: the row BETWEEN is the memory's own.
    """
    (weights, inside), (cages, _, balls) = tables, shape
    return Memory(
        states=np.stack([start, np.zeros_like(start)]),
        between=np.zeros_like(start),
        weights=weights.copy(),
        inside=inside,
        course=np.zeros((2, POWERS)),
        phi=np.zeros((2, POWERS + 1, AMPLITUDES)),
        rest=flow.rest.copy(),
        ends=np.zeros((2, 3, 2)),
        suspects=np.zeros((cages, balls)),
        past=np.zeros((2, 2)),
        noted=np.zeros((cages, 2, balls)),
        midway=np.zeros((cages, 2, balls)),
        clock=np.zeros(CLOCK_ENTRIES),
        marks=np.zeros(MARKS_ENTRIES, dtype=np.int64),
        fastest=flow.fastest,
        longest=longest,
        fine=fine,
    )
