"""Whether a drawn scene can rest: the bound against the solved equilibrium."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from datagen.scenarios.feasibility import CERTAIN_REACH, farthest_rest, require_equilibrium
from physics import catalog
from physics.cage import CagePath
from physics.checks import InvalidParameter
from physics.imperfections import Imperfections, Waviness
from physics.operation import Operation
from physics.scene import Scene
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium


def scene(load: float, factor: float = 1.0, depth: float = 0.0, cage_angle: float = 0.0, name: str = "mfpt") -> Scene:
    """A rig's scene at rest with a softened bearing and a wide spall in the load zone."""
    rig = catalog.rig(name)
    bearing = replace(rig.bearing, load_deflection=factor * rig.bearing.load_deflection)
    spalls = (Spall("outer", 1, math.radians(270), 1.0, depth),) if depth else ()
    cage = CagePath(10.0, 1.0, cage_angle)
    return Scene(replace(rig, bearing=bearing), Operation(100.0, load), cage, spalls)


@pytest.mark.parametrize("load", [1.0, 100.0, 1e4])
@pytest.mark.parametrize("depth", [0.0, 2e-5, 1e-3])
def test_the_shaft_rests_within_the_bound(load: float, depth: float) -> None:
    for angle in np.linspace(0.0, 2 * math.pi / 8, 5):
        one = scene(load, depth=depth, cage_angle=float(angle))
        rest = float(np.hypot(*equilibrium(one, np.zeros(1)).displacement[0]))
        assert 0.0 < rest <= farthest_rest(one)


def test_small_balls_and_waves_of_the_race_are_within_the_bound_as_a_floor_of_their_depth_is() -> None:
    plain = scene(100.0)
    bearing = plain.rig.bearing
    side = math.cos(bearing.spacing / 2.0)
    small = Imperfections(ball_deviation=((-3e-4,) * bearing.balls,) * bearing.rows)
    wavy = Imperfections(waviness=(Waviness("outer", 2, 1e-4), Waviness("inner", 3, 2e-4)))
    for imperfections in (small, wavy):
        one = replace(plain, imperfections=imperfections)
        assert farthest_rest(one) - farthest_rest(plain) == pytest.approx(3e-4 / side)
        assert float(np.hypot(*equilibrium(one, np.zeros(1)).displacement[0])) <= farthest_rest(one)


def test_no_usual_scene_is_in_doubt() -> None:
    assert all(farthest_rest(scene(1e4, depth=1e-3, name=name)) < CERTAIN_REACH for name in catalog.RIGS)


def test_a_load_that_no_position_carries_is_refused() -> None:
    with pytest.raises(InvalidParameter, match="no position of the shaft carries the load of 1e"):
        require_equilibrium(scene(1e7, factor=1e-5), 0.0)


def test_a_doubtful_load_that_is_carried_after_all_is_accepted() -> None:
    doubtful = scene(1e3, factor=2e-4)
    assert farthest_rest(doubtful) > CERTAIN_REACH
    require_equilibrium(doubtful, 0.0)


def test_the_bound_grows_by_six_roughnesses_of_the_floor_and_with_the_unbalance_as_with_load() -> None:
    smooth = scene(100.0, depth=1e-5)
    rough = replace(smooth, spalls=(replace(smooth.spalls[0], roughness=2e-6),))
    side = math.cos(smooth.rig.bearing.spacing / 2.0)
    assert farthest_rest(rough) - farthest_rest(smooth) == pytest.approx(6.0 * 2e-6 / side)
    unbalanced = replace(smooth, operation=Operation(100.0, 40.0, unbalance_force=60.0))
    assert farthest_rest(unbalanced) == pytest.approx(farthest_rest(smooth))
    swinging = replace(smooth, operation=Operation(100.0, 40.0, load_fluctuation=1.5))
    assert farthest_rest(swinging) == pytest.approx(farthest_rest(smooth))
