import numpy as np
import pytest

from physics.checks import InvalidParameter
from physics.sensor.chain import SensorChain, sensed
from physics.sensor.mode import SensorMode, mode_accelerations
from physics.sensor.mounting import Mounting, mounted
from physics.simulate import simulate

MODES = (SensorMode(2500.0, 0.02, 1.5), SensorMode(7100.0, 0.04, 0.6))


@pytest.fixture(scope="module")
def trace(reference_scene):
    return simulate(reference_scene("F1", 0.05), 65536.0, keep_outer=True, estimate_error=False)


def test_by_default_the_sensor_shows_the_resonators_acceleration_alone(trace):
    assert sensed(SensorChain(), trace) is trace.acceleration


def test_modes_add_to_the_resonator_and_the_mounting_comes_last(trace):
    motion = (trace.outer_displacement, trace.outer_velocity, trace.outer_acceleration)
    parts = [mode_accelerations([mode], *motion, trace.rate) for mode in MODES]
    together = 0.5 * trace.acceleration + parts[0] + parts[1]
    chain = SensorChain(MODES, 0.5, Mounting(9000.0, 4))
    assert sensed(chain, trace) == pytest.approx(mounted(Mounting(9000.0, 4), together, trace.rate), rel=1e-12)


def test_modes_do_not_push_back(trace, reference_scene):
    alone = simulate(reference_scene("F1", 0.05), 65536.0, estimate_error=False)
    assert np.array_equal(alone.acceleration, trace.acceleration)


def test_a_trace_without_the_outer_rings_motion_is_refused_with_the_remedy(reference_scene):
    bare = simulate(reference_scene("F0", 0.01), 65536.0, estimate_error=False)
    with pytest.raises(ValueError, match=r"simulate\(\.\.\., keep_outer=True\)"):
        sensed(SensorChain(MODES), bare)


def test_a_negative_gain_of_the_resonator_is_refused():
    with pytest.raises(InvalidParameter, match=r"resonator_gain = -1\.0; it must not be below 0"):
        SensorChain(resonator_gain=-1.0)
