"""A ball that leaps from bump to bump of a rough floor changes sides once at an instant, not over and over."""

import numpy as np

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.sampling import draw_scenario
from physics.simulate import simulate


def test_a_ball_that_meets_a_bump_is_not_told_to_leave_it_at_the_same_instant():
    recipe = load_recipe("corpus").model_copy(update={"seed": 20261226})
    drawn = draw_scenario(recipe, 154)  # changes sides 42 000 times a second
    trace = simulate(drawn.scene, drawn.rate)
    changes = trace.changes
    order = np.lexsort((changes.time, changes.ball, changes.row))
    time, place = changes.time[order], np.stack([changes.row[order], changes.ball[order]])
    at_once = (np.diff(time) < 1e-12) & (np.diff(place) == 0).all(axis=0)
    assert not (at_once[1:] & at_once[:-1]).any()
    assert trace.unlocated_changes == 0
