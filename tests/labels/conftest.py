import math

import numpy as np
import pytest

from physics import catalog
from physics.cage import CagePath, draw_slip_knots
from physics.imperfections import Imperfections
from physics.operation import Operation
from physics.rig import Rig
from physics.scene import Scene
from physics.spall import Spall

SHAFT_SPEED = 2.0 * math.pi * 7.0


@pytest.fixture
def rig() -> Rig:
    """The gearbox rig of [P14 Table 1]."""
    return catalog.rig("gearbox")


@pytest.fixture
def make_scene(rig):
    """A scene on the gearbox rig: spalls, whether the cage slips by 1 %, whether the rows have separate cages."""

    def make(*spalls: Spall, slip: bool = False, separate: bool = False, duration: float = 0.5, seed: int = 1) -> Scene:
        speed = rig.bearing.cage_speed(SHAFT_SPEED)
        generator = np.random.default_rng(seed)

        def cage(start: float) -> CagePath:
            if not slip:
                return CagePath(speed, duration, start)
            step, first, values = draw_slip_knots(generator, 0.01, 1.0 / (7.0 * rig.bearing.bpfo), duration)
            return CagePath(speed, duration, start, 0.004, step, first, values)

        return Scene(
            rig=rig,
            operation=Operation(SHAFT_SPEED, 346.0),
            cage=cage(0.3),
            spalls=spalls,
            imperfections=Imperfections(),
            second_cage=cage(1.1) if separate else None,
        )

    return make


@pytest.fixture
def line_spall() -> Spall:
    """2° on the outer race, at the bottom of row 1, 12 µm deep, short tapers."""
    return Spall("outer", 1, math.radians(270.0), math.radians(2.0), 12e-6, math.radians(0.3), math.radians(0.3))
