"""A case and outputs that no march has made, so that what is to be done about responses follows from chosen ones."""

import math
from types import SimpleNamespace

import numpy as np

from physics.contact.forces import Contacts
from physics.imperfections import Imperfections
from physics.integrators.output import Output
from physics.operation import Operation
from physics.response.goal import Goal
from physics.trace import ACCELERATION_ALONE

SAMPLES, RATE, PUSH, LOAD, MASS = 400, 1000.0, 2.0, 50.0, 5.0
# Eight balls that a preload presses with 1e3 · 0.04 ** 1.5 N each.
BEARING = SimpleNamespace(rows=2, balls=4, radial_load_deflection=1e3, clearance=-0.04, exponent=1.5, contact_angle=0.0)
PRELOAD = 8 * 8.0


def a_case(error_memory=0.0):
    """A push of 1 N s rings like 1 / (0.3 · rate · PUSH²), so that PUSH N s make 1 m/s² at the usual number."""
    ringing = 1.0 / (0.3 * RATE * PUSH**2)
    return SimpleNamespace(
        contacts=Contacts(np.zeros((1, 11, 4)), np.zeros((1, 3)), None, None),
        scene=SimpleNamespace(
            duration=SAMPLES / RATE,
            operation=Operation(1.0, LOAD),
            rig=SimpleNamespace(outer_mass=MASS, bearing=BEARING),
            imperfections=Imperfections(),
        ),
        rate=RATE,
        push=PUSH,
        error_memory=error_memory,
        pushed=lambda output: math.sqrt(0.5 * ringing * output.spent[0] * RATE / output.acceleration.shape[0]),
    )


def an_output(acceleration, pushed=0.0, steps=100, initial=(1.0, 1.0, 0.0), made=()):
    """An output of which the steps' errors add up to `pushed` (m/s²); `made`: contacts made (True) and lost."""
    logged = len(made)
    return Output(
        acceleration=np.asarray(acceleration),
        state=np.zeros((0, 12)),
        force=np.zeros((0, 4)),
        outer=np.zeros((0, 0, 2)),
        change_time=np.zeros(logged + 3),
        change_ball=np.zeros(logged + 3, dtype=np.int64),
        change_made=np.array([*made, False, False, False], dtype=np.bool_),
        initial=np.array(initial),
        tally=np.array([logged, 0, steps]),
        touched=np.zeros(2),
        spent=np.array([2.0 * 0.3 * PUSH**2 * pushed**2 * len(acceleration)]),
    )


def a_goal(go_on=None, accuracy=1e-3, least_error=0.0):
    return Goal(a_case(), SAMPLES, accuracy, least_error, ACCELERATION_ALONE, go_on)


def tolerance(grid):
    """The relative tolerance of a grid, of a signal of 1 m/s²."""
    return grid.share / (PUSH * math.sqrt(0.5))


class World:
    """Stands in for go_on: what response a tolerance gives, by `response(tolerance, number of the call)` → Output."""

    def __init__(self, response):
        self.response, self.marches, self.asked = response, [], []

    def __call__(self, march, grid):
        self.marches.append(march)
        self.asked.append(tolerance(grid))
        return self.response(self.asked[-1], len(self.asked))
