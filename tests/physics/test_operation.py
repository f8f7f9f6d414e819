import math

import pytest

from physics.checks import InvalidParameter
from physics.operation import Operation


def test_rotating_loads_are_absent_by_default():
    run = Operation(shaft_speed=44.0, load=346.0)
    assert (run.unbalance_force, run.load_fluctuation) == (0.0, 0.0)


@pytest.mark.parametrize("load", [0.0, -100.0])
def test_zero_and_reversed_loads_are_allowed(load):
    assert Operation(shaft_speed=44.0, load=load).load == load


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"shaft_speed": 0.0}, "shaft_speed = 0.0 rad/s; it must be above 0"),
        ({"shaft_speed": math.nan}, "shaft_speed = nan rad/s"),
        ({"load": math.inf}, "load = inf N; allowed: -1e\\+07 to 1e\\+07 N"),
        ({"unbalance_force": -1.0}, "unbalance_force = -1.0 N; it must not be below 0"),
        ({"unbalance_phase": math.nan}, "unbalance_phase = nan rad; allowed: -1e.06 to 1e.06 rad"),
        ({"load_fluctuation": 10.1}, "load_fluctuation = 10.1; allowed: 0 to 10"),
        ({"load_fluctuation": -0.1}, "load_fluctuation = -0.1; allowed: 0 to 10"),
        ({"fluctuation_phase": math.inf}, "fluctuation_phase = inf rad; allowed: -1e.06 to 1e.06 rad"),
    ],
)
def test_an_impossible_operation_is_refused_by_field_and_value(change, message):
    with pytest.raises(InvalidParameter, match=message) as caught:
        Operation(**{"shaft_speed": 44.0, "load": 346.0, **change})
    assert caught.value.field in change


def test_the_bound_of_the_load_holds_static_load_its_swing_and_what_turns():
    run = Operation(shaft_speed=44.0, load=-100.0, unbalance_force=30.0, load_fluctuation=0.5)
    assert run.load_bound == 180.0
