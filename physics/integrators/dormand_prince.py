"""The embedded pair of Dormand and Prince (1980) of orders 5 and 4: seven contact sums a step, dense output of order 4.

Stable up to ω h ≈ 1 for undamped modes, the resonator's included; its step control keeps it there, so its contract
states no limit. Not to be confused with SciPy's RK45, the same pair, which runs through changes of contact without
knowing of them.
"""

from __future__ import annotations

import math

import numpy as np

from physics._jit import njit, njit_inner, njit_part
from physics.arrays import Array
from physics.contact.contact_set import count_changes
from physics.contact.forces import Contacts, set_time
from physics.integrators.accelerations import accelerations
from physics.integrators.state_contact import press_state
from physics.integrators.trial import Trial
from physics.motion import MotionModel

STAGES = 7
NODES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
# Weights of earlier stages in each later one; the last row is the step of order 5.
WEIGHTS = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
# The step of order 5 minus the embedded one of order 4.
ERROR = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
# Dense output of order 4 (Shampine 1986): powers 1 to 4 of the share of the step, per stage.
DENSE = np.array(
    [
        [1.0, -8048581381 / 2820520608, 8663915743 / 2820520608, -12715105075 / 11282082432],
        [0.0, 0.0, 0.0, 0.0],
        [0.0, 131558114200 / 32700410799, -68118460800 / 10900136933, 87487479700 / 32700410799],
        [0.0, -1754552775 / 470086768, 14199869525 / 1410260304, -10690763975 / 1880347072],
        [0.0, 127303824393 / 49829197408, -318862633887 / 49829197408, 701980252875 / 199316789632],
        [0.0, -282668133 / 205662961, 2019193451 / 616988883, -1453857185 / 822651844],
        [0.0, 40617522 / 29380423, -110615467 / 29380423, 69997945 / 29380423],
    ]
)


@njit_inner
def slope(contacts: Contacts, motion: MotionModel, time: float, state: Array, rate: Array) -> tuple[float, float]:
    """Fill `rate` (12,) with the time derivative of `state` (12,) under the frozen contact set; the net force (N)."""
    set_time(contacts, time)
    force = press_state(contacts, state)
    for i in range(6):
        rate[i] = state[6 + i]
    accelerations(motion, time, state, force, rate[6:])
    return force


@njit_part
def attempt(
    contacts: Contacts,
    motion: MotionModel,
    time: float,
    step: float,
    now: Array,
    force: tuple[float, float],
    then: Array,
    rates: Array,
) -> Trial:
    """A step from `now` (12,), where the net `force` (N, N) and the first row of `rates` (7, 12) are known, to `then`.

    Fills the other rows; leaves `contacts` at the end time. Every stage looks for contradictions of the contact set.
    """
    after, contradicted = force, 0
    for stage in range(1, STAGES):
        for i in range(12):
            moved = 0.0
            for earlier in range(stage):
                moved += WEIGHTS[stage, earlier] * rates[earlier, i]
            then[i] = now[i] + step * moved
        after = slope(contacts, motion, time + NODES[stage] * step, then, rates[stage])
        contradicted += count_changes(contacts)
    return Trial(time, step, now, force, then, after, contradicted)


@njit_part
def local_error(rates: Array, step: float, scale: Array) -> float:
    """Largest difference between the pair's two solutions, relative to `scale` (12,).

    Of inner ring and resonator the motion relative to the outer ring counts, which makes the forces.
    """
    largest = 0.0
    miss = np.empty(12)
    for i in range(12):
        total = 0.0
        for stage in range(STAGES):
            total += ERROR[stage] * rates[stage, i]
        miss[i] = step * total
    make_relative(miss)
    for i in range(12):
        largest = max(largest, abs(miss[i]) / scale[i])
    return largest if math.isfinite(largest) else math.inf


@njit
def make_relative(state: Array) -> None:
    """Make inner ring and resonator of `state` (12,) relative to the outer ring."""
    for axis in range(2):
        for first in (0, 6):
            state[first + axis] -= state[first + 2 + axis]
            state[first + 4 + axis] -= state[first + 2 + axis]


@njit_inner
def dense_output(rates: Array, step: float, start: Array, share: float, state: Array) -> None:
    """Fill `state` (12,) at the `share` (0 to 1) of the step that began at `start`."""
    for i in range(12):
        moved = 0.0
        for stage in range(STAGES):
            weight = DENSE[stage, 3]
            for power in range(2, -1, -1):
                weight = weight * share + DENSE[stage, power]
            moved += weight * share * rates[stage, i]
        state[i] = start[i] + step * moved
