import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import lsim

from physics.checks import InvalidParameter
from physics.rms import relative_error, rms
from physics.sensor.mode import SensorMode, mode_accelerations
from physics.simulate import simulate
from physics.trace import Kept, OuterMotion

RATE = 65536.0


def harmonic_motion(frequency, rate, samples):
    """Motion (T, 2) of a ring that starts to shake smoothly from rest."""
    time = np.arange(samples) / rate
    omega, ramp = 2.0 * math.pi * frequency, 1.0 / 0.05
    rise = 1.0 - np.exp(-((ramp * time) ** 4))
    first = 4.0 * ramp**4 * time**3 * np.exp(-((ramp * time) ** 4))
    second = (12.0 * ramp**4 * time**2 - 16.0 * ramp**8 * time**6) * np.exp(-((ramp * time) ** 4))
    sine, cosine = np.sin(omega * time), np.cos(omega * time)
    x = rise * sine
    v = first * sine + omega * rise * cosine
    a = second * sine + 2.0 * omega * first * cosine - omega**2 * rise * sine
    return OuterMotion(rate, *(np.column_stack([part, 2.0 * part]) for part in (x, v, a)))


@pytest.mark.parametrize("driven", [100.0, 3000.0, 9000.0, 20000.0])
def test_a_steady_shaking_comes_out_with_the_transmissibility_of_a_seismic_mass(driven):
    mode = SensorMode(8000.0, 0.05, 0.7)
    motion = harmonic_motion(driven, RATE, 8192)
    given, got = motion.acceleration[-2048:], mode_accelerations([mode], motion)[-2048:]
    ratio = driven / mode.frequency
    expected = 0.7 * math.sqrt((1.0 + (0.1 * ratio) ** 2) / ((1.0 - ratio**2) ** 2 + (0.1 * ratio) ** 2))
    # The quintic between samples misses the sine by (2 pi f / rate)^6 / 46080 of it: 1.1e-3 at 20 kHz, far less below.
    assert rms(got) / rms(given) == pytest.approx(expected, rel=2e-3)
    assert got[:, 1] == pytest.approx(2.0 * got[:, 0], rel=1e-9)  # both axes alike, linear


def test_a_step_of_acceleration_rings_at_the_damped_frequency_from_rest():
    mode, time = SensorMode(1000.0, 0.02), np.arange(400) / RATE
    step = np.ones((400, 2))
    moved = OuterMotion(RATE, 0.5 * step * time[:, None] ** 2, step * time[:, None], step)
    got = mode_accelerations([mode], moved)
    omega, damped = 2000.0 * math.pi, 2000.0 * math.pi * math.sqrt(1.0 - 0.02**2)
    decay = np.exp(-0.02 * omega * time)
    expected = 1.0 - decay * (np.cos(damped * time) - 0.02 / math.sqrt(1.0 - 0.02**2) * np.sin(damped * time))
    assert got[:, 0] == pytest.approx(expected, abs=1e-9)  # a quadratic motion is met exactly, up to rounding


def test_a_mode_of_a_spall_at_one_step_a_sample_agrees_with_an_adaptive_solver_on_a_finer_run(reference_scene):
    scene = reference_scene("G1", 0.03)
    fine, coarse = (simulate(scene, rate, keep=Kept(outer=True)) for rate in (16.0 * RATE, RATE))
    mode = SensorMode(6000.0, 0.03)
    omega = 2.0 * math.pi * mode.frequency

    def slope(time, state):
        push = np.interp(time, fine.time, fine.outer.acceleration[:, 1])
        return [state[1], -(omega**2) * state[0] - 2.0 * mode.damping * omega * state[1] - push]

    solved = solve_ivp(
        slope, (0.0, coarse.time[-1]), [0.0, 0.0], t_eval=coarse.time, max_step=2.0 / fine.rate, rtol=1e-6, atol=1e-16
    )
    expected = -(omega**2) * solved.y[0] - 2.0 * mode.damping * omega * solved.y[1]
    error = relative_error(mode_accelerations([mode], coarse.outer)[:, 1], expected)
    held = ([2.0 * mode.damping * omega, omega**2], [1.0, 2.0 * mode.damping * omega, omega**2])
    first_order = relative_error(lsim(held, coarse.outer.acceleration[:, 1], coarse.time)[1], expected)
    assert error < 2e-3  # straight lines between the finer run's samples leave 6e-4
    assert first_order > 5.0 * error  # what a first-order hold on the acceleration alone would lose


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ((0.0, 0.1), r"sensor resonance = 0\.0 Hz; it must be above 0"),
        ((-5.0, 0.1), r"sensor resonance = -5\.0 Hz"),
        ((100.0, 0.0), r"sensor damping = 0\.0; allowed: above 0, up to 0\.7"),
        ((100.0, 0.71), r"sensor damping = 0\.71; allowed: above 0, up to 0\.7"),
        ((100.0, 0.1, math.nan), "gain = nan; it must be finite"),
    ],
)
def test_an_impossible_mode_is_refused_with_its_number(fields, message):
    with pytest.raises(InvalidParameter, match=message):
        SensorMode(*fields)


def test_a_resonance_at_half_the_rate_is_refused():
    still = np.zeros((8, 2))
    with pytest.raises(InvalidParameter, match=r"sensor resonance = 500\.0 Hz; allowed: from 0 to below 500 Hz"):
        mode_accelerations([SensorMode(500.0, 0.1)], OuterMotion(1000.0, still, still, still))
