"""A stopped machine is known from a running one, whatever the gain of the recorder."""

import numpy as np
import pytest

from labels.classifier.liveness import STOPPED, TURNING_EVIDENCE, WHITE, Liveness, liveness, recorder_step
from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics

RATE = 20_000.0
TIME = np.arange(20_000) / RATE
KNOWN = bearing_kinematics(16, 71.5e-3, 8.407e-3, 0.2648, 2000.0 / 60.0)


# m/s²: about what 16 bits over a common range give.
STEP = 0.01


def found(signal, rate=RATE, known=KNOWN):
    return liveness(analyse(signal, rate, known), signal, recorder_step(signal))


def stopped():
    """Sensor noise and hum of which a recorder with a step of 0.01 m/s² shows little."""
    noise = 5e-3 * np.random.default_rng(0).standard_normal(TIME.size)
    # 240 Hz lies 1.5 % from this bearing's BPFO, 300 Hz on the ninth multiple of its shaft.
    hum = sum(0.01 / k * np.cos(2.0 * np.pi * 60.0 * k * TIME) for k in range(1, 17))
    return noise + hum


def rushing():
    """Noise of a machine without any line: 10 dB more of it in the lower half of the band than above."""
    white = np.random.default_rng(2).standard_normal(TIME.size)
    return white + np.convolve(white, np.full(4, 0.8), mode="same")


def test_sensor_noise_and_mains_hum_are_a_stopped_machine():
    assert found(stopped()).reason == STOPPED


@pytest.mark.parametrize("size", [9_500, 80_000])
def test_lines_as_wide_as_those_of_hum_are_of_no_shaft_however_long_the_record(size):
    time, generator = np.arange(size) / RATE, np.random.default_rng(1)
    hum = sum(0.1 / k * np.cos(2.0 * np.pi * 50.0 * k * time) for k in range(1, 17))
    # A shaft of 25 Hz, whose even multiples are those of the mains.
    known = bearing_kinematics(16, 71.5e-3, 8.407e-3, 0.2648, 25.0)
    assert found(5e-3 * generator.standard_normal(size) + hum, known=known).evidence < TURNING_EVIDENCE


@pytest.mark.parametrize("gain", [0.01, 0.1, 1.0, 10.0, 100.0])
def test_no_gain_makes_a_stopped_machine_run_or_a_running_one_stop(gain):
    assert found(gain * np.round(stopped() / STEP)).reason == STOPPED
    assert found(gain * rushing() * 1e-3).reason == ""
    assert found(gain * STEP * np.round(rushing() / STEP)).reason == ""


@pytest.mark.parametrize("size", [10_800, 10_799])
def test_the_velocity_of_a_tone_is_its_own_in_a_record_whose_end_is_dropped_too(size):
    # Of 10 799 samples no more than 10 368 have a fast transform.
    tone = np.cos(2.0 * np.pi * 130.0 * np.arange(size) / RATE)
    noise = 1e-6 * np.random.default_rng(3).standard_normal(size)
    expected = 1.0 / (2.0 * np.pi * 130.0) / np.sqrt(2.0)
    assert found(tone + noise).velocity == pytest.approx(expected, rel=0.01)  # leakage leans to the lower frequencies


def test_drift_and_strong_hum_do_not_make_a_stopped_machine_run():
    drift = 0.1 * TIME + 0.05 * np.sin(2.0 * np.pi * 0.3 * TIME)
    hum = 0.1 * np.sin(2.0 * np.pi * 50.0 * TIME)
    assert found(stopped() + drift).reason == STOPPED
    assert found(stopped() + hum).reason == STOPPED


def test_white_noise_has_no_colour_whatever_its_length():
    for size in (10_000, 20_000, 100_000):
        colours = [found(np.random.default_rng(seed).standard_normal(size)).colour for seed in range(20)]
        # 24 medians of 160 components scatter by 0.02 dB from draw to draw in the shortest.
        assert abs(np.mean(colours)) < 0.01
        assert max(colours) < WHITE


def test_a_quiet_shaft_that_turns_is_not_stopped():
    noise = 1e-4 * np.random.default_rng(1).standard_normal(TIME.size)
    turning = sum(2e-3 * np.cos(2.0 * np.pi * KNOWN.shaft_hz * k * TIME) for k in range(1, 7))
    assert found(noise + turning).reason == ""


@pytest.mark.parametrize("shaft_hz", [500.0, 517.0, 719.0])
def test_a_fast_shaft_that_turns_is_not_stopped(shaft_hz):
    """Of its harmonics one alone lies below 1 kHz, where 500 and 719 Hz count as multiples of the mains."""
    noise = 0.02 * np.random.default_rng(1).standard_normal(TIME.size)
    turning = sum(0.01 / k * np.cos(2.0 * np.pi * shaft_hz * k * TIME) for k in range(1, 7))
    known = bearing_kinematics(12, 30e-3, 6e-3, 0.26, shaft_hz)
    assert found(noise, known=known).reason == STOPPED
    assert found(noise + turning, known=known).reason == ""


def test_in_a_few_turns_nothing_says_that_a_machine_stands_still():
    noise = 5e-3 * np.random.default_rng(0).standard_normal(TIME.size)
    slow = bearing_kinematics(16, 71.5e-3, 8.407e-3, 0.2648, 7.0)
    assert found(noise).reason == STOPPED
    assert found(noise, known=slow).reason == ""


def test_a_machine_that_shakes_is_not_stopped_whatever_its_lines():
    noise = np.random.default_rng(2).standard_normal(TIME.size)
    assert found(noise).reason == ""


def test_the_velocity_of_a_tone_is_its_acceleration_over_its_frequency():
    signal = 0.5 * np.cos(2.0 * np.pi * 110.0 * TIME) + 1e-6 * np.random.default_rng(3).standard_normal(TIME.size)
    # RMS of 0.5 / (2π 110) m/s; the noise adds less than 1e-4 of it, its width 1e-4.
    assert abs(found(signal).velocity / (0.5 / (2.0 * np.pi * 110.0) / np.sqrt(2.0)) - 1.0) < 1e-3


def test_the_velocity_is_without_hum():
    hum = 0.5 * np.cos(2.0 * np.pi * 100.0 * TIME) + 1e-6 * np.random.default_rng(3).standard_normal(TIME.size)
    assert found(hum).velocity < 1e-6  # of 0.8 mm/s
    time = np.arange(80_000) / RATE  # components 0.25 Hz apart, and mains 0.16 % off
    hum = np.cos(2.0 * np.pi * 16.0 * 50.08 * time) + 1e-6 * np.random.default_rng(3).standard_normal(time.size)
    assert found(hum).velocity < 1e-6


def test_one_line_at_the_speed_of_the_shaft_is_no_turning_shaft_and_two_are():
    noise = 5e-3 * np.random.default_rng(0).standard_normal(TIME.size)
    one, other = (5e-3 * np.cos(2.0 * np.pi * KNOWN.shaft_hz * k * TIME) for k in (1, 2))
    assert found(noise + one).evidence < TURNING_EVIDENCE
    assert found(noise + one).reason == STOPPED
    assert found(noise + one + other).evidence > TURNING_EVIDENCE
    assert found(noise + one + other).reason == ""


def test_a_digit_is_the_smallest_step_of_the_recorder_though_it_comes_once():
    signal = 0.01 * np.round(rushing() / 0.01)
    signal[100] = 500.0
    signal = np.append(2.0 * signal, 0.01)
    assert found(signal).digits == pytest.approx(signal.std() / 0.01, rel=1e-6)  # differences of rounded values


@pytest.mark.parametrize(("order", "harmonics"), [(KNOWN.bpfo, (1, 2)), (KNOWN.bpfi, (1, 2)), (1.0, (4, 5))])
@pytest.mark.parametrize("size", [20_000, 40_000])
def test_passing_balls_and_higher_harmonics_show_a_turning_shaft_too(order, harmonics, size):
    noise, time = 5e-3 * np.random.default_rng(0).standard_normal(size), np.arange(size) / RATE
    passing = sum(5e-3 * np.cos(2.0 * np.pi * order * KNOWN.shaft_hz * k * time) for k in harmonics)
    assert found(noise + passing).evidence > TURNING_EVIDENCE


def test_of_a_shaft_six_harmonics_show_that_it_turns():
    known = bearing_kinematics(16, 71.5e-3, 8.407e-3, 0.2648, 35.0)  # 175 and 210 Hz are not of the mains
    noise = 5e-3 * np.random.default_rng(0).standard_normal(TIME.size)
    turning = sum(5e-3 * np.cos(2.0 * np.pi * 35.0 * k * TIME) for k in (5, 6))
    assert found(noise + turning, known=known).evidence > TURNING_EVIDENCE


@pytest.mark.parametrize(("velocity", "reason"), [(0.0709e-3, STOPPED), (0.0711e-3, "")])
def test_a_tenth_of_the_limit_of_zone_a_is_a_machine_that_shakes(velocity, reason):
    # ISO 10816-1, class I: 0.71 mm/s.
    assert Liveness(velocity, digits=100.0, colour=0.0, evidence=0.0, turns=100.0).reason == reason


@pytest.mark.parametrize(("frequency", "counts"), [(8.0, False), (11.0, True), (990.0, True), (1010.0, False)])
def test_the_velocity_is_that_from_10_hz_to_1_khz(frequency, counts):
    tone = np.cos(2.0 * np.pi * frequency * TIME)
    noise = 1e-6 * np.random.default_rng(3).standard_normal(TIME.size)
    share = found(tone + noise).velocity / (1.0 / (2.0 * np.pi * frequency) / np.sqrt(2.0))
    assert share > 0.9 if counts else share < 0.01


@pytest.mark.parametrize(("digits", "reason"), [(1.5, STOPPED), (3.0, "")])
def test_white_noise_of_fewer_than_two_digits_is_the_recorders(digits, reason):
    # As velocity it is far from still: 0.5 mm/s for a standard deviation of 1 m/s².
    noise = np.round(digits * np.random.default_rng(4).standard_normal(TIME.size))
    assert found(noise).reason == reason


@pytest.mark.parametrize(("turns", "reason"), [(14.0, ""), (16.0, STOPPED)])
def test_fifteen_turns_without_a_line_are_enough(turns, reason):
    known = bearing_kinematics(16, 71.5e-3, 8.407e-3, 0.2648, 2.0 * turns)  # in half a second
    assert found(5e-3 * np.random.default_rng(0).standard_normal(TIME.size // 2), known=known).reason == reason


def test_a_twenty_fourth_of_the_band_that_is_louder_colours_the_floor():
    spectrum = np.fft.rfft(np.random.default_rng(5).standard_normal(TIME.size))
    first, last = (int(9_500 * (0.1 + 0.7 * k / 24)) for k in (12, 13))
    spectrum[first:last] *= 10.0
    # One of 24 levels is a hundredfold: the logarithm of their mean less the mean of their logarithms.
    expected = 10.0 * np.log10((23.0 + 100.0) / 24.0) - 20.0 / 24.0
    assert found(np.fft.irfft(spectrum, TIME.size)).colour == pytest.approx(expected, abs=0.3)


def test_a_floor_that_is_nothing_at_all_has_a_finite_colour():
    assert np.isfinite(found(np.tile([1.0, -1.0], 8192)).colour)


def test_what_a_recorder_does_not_let_through_is_no_colour():
    spectrum = np.fft.rfft(np.random.default_rng(5).standard_normal(TIME.size))
    spectrum[:700], spectrum[8000:] = 0.0, 0.0  # of 9500 components that are looked at
    assert abs(found(np.fft.irfft(spectrum, TIME.size)).colour) < WHITE


SILENT = {"velocity": 1.0, "digits": 1.99, "colour": 0.0499, "evidence": 29.9, "turns": 15.0}


@pytest.mark.parametrize(
    ("more", "reason"),
    [({}, STOPPED), ({"digits": 2.0}, ""), ({"colour": 0.05}, ""), ({"evidence": 30.0}, ""), ({"turns": 14.9}, "")],
)
def test_each_sign_of_a_running_machine_is_enough_from_its_stated_limit_on(more, reason):
    assert Liveness(**SILENT | more).reason == reason
