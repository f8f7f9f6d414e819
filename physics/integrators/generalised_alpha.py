"""The generalised-α method (Chung and Hulbert 1993), implicit, with Newton's method on the contact tangent.

Order 2, stable at any step for linear motion; modes far faster than the step lose all but the share ρ∞ = 0.9 of their
amplitude a step, so it is for scenes whose stiffest parts need not be resolved. About five contact sums a step. With
ρ∞ = 1 it is the implicit midpoint rule. Not to be confused with Newmark's method with γ > 1/2, whose damping costs an
order.

The state is longer by seven: how far the method's own acceleration, which lags the equation's by a share of a step, is
ahead of it, and the length of that step. After a step of another length the method starts afresh from the equation's.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from physics._jit import njit_inner, njit_part
from physics.arrays import Array
from physics.contact.contact_set import count_changes
from physics.contact.forces import Contacts, press, set_time
from physics.integrators.accelerations import accelerations
from physics.integrators.contact_tangent import contact_tangent
from physics.integrators.fixed_step_march import Workspace, bind_method, carrying
from physics.integrators.state_contact import press_state
from physics.motion import MotionModel, outer_load

RADIUS_AT_INFINITY = 0.9
ALPHA_M = (2.0 * RADIUS_AT_INFINITY - 1.0) / (RADIUS_AT_INFINITY + 1.0)
ALPHA_F = RADIUS_AT_INFINITY / (RADIUS_AT_INFINITY + 1.0)
GAMMA = 0.5 - ALPHA_M + ALPHA_F
BETA = 0.25 * (1.0 - ALPHA_M + ALPHA_F) ** 2
MOST_ITERATIONS = 40
MOST_SHORTENINGS = 12
# Newton's method squares the error: a move this small (share of the displacement) leaves round-off.
SMALL_MOVE = 1e-8
SAME_STEP = 1e-6
# Places of the longer state: the lead of the accelerations of inner ring, outer ring and resonator, along x and y, and
# the length of the last step.
LEAD_INNER, LEAD_OUTER, LEAD_RESONATOR, LAST_STEP, STATE_SIZE = 12, 14, 16, 18, 19


class Free(NamedTuple):
    """What one axis does at the α-point without contact: relative displacement (m) and velocity (m/s), the force-free
    accelerations at the step's end (m/s²) of inner ring, outer ring and resonator, and what one newton adds to these.

    `compliance` (m/N) is how far one newton brings the rings together.
    """

    displacement: float
    velocity: float
    inner: float
    outer: float
    resonator: float
    inner_gain: float
    outer_gain: float
    resonator_gain: float
    compliance: float


@njit_part
def _free(motion: MotionModel, axis: int, load: float, step: float, start: Array, lead: Array) -> Free:
    """The linear part of one step along one axis; `lead` (6,) are the method's accelerations at its start."""
    share, inertia = 1.0 - ALPHA_F, 1.0 - ALPHA_M
    along, rate = share * BETA * step * step, share * GAMMA * step
    mi, mo, mr = motion.inner_mass, motion.outer_mass, motion.resonator_mass
    kr, cr = motion.resonator_stiffness, motion.resonator_damping
    ko, co = motion.support_stiffness[axis], motion.support_damping[axis]
    x, v = np.empty(3), np.empty(3)
    for body in range(3):
        i = 2 * body + axis
        x[body] = start[i] + share * (step * start[6 + i] + step * step * (0.5 - BETA) * lead[i])
        v[body] = start[6 + i] + share * step * (1.0 - GAMMA) * lead[i]
    link = kr * (x[1] - x[2]) + cr * (v[1] - v[2])
    tie = kr * along + cr * rate
    outer_mass = mo * inertia + ko * along + co * rate + tie
    resonator_mass = mr * inertia + tie
    determinant = outer_mass * resonator_mass - tie * tie
    outer_pull = -mo * ALPHA_M * lead[2 + axis] - ko * x[1] - co * v[1] - link
    resonator_pull = link - mr * ALPHA_M * lead[4 + axis]
    inner = (load / mi - ALPHA_M * lead[axis]) / inertia
    outer = (resonator_mass * outer_pull + tie * resonator_pull) / determinant
    inner_gain, outer_gain = -1.0 / (mi * inertia), resonator_mass / determinant
    return Free(
        x[0] - x[1] + along * (inner - outer),
        v[0] - v[1] + rate * (inner - outer),
        inner,
        outer,
        (outer_mass * resonator_pull + tie * outer_pull) / determinant,
        inner_gain,
        outer_gain,
        tie / determinant,
        along * (outer_gain - inner_gain),
    )


@njit_inner
def _pressed(contacts: Contacts, x: Free, y: Free, dx: float, dy: float, rate: float) -> tuple[float, float]:
    """Contact force (N, N) minus the force that the motion needs to be at the displacement (dx, dy), m."""
    away_x, away_y = dx - x.displacement, dy - y.displacement
    force = press(contacts, dx, dy, x.velocity + rate * away_x, y.velocity + rate * away_y)
    return force[0] + away_x / x.compliance, force[1] + away_y / y.compliance


@njit_inner
def _meet(contacts: Contacts, x: Free, y: Free, rate: float, force: tuple[float, float]) -> tuple[float, float]:
    """Contact force (N, N) at the α-point by Newton's method from the guess `force`; not a number if none is found.

    The sought zero is that of a rising function, so a move that does not lessen the misfit is too long.
    """
    dx, dy = x.displacement - x.compliance * force[0], y.displacement - y.compliance * force[1]
    miss_x, miss_y = _pressed(contacts, x, y, dx, dy, rate)
    for _ in range(MOST_ITERATIONS):
        xx, xy, yx, yy = contact_tangent(contacts, rate)
        xx += 1.0 / x.compliance
        yy += 1.0 / y.compliance
        determinant = xx * yy - xy * yx
        move_x, move_y = (xy * miss_y - yy * miss_x) / determinant, (yx * miss_x - xx * miss_y) / determinant
        miss = math.hypot(miss_x, miss_y)
        for _ in range(MOST_SHORTENINGS):
            miss_x, miss_y = _pressed(contacts, x, y, dx + move_x, dy + move_y, rate)
            if math.hypot(miss_x, miss_y) <= miss:
                break
            move_x *= 0.5
            move_y *= 0.5
        dx += move_x
        dy += move_y
        if math.hypot(move_x, move_y) <= SMALL_MOVE * math.hypot(dx, dy):
            return (x.displacement - dx) / x.compliance, (y.displacement - dy) / y.compliance
    return math.nan, math.nan


@njit_part
def step_generalised_alpha(
    contacts: Contacts,
    motion: MotionModel,
    work: Workspace,
    time: float,
    step: float,
    start: Array,
    force: tuple[float, float],
    end: Array,
) -> int:
    """One step of length `step` from `start` (19,), where the net contact force is `force`, into `end` (19,).

    The contact set stays frozen. Leaves `contacts` at the end time; returns how many balls contradict the set at the
    α-point, near the middle of the step.
    """
    lead = np.empty(6)
    accelerations(motion, time, start, force, lead)
    if abs(start[LAST_STEP] - step) <= SAME_STEP * step:
        for i in range(6):
            lead[i] += start[LEAD_INNER + i]
    middle = time + (1.0 - ALPHA_F) * step
    load = outer_load(motion, middle)
    x, y = (
        _free(motion, 0, load[0], step, start, lead),
        _free(motion, 1, load[1], step, start, lead),
    )
    set_time(contacts, middle)
    met = _meet(contacts, x, y, GAMMA / (BETA * step), force)
    contradicted = count_changes(contacts)
    for axis in range(2):
        free = x if axis == 0 else y
        pushed = met[axis]
        end[LEAD_INNER + axis] = free.inner + free.inner_gain * pushed
        end[LEAD_OUTER + axis] = free.outer + free.outer_gain * pushed
        end[LEAD_RESONATOR + axis] = free.resonator + free.resonator_gain * pushed
    for i in range(6):
        moved = (0.5 - BETA) * lead[i] + BETA * end[LEAD_INNER + i]
        end[i] = start[i] + step * start[6 + i] + step * step * moved
        end[6 + i] = start[6 + i] + step * ((1.0 - GAMMA) * lead[i] + GAMMA * end[LEAD_INNER + i])
    set_time(contacts, time + step)
    accelerations(motion, time + step, end, press_state(contacts, end), lead)
    for i in range(6):
        end[LEAD_INNER + i] -= lead[i]
    end[LAST_STEP] = step
    return contradicted


# The march begins with the accelerations of the equations of motion.
march_generalised_alpha = carrying(
    bind_method("generalised_alpha", step_generalised_alpha), np.zeros(STATE_SIZE - LEAD_INNER)
)
