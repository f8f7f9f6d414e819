"""A record whose errors grow for a third of a second keeps the accuracy all the same."""

import numpy as np

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.sampling import draw_scenario
from physics.simulate import simulate

LASTING_RECORD = 4700  # of the wide corpus under this seed: its slowest mode takes a quarter of a second to decay
SEED = 20261125


def test_the_error_of_a_record_whose_errors_grow_is_within_its_estimate():
    drawn = draw_scenario(load_recipe("corpus").model_copy(update={"seed": SEED}), LASTING_RECORD)
    exact = simulate(drawn.scene, drawn.rate, accuracy=1e-5).acceleration
    trace = simulate(drawn.scene, drawn.rate)
    error = np.sqrt(((trace.acceleration - exact) ** 2).mean() / (exact**2).mean())
    assert error <= trace.error_estimate <= 1e-3
