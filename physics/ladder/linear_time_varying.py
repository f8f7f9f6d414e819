"""The linear time-varying model: small motions around the quasi-static positions, excited by the changing stiffness.

M ẍ + C(t) ẋ + K(t) x = 0 in the deviations x from the quasi-static solution, which moves [P14 Eq. 28]. Stiffness,
damping and the force at the quasi-static position are tabulated: over one ball spacing of cage angle where the scene
repeats itself with the balls, slip or not (film forces are of the mean cage speed), else over time. Outer ring and
resonator are exact, as in the step of the nonlinear model, which is used here with a linear contact.

Steps are the fewest that are stable, and run over the jumps that the table has where contacts begin and end: at
65 536 Hz this is off by 0.1 to 3.4 % of the RMS in the reference scenes, less at higher rates, and not estimated. The
model itself is 1 to 2 % off the nonlinear one in G0 and F0 without clearance and 20 to 50 % with 1 to 10 µm of it,
whatever the rate: balls then touch and let go at speed, so the film's force jumps at instants that the vibration moves.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from physics._jit import njit, njit_inline, specialise, uncompiled
from physics.arrays import Array, Flags
from physics.assembly import assemble, ball_numbers
from physics.cage import CagePath
from physics.contact.contact_set import reset_contact
from physics.contact.forces import ACTIVE, Contacts, of_ball, press, set_time
from physics.contact.track import Track, cage_at
from physics.integrators.contact_tangent import contact_tangent
from physics.integrators.exponential_rk4 import step_exponential_rk4
from physics.integrators.fixed_step_march import workspace
from physics.integrators.method_table import METHODS
from physics.integrators.propagator import PowerSeries, power_series, set_step
from physics.ladder.contact_sets import changes_between_samples
from physics.ladder.model import Model
from physics.motion import MotionModel, motion_model, resonator_acceleration, starting_state
from physics.outcome import Outcome, SimulationFailed
from physics.response.stability import require_stable, stable_substeps
from physics.scene import Scene
from physics.statics.load_distribution import load_vector, refuse, resting
from physics.statics.rest import NO_EQUILIBRIUM, solve_at
from physics.trace import ContactChanges, Kept, Trace

# Nodes of the table over a spacing of cage angle, or a sample of time.
NODES_PER_SPACING, NODES_PER_SAMPLE = 4096, 2
METHOD = "exponential_rk4"
# Columns of the table: force (N) at zero displacement and velocity, stiffness (N/m) and damping (N s/m).
COLUMNS = 9
FORCE_X, FORCE_Y, K_XX, K_XY, K_YX, K_YY, C_XX, C_XY, C_YY = range(COLUMNS)


class TableAxis(NamedTuple):
    """Where in the table a time lies: cage angle over `period` (rad) if that is above zero, else time, per `width`."""

    track: Track
    period: float
    width: float


def repeats_with_the_balls(scene: Scene) -> bool:
    """Whether every quantity is a function of the cage angle that returns after one ball spacing.

    This asks for no period of time, as response.periodic.balls_a_period does: slip may be. But balls that differ, whose
    period is a turn of the cage, and two cages, even of one speed, are tabulated in time.
    """
    return not scene.turns_with_the_shaft and scene.balls_are_alike and scene.second_cage is None


@njit
def _linearise(contacts: Contacts, time: Array, loads: Array) -> tuple[Array, Flags, int]:
    """Table (N, 9), who touches (N, M), and the first index without a position, or −1."""
    table = np.zeros((time.size, COLUMNS))
    touching = np.zeros((time.size, contacts.balls.shape[0] * contacts.balls.shape[2]), dtype=np.bool_)
    dx, dy = 0.0, 0.0
    for k in range(time.size):
        set_time(contacts, time[k])
        dx, dy, _, status = solve_at(contacts, loads[k, 0], loads[k, 1], dx, dy)
        if status == NO_EQUILIBRIUM:
            return table, touching, k
        press(contacts, dx, dy, 0.0, 0.0)
        reset_contact(contacts)
        fx, fy = press(contacts, dx, dy, 0.0, 0.0)
        xx, xy, yx, yy = contact_tangent(contacts, 0.0)
        cxx, cxy, _, cyy = contact_tangent(contacts, 1.0)
        table[k] = fx - xx * dx - xy * dy, fy - yx * dx - yy * dy, xx, xy, yx, yy, cxx - xx, cxy - xy, cyy - yy
        for ball in range(touching.shape[1]):
            touching[k, ball] = of_ball(contacts.balls, ACTIVE, ball) > 0.5
    return table, touching, -1


class LinearContacts(NamedTuple):
    """What takes the place of the nonlinear model's contacts: the `table` (N, 9) and its `row` (9,) at some time."""

    table: Array
    axis: TableAxis
    row: Array


@njit_inline
def _look_up(contacts: LinearContacts, time: float) -> None:
    """Bring the row to `time` (s), on straight lines between the nodes of the table."""
    table, axis, row = contacts.table, contacts.axis, contacts.row
    where = time
    if axis.period > 0.0:
        angle = cage_at(axis.track, 0, time)[0]
        where = angle - axis.period * math.floor(angle / axis.period)
    position = where / axis.width
    node = min(max(int(position), 0), table.shape[0] - 2)
    share = position - node
    for column in range(row.size):
        row[column] = table[node, column] + share * (table[node + 1, column] - table[node, column])


@njit_inline
def _pull(contacts: LinearContacts, dx: float, dy: float, vx: float, vy: float) -> tuple[float, float]:
    """Net force (N) of the linear contact at a displacement (m) and velocity (m/s)."""
    row = contacts.row
    return (
        row[FORCE_X] + row[K_XX] * dx + row[K_XY] * dy + row[C_XX] * vx + row[C_XY] * vy,
        row[FORCE_Y] + row[K_YX] * dx + row[K_YY] * dy + row[C_XY] * vx + row[C_YY] * vy,
    )


@njit_inline
def _no_changes(contacts: LinearContacts) -> int:
    return 0


_step = specialise(
    uncompiled(step_exponential_rk4),
    "step_linear_time_varying",
    move_to=_look_up,
    press=_pull,
    count_changes=_no_changes,
)


@njit
def _march(
    table: Array,
    axis: TableAxis,
    motion: MotionModel,
    series: PowerSeries,
    substeps: int,
    start: Array,
    acceleration: Array,
    state: Array,
) -> None:
    """Fill the `acceleration` (T, 2), and the `state` (T or 0, 12), from the state `start`."""
    now, then, work = start.copy(), np.empty(12), workspace(0, 0)
    contacts = LinearContacts(table, axis, np.empty(COLUMNS))
    set_step(series, work.weights, 1.0)
    _look_up(contacts, 0.0)
    for sample in range(acceleration.shape[0]):
        acceleration[sample, 0] = resonator_acceleration(motion, now, 0)
        acceleration[sample, 1] = resonator_acceleration(motion, now, 1)
        if sample < state.shape[0]:
            state[sample] = now
        for substep in range(substeps):
            time = (sample * substeps + substep) * series.step
            force = _pull(contacts, now[0] - now[2], now[1] - now[3], now[6] - now[8], now[7] - now[9])
            _step(contacts, motion, work, time, series.step, now, force, then)
            now, then = then, now


def _table(scene: Scene, samples: int, rate: float) -> tuple[Array, Array, Flags]:
    """Times (N,), table (N, 9) and who touches (N, M); raises SimulationFailed."""
    if repeats_with_the_balls(scene):
        speed, period = scene.cage.mean_speed, scene.rig.bearing.spacing
        contacts = assemble(replace(scene, cage=CagePath(speed, 1.5 * period / speed)))
        time = np.linspace(0.0, period / speed, NODES_PER_SPACING + 1)
    else:
        contacts = assemble(scene)
        time = np.arange(NODES_PER_SAMPLE * samples + 1) / (NODES_PER_SAMPLE * rate)
    loads = load_vector(scene, time)
    table, touching, lost = _linearise(contacts, time, loads)
    if lost >= 0:
        refuse(scene, float(time[lost]))
    return time, table, touching


def _changes(scene: Scene, touching: Flags, samples: int, rate: float) -> ContactChanges:
    """Changes of contact between samples, from who touches (N, M) at the nodes of the table."""
    bearing, (_, ball) = scene.rig.bearing, ball_numbers(scene)
    real = touching[:, ball >= 0].reshape(-1, bearing.rows, bearing.balls)
    # Nodes between which nothing changes have the same number.
    number = np.concatenate([[0], np.cumsum((real[1:] != real[:-1]).any(axis=(1, 2)))])
    if not repeats_with_the_balls(scene):
        node, passed = np.arange(samples) * NODES_PER_SAMPLE, np.zeros(samples, np.int64)
    else:
        turned = scene.cage.angle(np.arange(samples) / rate) / bearing.spacing
        passed = np.floor(turned).astype(np.int64)
        node = ((turned - passed) * NODES_PER_SPACING).astype(np.int64)
    moved = (np.diff(number[node]) != 0) | (np.diff(passed) != 0)
    sample = np.concatenate([[0], 1 + np.flatnonzero(moved)])
    # After `passed` spacings a ball stands where, in the table, the one that many places further on does.
    stands_as = (np.arange(bearing.balls) + passed[sample, None]) % bearing.balls
    seen = np.stack([real[node[sample, None], row, stands_as] for row in range(bearing.rows)], axis=1)
    return changes_between_samples(seen, sample, rate)


def linear_response(scene: Scene, rate: float, keep: Kept) -> Trace:
    """Response of `scene` at the instants k / rate (Hz), linearised around its quasi-static positions.

    Contact changes are those of the quasi-static positions, known to half a sample. Raises SimulationFailed where no
    position carries the load, or the contacts are too stiff for the steps that can be made.
    """
    samples = scene.samples(rate)
    contacts, motion = assemble(scene), motion_model(scene)
    rest = resting(scene)
    substeps = stable_substeps(scene, METHODS[METHOD], rest, rate)
    require_stable(METHODS[METHOD], rate, substeps, substeps)
    time, table, touching = _table(scene, samples, rate)
    repeats = repeats_with_the_balls(scene)
    width = scene.rig.bearing.spacing / NODES_PER_SPACING if repeats else float(time[1])
    axis = TableAxis(contacts.track, scene.rig.bearing.spacing if repeats else 0.0, width)
    acceleration, state = np.zeros((samples, 2)), np.zeros((samples if keep.state else 0, 12))
    series = power_series(motion, 1.0 / (rate * substeps))
    start = starting_state(motion, rest.displacement[0])
    _march(table, axis, motion, series, substeps, start, acceleration, state)
    if not np.isfinite(acceleration).all():
        raise SimulationFailed(
            Outcome.NOT_FINITE, f"the response stopped being finite with steps of {series.step:.3g} s"
        )
    return Trace(
        rate=rate,
        time=np.arange(samples) / rate,
        acceleration=acceleration,
        changes=_changes(scene, touching, samples, rate),
        model=LINEAR_TIME_VARYING.name,
        method=METHOD,
        step=series.step,
        error_estimate=math.nan,
        tension_share=math.nan,
        state=state if keep.state else None,
    )


LINEAR_TIME_VARYING = Model(
    name="linear time-varying",
    computes="acceleration and motion around the quasi-static positions under their changing stiffness",
    holds_where="healthy bearings without clearance, and spalls over which contact forces stay within about a tenth of "
    "the static loads",
    leaves_out="contact lost or made by vibration, and the hardening of the contacts under impacts",
    rings=True,
    keeps=("state",),
    respond=linear_response,
)
