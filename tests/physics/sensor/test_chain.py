import dataclasses
import math

import numpy as np
import pytest
from scipy.signal import firwin, lsim, upfirdn

from physics.checks import InvalidParameter
from physics.request import Accurate
from physics.rms import relative_error
from physics.sensor.chain import SensorChain, sensed
from physics.sensor.mode import SensorMode, mode_accelerations
from physics.sensor.mounting import Mounting, mounted
from physics.simulate import simulate
from physics.spall import Spall
from physics.trace import Kept

MODES = (SensorMode(2500.0, 0.02, 1.5), SensorMode(7100.0, 0.04, 0.6))


@pytest.fixture(scope="module")
def trace(reference_scene):
    return simulate(reference_scene("F1", 0.05), 65536.0, keep=Kept(outer=True))


def test_by_default_the_sensor_shows_the_resonators_acceleration_alone(trace):
    assert sensed(SensorChain(), trace) is trace.acceleration


@pytest.mark.parametrize("gain", [0.0, 0.5, 3.0])
def test_the_gain_multiplies_the_resonator_alone(trace, gain):
    assert np.array_equal(sensed(SensorChain(resonator_gain=gain), trace), gain * trace.acceleration)


def test_modes_add_to_the_resonator_and_the_mounting_comes_last(trace):
    parts = [mode_accelerations([mode], trace.outer) for mode in MODES]
    together = 0.5 * trace.acceleration + parts[0] + parts[1]
    chain = SensorChain(MODES, 0.5, Mounting(9000.0, 4))
    assert sensed(chain, trace) == pytest.approx(mounted(Mounting(9000.0, 4), together, trace.rate), rel=1e-12)


def test_the_mounting_works_at_the_rate_of_the_trace_and_not_at_that_of_the_outer_ring(trace):
    slower = {"time": trace.time[::2], "acceleration": trace.acceleration[::2]}
    lower = dataclasses.replace(trace, rate=trace.rate / 2.0, **slower)
    bare, mounting = SensorChain(MODES), Mounting(9000.0, 4)
    expected = mounted(mounting, sensed(bare, lower), lower.rate)
    assert np.array_equal(sensed(dataclasses.replace(bare, mounting=mounting), lower), expected)


def test_the_fastest_of_its_modes_is_that_of_the_chain():
    assert SensorChain(MODES).fastest == SensorChain(MODES[::-1]).fastest == 7100.0
    assert SensorChain().fastest == 0.0


@pytest.mark.parametrize(
    ("chain", "message"),
    [
        (SensorChain(MODES), r"sensor resonance = 7100\.0 Hz; allowed: from 0 to below 7000 Hz"),
        (SensorChain(mounting=Mounting(7500.0)), r"mounting cutoff = 7500\.0 Hz; allowed: from 0 to below 7000 Hz"),
    ],
)
def test_a_rate_too_low_for_a_mode_or_the_mounting_is_refused(chain, message):
    with pytest.raises(InvalidParameter, match=message):
        chain.check_rate(14000.0)


def test_a_mode_that_the_outer_ring_s_rate_holds_and_that_of_the_trace_does_not_is_refused(trace):
    """It would be gone behind the low-pass to the lower rate, as if the sensor had none."""
    lower = dataclasses.replace(trace, rate=14000.0, outer=dataclasses.replace(trace.outer, rate=42000.0))
    with pytest.raises(InvalidParameter, match=r"sensor resonance = 7100\.0 Hz; allowed: from 0 to below 7000 Hz"):
        sensed(SensorChain(MODES), lower)


def test_modes_do_not_push_back(trace, reference_scene):
    alone = simulate(reference_scene("F1", 0.05), 65536.0)
    assert np.array_equal(alone.acceleration, trace.acceleration)


def test_a_trace_without_the_outer_rings_motion_is_refused_with_the_remedy(reference_scene):
    bare = simulate(reference_scene("F0", 0.01), 65536.0)
    with pytest.raises(ValueError, match=r"keep=Kept\(outer=True\)"):
        sensed(SensorChain(MODES), bare)


def test_a_negative_gain_of_the_resonator_is_refused():
    with pytest.raises(InvalidParameter, match=r"resonator_gain = -1\.0; it must not be below 0"):
        SensorChain(resonator_gain=-1.0)


@pytest.fixture(scope="module")
def knocking(fan, build_scene):
    """A fan rig of slow modes (the resonator's below 2.6 kHz) whose balls knock on the sharp exit of an inner spall."""
    slow = dataclasses.replace(fan, resonator_stiffness=fan.resonator_stiffness / 16.0)
    spall = Spall("inner", 1, math.radians(260.0), 0.03, 40e-6, 0.01, 0.0015)
    scene = build_scene(slow, spall, operation={"load": 400.0})
    return dataclasses.replace(scene, cage=dataclasses.replace(scene.cage, duration=0.05))


def test_a_mode_near_half_the_rate_is_followed_through_sharp_knocks(knocking):
    rate, finer, mode = 25600.0, 64, SensorMode(10200.0, 0.01, 0.7)
    chain = SensorChain((mode,), resonator_gain=0.0)
    trace = simulate(knocking, rate, Accurate(1e-4), keep=Kept(outer=True, fastest_path=chain.fastest))
    fine = simulate(knocking, rate * finer, Accurate(1e-4), keep=Kept(outer=True))
    # A mass on spring and damper whose foot is moved: velocity has no jumps where the acceleration has.
    pull, drag = (2.0 * math.pi * mode.frequency) ** 2, 4.0 * math.pi * mode.damping * mode.frequency
    carried = ([[0.0, 1.0], [-pull, -drag]], [[0.0, 0.0], [pull, drag]], [[-pull, -drag]], [[pull, drag]])
    moved = fine.outer.displacement - fine.outer.displacement[0]
    foot = [np.column_stack([moved[:, axis], fine.outer.velocity[:, axis]]) for axis in range(2)]
    ringing = [lsim(carried, one, fine.time)[1] for one in foot]
    reach = 24 * finer
    taps = firwin(2 * reach + 1, 0.95 / finer, window=("kaiser", 7.85726))
    signal = np.pad(0.7 * np.column_stack(ringing), [(reach, reach), (0, 0)], mode="edge")
    expected = upfirdn(taps, signal, 1, finer, axis=0)[48:-48][: trace.time.size]
    distance = relative_error(sensed(chain, trace), expected)
    assert distance < 2e-3  # asked for; 8e-2 without a raised rate
