"""Records whose errors grow from ball pass to ball pass keep the accuracy all the same, or say that they cannot."""

import numpy as np

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.sampling import draw_scenario
from physics.simulate import simulate


def _drawn(seed, record):
    return draw_scenario(load_recipe("corpus").model_copy(update={"seed": seed}), record)


def _apart(one, other):
    return np.sqrt(((one.acceleration - other.acceleration) ** 2).mean() / (other.acceleration**2).mean())


def test_the_error_of_a_record_whose_errors_grow_is_within_its_estimate():
    drawn = _drawn(20261125, 4700)  # its slowest mode takes a quarter of a second to decay
    trace, exact = simulate(drawn.scene, drawn.rate), simulate(drawn.scene, drawn.rate, accuracy=1e-5)
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


def test_a_record_whose_errors_grow_all_along_is_called_chaotic():
    drawn = _drawn(20261126, 2200)
    one, other = (simulate(drawn.scene, drawn.rate, accuracy=accuracy) for accuracy in (1e-2, 1e-3))
    assert one.chaotic
    assert other.chaotic
    assert other.error_estimate == 1.0
    fine = simulate(drawn.scene, drawn.rate, substeps=16, estimate_error=False)
    assert _apart(other, fine) > 1e-3
