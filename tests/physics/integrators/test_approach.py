"""How long steps beside a change of contact may be."""

import pytest

from physics.contact.forces import Law
from physics.integrators.modal.approach import graded_length


@pytest.mark.parametrize("exponent", [1.1, 10.0 / 9.0, 1.3, 1.5, 1.8])
@pytest.mark.parametrize("speed", [2e-3, -0.3])
def test_simpsons_rule_over_a_step_from_the_start_of_contact_is_wrong_by_the_tolerance(exponent, speed):
    tolerance, law = 1e-6, Law(1e9, exponent, 0.0, False)
    step = graded_length.py_func(law, speed, tolerance)
    start, middle, end = (law.stiffness * (share * abs(speed) * step) ** exponent for share in (0.0, 0.5, 1.0))
    exact = law.stiffness * (abs(speed) * step) ** exponent * step / (exponent + 1.0)
    assert abs((start + 4.0 * middle + end) / 6.0 * step - exact) == pytest.approx(tolerance, rel=0.05)


@pytest.mark.parametrize("exponent", [1.0, 2.0])
def test_where_simpsons_rule_is_exact_a_step_is_graded_as_if_it_were_wrong_by_a_ten_thousandth(exponent):
    step = graded_length.py_func(Law(1e9, exponent, 0.0, False), 0.1, 1e-6)
    assert 1e-4 * 1e9 * (0.1 * step) ** exponent * step == pytest.approx(1e-6)
