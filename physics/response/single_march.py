"""One march of a scene, from its starting state to a Trace."""

from __future__ import annotations

import math

import numpy as np

from physics.arrays import Array
from physics.assembly import assemble, ball_numbers
from physics.contact.forces import Contacts
from physics.integrators.method_table import MARCHES, REFERENCE
from physics.integrators.output import (
    HELD,
    LOG_FULL,
    LOGGED,
    NOT_FINITE,
    OUT_OF_STEPS,
    PULLED,
    TALLY_ENTRIES,
    UNLOCATED,
    Grid,
    Output,
)
from physics.integrators.propagator import power_series
from physics.motion import motion_model, resonator_acceleration
from physics.outcome import Outcome, SimulationFailed
from physics.response.change_log import room_for_changes
from physics.response.kinks import known_kinks
from physics.scene import Scene
from physics.trace import ACCELERATION_ALONE, ContactChanges, Kept, Trace

MODEL = "nonlinear 6-DOF"
# No bearing changes its contacts this often all along: what does, does not converge.
LOGGED_CHANGES_PER_STEP = 4


def respond(scene: Scene, start: Array, grid: Grid, method: str, kept: Kept = ACCELERATION_ALONE) -> Trace:
    """Trace of `scene` on `grid` from the state `start` (12,) at t = 0 with what is `kept`, without an error estimate.

    Raises SimulationFailed if the response stops being finite, contact changes more often than can be logged, or steps
    become too many.
    """
    contacts, motion = assemble(scene), motion_model(scene)
    series, stops = power_series(motion, grid.step), known_kinks(scene, contacts, grid.step)
    capacity, most = 0, LOGGED_CHANGES_PER_STEP * grid.samples * grid.substeps
    status = LOG_FULL
    while status == LOG_FULL:
        capacity = room_for_changes(capacity, scene.duration, most)
        output = empty_output(contacts, grid.samples, capacity, kept)
        status = MARCHES[method](contacts, motion, series, grid, stops, start, output)
    require_done(status, f"of {grid.step:.3g} s", f"the method {method} used up its steps within {scene.duration:g} s")
    return trace_of(scene, grid, output, method)


def require_done(status: int, steps: str, out_of_steps: str) -> None:
    """Raise SimulationFailed if a march ended with NOT_FINITE, its `steps` being so long, or with OUT_OF_STEPS."""
    if status == NOT_FINITE:
        raise SimulationFailed(Outcome.NOT_FINITE, f"the response stopped being finite with steps {steps}")
    if status == OUT_OF_STEPS:
        raise SimulationFailed(Outcome.TOO_MANY_STEPS, out_of_steps)


def respond_by_reference(scene: Scene, start: Array, rate: float, samples: int, *, keep_state: bool = False) -> Trace:
    """Trace of `scene` by the slow reference method, at the instants k / rate, from the state `start` (12,)."""
    from physics.integrators.reference.integrate import integrate_reference

    motion = motion_model(scene)
    time = np.arange(samples) / rate
    solution = integrate_reference(scene, start, time)
    acceleration = np.array([[resonator_acceleration(motion, row, axis) for axis in (0, 1)] for row in solution.state])
    changes = solution.changes
    return Trace(
        rate=rate,
        time=time,
        acceleration=acceleration,
        changes=ContactChanges(
            time=np.array([change.time for change in changes], dtype=np.float64),
            row=np.array([change.row for change in changes], dtype=np.int16),
            ball=np.array([change.ball for change in changes], dtype=np.int16),
            made=np.array([change.made for change in changes], dtype=np.bool_),
            initial=np.asarray(solution.initial, dtype=np.bool_),
        ),
        model=MODEL,
        method=REFERENCE,
        step=math.nan,
        error_estimate=math.nan,
        tension_share=math.nan,
        state=solution.state if keep_state else None,
    )


def empty_output(contacts: Contacts, samples: int, capacity: int, kept: Kept) -> Output:
    """Arrays for a march of `samples` instants with what is `kept`, and room for `capacity` changes of contact."""
    balls = contacts.balls.shape[0] * contacts.balls.shape[2]
    return Output(
        acceleration=np.zeros((samples, 2)),
        state=np.zeros((samples if kept.state else 0, 12)),
        force=np.zeros((samples if kept.force else 0, balls)),
        outer=np.zeros((3 if kept.outer else 0, samples, 2)),
        change_time=np.zeros(capacity),
        change_ball=np.zeros(capacity, dtype=np.int64),
        change_made=np.zeros(capacity, dtype=np.bool_),
        initial=np.zeros(balls),
        tally=np.zeros(TALLY_ENTRIES, dtype=np.int64),
        touched=np.zeros(2),
        budget=np.zeros(1),
    )


def trace_of(scene: Scene, grid: Grid, output: Output, method: str) -> Trace:
    """What a march has written into `output`, as a trace without an error estimate."""
    bearing, (row, number) = scene.rig.bearing, ball_numbers(scene)
    real = number >= 0
    changes = slice(0, int(output.tally[LOGGED]))
    ball = output.change_ball[changes]
    force = None
    if output.force.shape[0]:
        normal = output.force[:, real] / math.cos(bearing.contact_angle)
        if scene.contact_law == "no_tension":
            # Inside a step a ball that is just not let go of would pull by as little as the step may be wrong.
            normal = np.maximum(normal, 0.0)
        force = normal.reshape(-1, bearing.rows, bearing.balls)
    held, pulled = float(output.touched[HELD]), float(output.touched[PULLED])
    rate = 1.0 / (grid.substeps * grid.step)
    return Trace(
        rate=rate,
        time=np.arange(grid.samples) / rate,
        acceleration=output.acceleration,
        changes=ContactChanges(
            time=output.change_time[changes].copy(),
            row=(row[ball] + 1).astype(np.int16),
            ball=(number[ball] + 1).astype(np.int16),
            made=output.change_made[changes].copy(),
            initial=output.initial[real].reshape(bearing.rows, bearing.balls) > 0.5,
        ),
        model=MODEL,
        method=method,
        step=grid.step,
        error_estimate=math.nan,
        tension_share=pulled / held if held else 0.0,
        unlocated_changes=int(output.tally[UNLOCATED]),
        state=output.state if output.state.shape[0] else None,
        contact_force=force,
        outer_displacement=output.outer[0] if output.outer.shape[0] else None,
        outer_velocity=output.outer[1] if output.outer.shape[0] else None,
        outer_acceleration=output.outer[2] if output.outer.shape[0] else None,
    )
