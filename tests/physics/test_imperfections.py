import math

import pytest

from physics.checks import InvalidParameter
from physics.imperfections import Imperfections, Waviness


def test_a_bearing_is_perfect_by_default():
    assert Imperfections() == Imperfections(waviness=(), ball_deviation=())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"race": "ball"}, 'race = "ball"; allowed: outer, inner'),
        ({"order": 0}, "order = 0; allowed: whole numbers 1 to 2000"),
        ({"order": 2001}, "order = 2001; allowed: whole numbers 1 to 2000"),
        ({"order": 2.5}, "order = 2.5; allowed: whole numbers"),
        ({"amplitude": 0.0}, "amplitude of order 7 = 0.0 m; allowed: above 0, up to 0.01 m"),
        ({"amplitude": 0.02}, "amplitude of order 7 = 0.02 m; allowed: above 0, up to 0.01 m"),
        ({"phase": math.nan}, "phase = nan rad; allowed: -1e.06 to 1e.06 rad"),
    ],
)
def test_an_impossible_wave_is_refused_by_field_and_value(change, message):
    with pytest.raises(InvalidParameter, match=message) as caught:
        Waviness(**{"race": "outer", "order": 7, "amplitude": 1e-7, **change})
    assert caught.value.field in change


@pytest.mark.parametrize("deviation", [2e-3, math.nan])
def test_a_ball_off_by_millimetres_is_refused(deviation):
    with pytest.raises(InvalidParameter, match=r"ball_deviation = .*; allowed: -0.001 to 0.001 m"):
        Imperfections(ball_deviation=((0.0, deviation),))
