"""What a march of the nonlinear model writes into, how it may have ended, and the trace that comes of it."""

from __future__ import annotations

import math

import numpy as np

from physics.assembly import ball_numbers
from physics.contact.forces import Contacts
from physics.integrators.output import (
    LOGGED,
    NOT_FINITE,
    OUT_OF_STEPS,
    PULLED,
    TALLY_ENTRIES,
    TOUCHED,
    UNLOCATED,
    Grid,
    Output,
)
from physics.outcome import Outcome, SimulationFailed
from physics.scene import Scene
from physics.trace import ContactChanges, Kept, OuterMotion, Trace

MODEL = "nonlinear 6-DOF"


def require_done(status: int, steps: str, out_of_steps: str) -> None:
    """Raise SimulationFailed if a march ended with NOT_FINITE, its `steps` being so long, or with OUT_OF_STEPS."""
    if status == NOT_FINITE:
        raise SimulationFailed(Outcome.NOT_FINITE, f"the response stopped being finite with steps {steps}")
    if status == OUT_OF_STEPS:
        raise SimulationFailed(Outcome.TOO_MANY_STEPS, out_of_steps)


def empty_output(contacts: Contacts, samples: int, capacity: int, keep: Kept) -> Output:
    """Arrays for a march of `samples` instants, what it is to `keep`, and room for `capacity` changes of contact."""
    balls = contacts.balls.shape[0] * contacts.balls.shape[2]
    return Output(
        acceleration=np.zeros((samples, 2)),
        state=np.zeros((samples if keep.state else 0, 12)),
        force=np.zeros((samples if keep.force else 0, balls)),
        outer=np.zeros((3 if keep.outer else 0, samples, 2)),
        change_time=np.zeros(capacity),
        change_ball=np.zeros(capacity, dtype=np.int64),
        change_made=np.zeros(capacity, dtype=np.bool_),
        initial=np.zeros(balls),
        tally=np.zeros(TALLY_ENTRIES, dtype=np.int64),
        touched=np.zeros(2),
        spent=np.zeros(1),
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
        if scene.no_tension:
            # Inside a step a ball that is just not let go of would pull by as little as the step may be wrong.
            normal = np.maximum(normal, 0.0)
        force = normal.reshape(-1, bearing.rows, bearing.balls)
    touched, pulled = float(output.touched[TOUCHED]), float(output.touched[PULLED])
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
        tension_share=pulled / touched if touched else 0.0,
        unlocated_changes=int(output.tally[UNLOCATED]),
        state=output.state if output.state.shape[0] else None,
        contact_force=force,
        outer=OuterMotion(rate, *output.outer) if output.outer.shape[0] else None,
    )
