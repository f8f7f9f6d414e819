"""General-purpose solvers compiled throughout, as a user would pick one: no contact change or kink is located.

DOP853 and RK45 with SciPy's tables and step control, and the classical Runge-Kutta method with fixed steps, on the
equations written ball by ball and on this package's contact kernel. They are here to be measured beside the methods of
the folder above, not to be used.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import DOP853, RK45

from physics._jit import njit, specialise
from physics._jit.c_callback import CCallback, c_callback
from physics.arrays import Array
from physics.assembly import assemble
from physics.contact.contact_set import count_changes, reset_contact
from physics.contact.forces import Contacts, set_time
from physics.integrators.accelerations import accelerations
from physics.integrators.events import Way, quintic
from physics.integrators.reference.equations import Equations, write_equations
from physics.integrators.rivals.ball_by_ball import ball_by_ball_slopes
from physics.integrators.state_contact import press_state
from physics.motion import MotionModel, motion_model
from physics.scene import Scene

SAFETY, MOST_SHRINKING, MOST_GROWTH = 0.9, 0.2, 10.0
FIRST_STEP = 1e-9
MOST_STEPS = 20_000_000
# A deviation this small (m) counts as nothing beside the relative tolerance; a generous choice for the solvers.
TYPICAL_DEVIATION = 1e-8
BALL_BY_BALL, CONTACT_KERNEL = "ball by ball", "contact kernel"
PAIRS = ("RK45", "DOP853")


class Tableau(NamedTuple):
    """An embedded pair: stages `a` (S, S) with the new step as last row, nodes `c` (S,) and error weights `e` (2, S).

    The second row of `e` is zero where one is enough; `power` is that of the step control.
    """

    a: Array
    c: Array
    e: Array
    power: float


class Kernel(NamedTuple):
    """This package's contact kernel with its equations of motion."""

    contacts: Contacts
    motion: MotionModel


def _tableau(name: str) -> Tableau:
    pair: Any = {"RK45": RK45, "DOP853": DOP853}[name]
    stages = pair.n_stages
    a = np.zeros((stages + 1, stages))
    a[:stages] = np.asarray(pair.A)[:stages, :stages] if name == "DOP853" else _padded(pair.A, stages)
    a[stages] = pair.B
    errors = [pair.E5, pair.E3] if name == "DOP853" else [pair.E, np.zeros(stages + 1)]
    return Tableau(a, np.append(pair.C, 1.0), np.array(errors), -1.0 / (pair.error_estimator_order + 1.0))


def _padded(table: Array, stages: int) -> Array:
    wide = np.zeros((stages, stages))
    wide[:, : table.shape[1]] = table
    return wide


@njit
def kernel_slopes(model: Kernel, time: float, state: Array) -> Array:
    """Time derivative (12,) of the state by the contact kernel, each ball touching if it is compressed now."""
    set_time(model.contacts, time)
    force = press_state(model.contacts, state)
    if count_changes(model.contacts) > 0:
        reset_contact(model.contacts)
        force = press_state(model.contacts, state)
    result = np.empty(12)
    result[:6] = state[6:]
    accelerations(model.motion, time, state, force, result[6:])
    return result


# Bound by `specialise`: the right-hand side.
slope: Callable[..., Array] = ball_by_ball_slopes


@njit
def _error(
    tableau: Tableau, rates: Array, step: float, state: Array, trial: Array, start: Array, small: Array
) -> float:
    """Estimated error of a step over the tolerance that `small` (13,) holds: relative, then absolute of each entry."""
    fine, coarse = 0.0, 0.0
    for i in range(12):
        scale = small[1 + i] + small[0] * max(abs(state[i] - start[i]), abs(trial[i] - start[i]))
        five, three = 0.0, 0.0
        for stage in range(rates.shape[0]):
            five += tableau.e[0, stage] * rates[stage, i]
            three += tableau.e[1, stage] * rates[stage, i]
        fine += (five / scale) ** 2
        coarse += (three / scale) ** 2
    if fine == 0.0:
        return 0.0
    return step * fine / math.sqrt((fine + 0.01 * coarse) * 12.0)


@njit
def _between(way: Way, begin: Array, end: Array, rate: Array, last: Array, share: float, state: Array) -> None:
    """Fill `state` (12,) at a `share` of the step from `begin` to `end` (12,): displacements on the quintic through
    displacement, velocity and acceleration at both ends, of which `rate` and `last` (12,) have the last.

    `way` has the step; its ends (3, 6) are scratch.
    """
    step = way.step
    for i in range(6):
        way.begin[0, i], way.begin[1, i], way.begin[2, i] = begin[i], step * begin[6 + i], step * step * rate[6 + i]
        way.end[0, i], way.end[1, i], way.end[2, i] = end[i], step * end[6 + i], step * step * last[6 + i]
        state[i], rising = quintic(way, i, share)
        state[6 + i] = rising / step


def _integrate(
    tableau: Tableau, model: Any, start: Array, period: float, samples: int, small: Array
) -> tuple[Array, int]:
    """States (T, 12) at multiples of `period` (s), and how often the right-hand side was read; −1 if it gave up."""
    states, evaluations = np.empty((samples, 12)), 1
    states[0] = start
    stages = tableau.a.shape[1]
    rates, state, trial = np.empty((stages + 1, 12)), start.copy(), np.empty(12)
    ends = np.empty((2, 3, 6))
    rates[0] = slope(model, 0.0, state)
    time, step, sample, rejected = 0.0, FIRST_STEP, 1, False
    for _ in range(MOST_STEPS):
        if sample == samples:
            return states, evaluations
        for stage in range(1, stages + 1):
            for i in range(12):
                moved = 0.0
                for earlier in range(stage):
                    moved += tableau.a[stage, earlier] * rates[earlier, i]
                trial[i] = state[i] + step * moved
            rates[stage] = slope(model, time + tableau.c[stage] * step, trial)
        evaluations += stages
        error = _error(tableau, rates, step, state, trial, start, small)
        growth = MOST_GROWTH if error == 0.0 else min(MOST_GROWTH, max(MOST_SHRINKING, SAFETY * error**tableau.power))
        if not error < 1.0:
            step *= min(growth, 1.0) if math.isfinite(error) else MOST_SHRINKING
            rejected = True
            continue
        way = Way(time, step, ends[0], ends[1])
        while sample < samples and sample * period <= time + step:
            share = (sample * period - time) / step
            _between(way, state, trial, rates[0], rates[stages], share, states[sample])
            sample += 1
        time += step
        state[:] = trial
        rates[0] = rates[stages]
        step *= min(growth, 1.0) if rejected else growth
        rejected = False
    return states, -1


def _integrate_fixed(model: Any, start: Array, period: float, samples: int, substeps: int) -> Array:
    """States (T, 12) at multiples of `period` (s) by the classical Runge-Kutta method, `substeps` steps a period."""
    states, state, trial = np.empty((samples, 12)), start.copy(), np.empty(12)
    states[0] = start
    step = period / substeps
    for sample in range(1, samples):
        for part in range(substeps):
            time = (sample - 1) * period + part * step
            first = slope(model, time, state)
            _move(state, first, 0.5 * step, trial)
            second = slope(model, time + 0.5 * step, trial)
            _move(state, second, 0.5 * step, trial)
            third = slope(model, time + 0.5 * step, trial)
            _move(state, third, step, trial)
            fourth = slope(model, time + step, trial)
            for i in range(12):
                state[i] += step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
        states[sample] = state
    return states


@njit
def _move(state: Array, rate: Array, step: float, moved: Array) -> None:
    for i in range(12):
        moved[i] = state[i] + step * rate[i]


_SOLVERS: Mapping[str, Callable[..., tuple[Array, int]]] = {
    BALL_BY_BALL: specialise(_integrate, "general_purpose_ball_by_ball", slope=ball_by_ball_slopes),
    CONTACT_KERNEL: specialise(_integrate, "general_purpose_contact_kernel", slope=kernel_slopes),
}
_FIXED: Mapping[str, Callable[..., Array]] = {
    BALL_BY_BALL: specialise(_integrate_fixed, "fixed_steps_ball_by_ball", slope=ball_by_ball_slopes),
    CONTACT_KERNEL: specialise(_integrate_fixed, "fixed_steps_contact_kernel", slope=kernel_slopes),
}
_SLOPES: Mapping[str, Callable[..., Array]] = {BALL_BY_BALL: ball_by_ball_slopes, CONTACT_KERNEL: kernel_slopes}


def right_hand_side(scene: Scene, kind: str) -> tuple[Callable[..., Array], Equations | Kernel]:
    """A compiled right-hand side slope(model, time, state) → (12,) of `kind`, and its model of `scene`."""
    if kind == BALL_BY_BALL:
        return _SLOPES[kind], write_equations(scene)
    return _SLOPES[kind], Kernel(assemble(scene), motion_model(scene))


def c_right_hand_side(scene: Scene, kind: str, start: Array) -> CCallback:
    """The right-hand side of `kind` as a C function, of the deviation from the `start` (12,) over typical ones."""
    callback = c_callback(*right_hand_side(scene, kind), start.size)
    callback.data[:12], callback.data[12:24] = start, absolute_tolerance(scene, 1.0)
    return callback


def absolute_tolerance(scene: Scene, tolerance: float) -> Array:
    """Absolute tolerances (12,), m and m/s, that go with a relative one."""
    return tolerance * np.repeat([TYPICAL_DEVIATION, TYPICAL_DEVIATION * scene.rig.free_resonance], 6)


def integrate_compiled(
    scene: Scene, pair: str, kind: str, start: Array, rate: float, samples: int, tolerance: float
) -> tuple[Array, int]:
    """States (T, 12) of `scene` at the instants k / rate by a compiled embedded pair of `PAIRS`; and its evaluations.

    Errors are measured against the deviation from the `start` (12,), as a careful user would.
    """
    _, model = right_hand_side(scene, kind)
    small = np.append(tolerance, absolute_tolerance(scene, tolerance))
    return _SOLVERS[kind](_tableau(pair), model, start, 1.0 / rate, samples, small)


def integrate_by_fixed_steps(scene: Scene, kind: str, start: Array, rate: float, samples: int, substeps: int) -> Array:
    """States (T, 12) of `scene` at the instants k / rate by the classical Runge-Kutta method, `substeps` a sample.

    Steps run through changes of contact and kinks as if there were none, as a first script does; what is unstable ends
    in values that are not finite.
    """
    _, model = right_hand_side(scene, kind)
    return _FIXED[kind](model, start, 1.0 / rate, samples, substeps)
