import numpy as np
import pytest

from physics.checks import InvalidParameter
from physics.imperfections import Imperfections
from physics.statics.ball_load import ball_load
from physics.statics.load_distribution import equilibrium

INSTANTS = np.sort(np.random.default_rng(5).uniform(0.0, 0.05, 60))
BALLS = np.random.default_rng(6).integers(1, 13, 60)
SCENES = {
    "two rows": {},
    "tilted contacts": {"bearing": {"contact_angle": 0.3}},
    "unequal balls": {"imperfections": Imperfections(ball_deviation=((3e-7, *(0.0,) * 11), (0.0,) * 12))},
    "turning loads": {"operation": {"load_fluctuation": 0.3, "unbalance_force": 100.0}},
}


@pytest.mark.parametrize("row", [1, 2])
@pytest.mark.parametrize("variant", SCENES)
def test_it_is_the_load_that_the_equilibrium_of_all_balls_gives_this_one(gearbox, build_scene, variant, row):
    scene = build_scene(gearbox, start_angle=0.05, **SCENES[variant])
    every = equilibrium(scene, INSTANTS).ball_load
    expected = every[np.arange(INSTANTS.size), row - 1, BALLS - 1]
    found = ball_load(scene, INSTANTS, row, BALLS)
    assert found == pytest.approx(expected, abs=1e-7 * every.max())  # a billionth of the shaft's load, unbalanced
    assert np.count_nonzero(found) > 10


@pytest.mark.parametrize(
    ("row", "ball", "message"),
    [
        (0, 1, "row = 0; allowed: whole numbers 1 to 2"),
        (3, 1, "row = 3; allowed: whole numbers 1 to 2"),
        (1, 0, "ball = 0; allowed: whole numbers 1 to 12"),
        (2, 13, "ball = 13; allowed: whole numbers 1 to 12"),
    ],
)
def test_a_row_or_ball_that_there_is_not_is_refused(gearbox, build_scene, row, ball, message):
    with pytest.raises(InvalidParameter, match=message):
        ball_load(build_scene(gearbox), np.zeros(1), row, np.array([ball]))
