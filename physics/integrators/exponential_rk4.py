"""Exponential Runge-Kutta of order 4 (Krogstad 2005, ETDRK4-B): four contact sums a step.

Outer ring and resonator are solved exactly under the stages' contact forces, the inner ring (a free mass) likewise, so
the fast resonator sets no step limit; what remains to resolve are the contact modes and the balls' way over edges.
Order 4 while the contact set does not change, which the marching loop ensures by stopping at every change. Not to be
confused with Cox and Matthews' ETDRK4, whose stages lose order when the linear part is stiff, nor with Lawson's
integrating-factor RK4. Stable up to ω h = 1.41 for undamped contact modes of frequency ω: half the classical method's,
whose positions see older forces.
"""

from __future__ import annotations

from physics._jit import njit_inline, njit_inner
from physics.arrays import Array
from physics.contact.contact_set import count_changes
from physics.contact.forces import Contacts, move_to, press
from physics.integrators.fixed_step_march import Workspace, bind_method
from physics.integrators.propagator import FIRST, HALF, LAST, MIDDLE, TO_2_3, TO_3_4, TO_4, WHOLE
from physics.motion import MotionModel, outer_load

# Places of (xo, vo, xr, vr) of the x axis in the state; the y axis follows each.
OUTER_STATE = (2, 8, 4, 10)


@njit_inline
def step_exponential_rk4(
    contacts: Contacts,
    motion: MotionModel,
    work: Workspace,
    time: float,
    step: float,
    start: Array,
    force: tuple[float, float],
    end: Array,
) -> int:
    """One step of length `step` from `start` (12,), where the net contact force is `force`, into `end` (12,).

    The contact set stays frozen. Leaves `contacts` at the end time; returns how many balls contradict the set halfway.
    """
    weights, square = work.weights, step * step
    # Relative displacement and velocity of the free flow, then of the stage, a row an axis.
    stage = work.stage
    load = outer_load(motion, time)
    g1 = ((load[0] - force[0]) / motion.inner_mass, (load[1] - force[1]) / motion.inner_mass)
    flow_freely(weights, step, start, stage, end)
    for axis in range(2):
        stage[axis, 2] = stage[axis, 0] + 0.125 * square * g1[axis] - weights[axis, TO_2_3, 0] * force[axis]
        stage[axis, 3] = stage[axis, 1] + 0.5 * step * g1[axis] - weights[axis, TO_2_3, 1] * force[axis]

    move_to(contacts, time + 0.5 * step)
    load = outer_load(motion, time + 0.5 * step)
    f2 = press(contacts, stage[0, 2], stage[1, 2], stage[0, 3], stage[1, 3])
    g2 = ((load[0] - f2[0]) / motion.inner_mass, (load[1] - f2[1]) / motion.inner_mass)
    for axis in range(2):
        kick = weights[axis, TO_2_3, 2] * force[axis] + weights[axis, TO_3_4, 0] * f2[axis]
        kick_rate = weights[axis, TO_2_3, 3] * force[axis] + weights[axis, TO_3_4, 1] * f2[axis]
        stage[axis, 2] = stage[axis, 0] + square / 24.0 * (g1[axis] + 2.0 * g2[axis]) - kick
        stage[axis, 3] = stage[axis, 1] + 0.5 * step * g2[axis] - kick_rate
    f3 = press(contacts, stage[0, 2], stage[1, 2], stage[0, 3], stage[1, 3])
    contradicted = count_changes(contacts)
    g3 = ((load[0] - f3[0]) / motion.inner_mass, (load[1] - f3[1]) / motion.inner_mass)
    for axis in range(2):
        kick = weights[axis, TO_3_4, 2] * force[axis] + weights[axis, TO_4, 0] * f3[axis]
        kick_rate = weights[axis, TO_3_4, 3] * force[axis] + weights[axis, TO_4, 1] * f3[axis]
        inner = start[axis] + step * start[6 + axis] + square / 6.0 * (g1[axis] + 2.0 * g3[axis])
        stage[axis, 2] = inner - end[2 + axis] - kick
        stage[axis, 3] = start[6 + axis] + step * g3[axis] - end[8 + axis] - kick_rate

    move_to(contacts, time + step)
    load = outer_load(motion, time + step)
    f4 = press(contacts, stage[0, 2], stage[1, 2], stage[0, 3], stage[1, 3])
    for axis in range(2):
        g4 = (load[axis] - f4[axis]) / motion.inner_mass
        middle = f2[axis] + f3[axis]
        end[axis] = start[axis] + step * start[6 + axis] + square / 6.0 * (g1[axis] + g2[axis] + g3[axis])
        end[6 + axis] = start[6 + axis] + step / 6.0 * (g1[axis] + 2.0 * (g2[axis] + g3[axis]) + g4)
        for component in range(4):
            end[OUTER_STATE[component] + axis] += (
                weights[axis, FIRST, component] * force[axis]
                + weights[axis, MIDDLE, component] * middle
                + weights[axis, LAST, component] * f4[axis]
            )
    return contradicted


@njit_inline
def flow_freely(weights: Array, step: float, start: Array, stage: Array, end: Array) -> None:
    """The motion from `start` without contact: relative displacement (m) and velocity (m/s) halfway into the first two
    columns of `stage`, a row an axis, and outer ring and resonator at the end of the step into `end`."""
    for axis in range(2):
        x, v, r, u = start[2 + axis], start[8 + axis], start[4 + axis], start[10 + axis]
        outer = flow_component(weights, axis, HALF, x, v, r, u)
        outer_rate = flow_component(weights, axis, HALF + 1, x, v, r, u)
        stage[axis, 0] = start[axis] + 0.5 * step * start[6 + axis] - outer
        stage[axis, 1] = start[6 + axis] - outer_rate
        for component in range(4):
            end[OUTER_STATE[component] + axis] = flow_component(weights, axis, WHOLE + component, x, v, r, u)


@njit_inner
def flow_component(weights: Array, axis: int, row: int, x: float, v: float, r: float, u: float) -> float:
    """One component of outer ring or resonator after the linear flow alone, from (xo, vo, xr, vr) along one axis."""
    w = weights
    return w[axis, row, 0] * x + w[axis, row, 1] * v + w[axis, row, 2] * r + w[axis, row, 3] * u


march_exponential_rk4 = bind_method("exponential_rk4", step_exponential_rk4)
