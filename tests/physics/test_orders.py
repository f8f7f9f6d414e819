"""Orders of a bearing, against published values and an identity."""

import numpy as np
import pytest

from physics.orders import ball_spin_order, cage_order, inner_pass_order, outer_pass_order


def test_orders_are_those_that_cwru_publishes_for_its_6205():
    ratio = 7.94 / 39.04  # published to four decimals from dimensions in inches; rounded to 0.01 mm here
    assert cage_order(ratio) == pytest.approx(0.39828, abs=1e-4)
    assert outer_pass_order(9, ratio) == pytest.approx(3.5848, abs=5e-4)
    assert inner_pass_order(9, ratio) == pytest.approx(5.4152, abs=5e-4)
    assert 2.0 * ball_spin_order(1.0 / ratio, ratio) == pytest.approx(4.7135, abs=5e-4)


@pytest.mark.parametrize("ratio", np.linspace(0.02, 0.9, 12))
def test_a_ball_whose_contacts_are_tilted_rolls_on_the_outer_race_all_the_same(ratio):
    # Its circle of contact has the radius Db cos(α) / 2 about the axis on which it spins, the race (Dp + Db cos α) / 2.
    tilt = np.cos(np.radians(25.0))
    pitch_over_ball = tilt / ratio
    rolled_off = ball_spin_order(pitch_over_ball, ratio) / pitch_over_ball
    assert rolled_off == pytest.approx(cage_order(ratio) * (1.0 + ratio), rel=1e-12)  # rounding
