"""What every march fills: samples, the log of contact changes, and how it ended."""

from __future__ import annotations

from typing import NamedTuple

from physics._jit import njit, njit_lean
from physics.arrays import Array, Flags, Index
from physics.contact.contact_set import contradicts
from physics.contact.forces import ACTIVE, FORCE, Contacts, of_ball
from physics.integrators.trial import take_over
from physics.motion import MotionModel, outer_ring_acceleration, resonator_acceleration

DONE, NOT_FINITE, LOG_FULL, OUT_OF_STEPS = range(4)
LARGEST_ACCELERATION = 1e12

# Entries of the tally: contact changes logged, changes left unlocated, steps.
LOGGED, UNLOCATED, STEPS = range(3)
TALLY_ENTRIES = 3
# Entries of `touched`: how long balls were in contact and in tension, summed over the balls; in seconds, or in samples
# where a method looks at samples alone. Only the share of one in the other is used.
TOUCHED, PULLED = range(2)


class Grid(NamedTuple):
    """`samples` instants, `substeps` steps of `step` (s) apart, from t = 0."""

    samples: int
    substeps: int
    step: float


class Output(NamedTuple):
    """Arrays to fill: `acceleration` (T, 2); of zero length if not wanted: `state` (T, 12), `force` (T, M) and `outer`
    (3, T, 2), the outer ring's displacement, velocity and acceleration along x and y;
    `change_time` (E,), `change_ball` (E,), `change_made` (E,): the log of contact changes; `initial` (M,): the first
    contact set; `tally` (3,); `touched` (2,); `spent` (1,): sum of the squares of the momenta (N s) by which steps are
    wrong, if the method knows."""

    acceleration: Array
    state: Array
    force: Array
    outer: Array
    change_time: Array
    change_ball: Index
    change_made: Flags
    initial: Array
    tally: Index
    touched: Array
    spent: Array


@njit_lean
def toggle(balls: Array, ball: int, time: float, output: Output) -> None:
    """Move `ball` to the other side of the contact set and log it."""
    made = of_ball(balls, ACTIVE, ball) < 0.5
    balls[ball // balls.shape[2], ACTIVE, ball % balls.shape[2]] = 1.0 if made else 0.0
    entry = output.tally[LOGGED]
    if entry < output.change_time.size:
        output.change_time[entry] = time
        output.change_ball[entry] = ball
        output.change_made[entry] = made
        output.tally[LOGGED] += 1


@njit_lean
def change_unlocated(contacts: Contacts, time: float, output: Output) -> None:
    """Let every ball that contradicts the contact set, from what `press` left, change sides at `time` (s)."""
    balls = contacts.balls
    for cage in range(balls.shape[0]):
        for place in range(balls.shape[2]):
            if contradicts(contacts, cage, place):
                toggle(balls, cage * balls.shape[2] + place, time, output)
                output.tally[UNLOCATED] += 1


@njit
def record(
    balls: Array, motion: MotionModel, state: Array, net_force: tuple[float, float], sample: int, output: Output
) -> bool:
    """Write one sample; False if the response is no longer finite."""
    output.acceleration[sample, 0] = resonator_acceleration(motion, state, 0)
    output.acceleration[sample, 1] = resonator_acceleration(motion, state, 1)
    if output.outer.shape[0] > 0:
        for axis in range(2):
            output.outer[0, sample, axis] = state[2 + axis]
            output.outer[1, sample, axis] = state[8 + axis]
            output.outer[2, sample, axis] = outer_ring_acceleration(motion, state, axis, net_force[axis])
    if output.state.shape[0] > 0:
        take_over(output.state[sample], state)
    if output.force.shape[0] > 0:
        for ball in range(output.force.shape[1]):
            output.force[sample, ball] = of_ball(balls, FORCE, ball)
    touching, pulled = 0, 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            touching += balls[cage, ACTIVE, j] > 0.5
            pulled += balls[cage, FORCE, j] < 0.0
    output.touched[TOUCHED] += touching
    output.touched[PULLED] += pulled
    size = abs(output.acceleration[sample, 0]) + abs(output.acceleration[sample, 1])
    return size < LARGEST_ACCELERATION
