"""One march of a scene, from its starting state to a Trace."""

from __future__ import annotations

import math

import numpy as np

from physics.arrays import Array
from physics.assembly import assemble
from physics.integrators.method_table import MARCHES, REFERENCE
from physics.integrators.output import LOG_FULL, Grid
from physics.integrators.propagator import power_series
from physics.motion import motion_model, resonator_acceleration
from physics.response.change_log import room_for_changes
from physics.response.kinks import known_kinks
from physics.response.march_output import MODEL, empty_output, require_done, trace_of
from physics.scene import Scene
from physics.trace import ACCELERATION_ALONE, ContactChanges, Kept, Trace

# No bearing changes its contacts this often all along: what does, does not converge.
LOGGED_CHANGES_PER_STEP = 4


def respond(scene: Scene, start: Array, grid: Grid, method: str, keep: Kept = ACCELERATION_ALONE) -> Trace:
    """Trace of `scene` on `grid` from the state `start` (12,) at t = 0, with what it is to `keep`, and no error
    estimate.

    Raises SimulationFailed if the response stops being finite, contact changes more often than can be logged, or steps
    become too many.
    """
    contacts, motion = assemble(scene), motion_model(scene)
    series, stops = power_series(motion, grid.step), known_kinks(scene, contacts, grid.step)
    capacity, most = 0, LOGGED_CHANGES_PER_STEP * grid.samples * grid.substeps
    status = LOG_FULL
    while status == LOG_FULL:
        capacity = room_for_changes(capacity, scene.duration, most)
        output = empty_output(contacts, grid.samples, capacity, keep)
        status = MARCHES[method](contacts, motion, series, grid, stops, start, output)
    require_done(status, f"of {grid.step:.3g} s", f"the method {method} used up its steps within {scene.duration:g} s")
    return trace_of(scene, grid, output, method)


def respond_by_reference(scene: Scene, start: Array, rate: float, samples: int, *, keep_state: bool) -> Trace:
    """Trace of `scene` by the slow reference method, at the instants k / rate, from the state `start` (12,)."""
    # SciPy's solvers take a tenth of a second to load, for which only those who ask for the reference should wait.
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
