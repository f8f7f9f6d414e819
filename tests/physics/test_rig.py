import dataclasses
import math

import numpy as np
import pytest
from scipy.linalg import eigh

from physics.checks import InvalidParameter


@pytest.mark.parametrize("matrix", ["mass_matrix", "stiffness_matrix", "damping_matrix"])
def test_the_matrices_of_a_rig_are_symmetric_and_never_drive(fan, matrix):
    values = getattr(fan, matrix)()
    assert values.shape == (6, 6)
    assert np.array_equal(values, values.T)
    assert np.linalg.eigvalsh(values).min() >= -1e-9 * np.abs(values).max()  # rounding


def test_the_shaft_is_held_by_nothing_but_the_bearing(fan):
    assert np.all(fan.stiffness_matrix()[:2] == 0.0)
    assert np.all(fan.damping_matrix()[:2] == 0.0)


def test_moving_outer_ring_and_resonator_together_stretches_only_the_support(fan):
    uneven = {"support_stiffness_y": 3.0 * fan.support_stiffness_y, "support_damping_y": 0.5 * fan.support_damping_y}
    fan = dataclasses.replace(fan, **uneven)
    together = np.array([0.0, 0.0, 2.0, 3.0, 2.0, 3.0])
    force = fan.stiffness_matrix() @ together
    expected = [0.0, 0.0, 2.0 * fan.support_stiffness_x, 3.0 * fan.support_stiffness_y, 0.0, 0.0]
    assert force == pytest.approx(expected, rel=1e-12, abs=1e-6)  # rounding of sums of 1e9
    drag = fan.damping_matrix() @ together
    expected = [0.0, 0.0, 2.0 * fan.support_damping_x, 3.0 * fan.support_damping_y, 0.0, 0.0]
    assert drag == pytest.approx(expected, rel=1e-12, abs=1e-9)  # rounding of sums of 1e3


def test_the_free_resonance_is_the_fastest_mode_on_next_to_no_support(fan):
    hanging = dataclasses.replace(fan, support_stiffness_x=1.0, support_stiffness_y=1.0)
    squared = eigh(hanging.stiffness_matrix(), hanging.mass_matrix(), eigvals_only=True)
    assert fan.free_resonance == pytest.approx(math.sqrt(squared[-1]), rel=1e-6)  # 1 N/m beside 4e8


def test_each_mass_stands_twice_on_the_diagonal(gearbox):
    assert np.array_equal(np.diag(gearbox.mass_matrix()), [0.5134, 0.5134, 10.268, 10.268, 0.5, 0.5])
    assert np.count_nonzero(gearbox.mass_matrix()) == 6


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inner_mass": 0.0}, "inner_mass = 0.0 kg; it must be above 0"),
        ({"resonator_mass": float("nan")}, "resonator_mass = nan kg; it must be above 0"),
        ({"support_stiffness_y": -1.0}, "support_stiffness_y = -1.0 N/m; it must be above 0"),
        ({"resonator_stiffness": float("inf")}, "resonator_stiffness = inf N/m; it must be above 0"),
        *(
            ({f"{place}_damping{axis}": -1.0}, f"{place}_damping{axis} = -1.0 N s/m; it must not be below 0")
            for place, axis in (("support", "_x"), ("support", "_y"), ("resonator", ""), ("film", ""))
        ),
        ({"rated_speed": 0.0}, "rated_speed = 0.0 rad/s; it must be above 0"),
        ({"rated_load": 0.0}, "rated_load = 0.0 N; it must be above 0"),
    ],
)
def test_an_impossible_rig_is_refused_by_field_and_value(fan, change, message):
    with pytest.raises(InvalidParameter, match=message) as caught:
        dataclasses.replace(fan, **change)
    assert caught.value.field in change
