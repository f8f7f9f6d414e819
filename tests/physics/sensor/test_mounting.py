import math

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

from physics.checks import InvalidParameter
from physics.sensor.mounting import Mounting, mounted

RATE = 65536.0


def gain(mounting, frequency):
    """Amplitude of a steady tone after the mounting over that before."""
    time = np.arange(16384) / RATE
    tone = np.column_stack([np.cos(2.0 * np.pi * frequency * time)] * 2)
    # Averaged over whole periods of 1/16 s, long after the start.
    return float(np.sqrt(2.0 * np.mean(mounted(mounting, tone, RATE)[-4096:] ** 2)))


@pytest.mark.parametrize("order", [1, 2, 6])
def test_half_the_power_passes_at_the_cutoff_whatever_the_order(order):
    assert gain(Mounting(11008.0, order), 11008.0) == pytest.approx(math.sqrt(0.5), rel=1e-9)


@pytest.mark.parametrize("frequency", [1600.0, 8000.0, 16000.0, 24000.0])
def test_the_fan_rigs_mounting_passes_what_an_analogue_butterworth_of_order_6_passes(frequency):
    # The bilinear transform maps f to tan(pi f / rate).
    ratio = math.tan(math.pi * frequency / RATE) / math.tan(math.pi * 11000.0 / RATE)
    expected = 1.0 / math.sqrt(1.0 + ratio**12)
    assert gain(Mounting(11000.0), frequency) == pytest.approx(expected, rel=1e-6)


def test_a_mounting_of_the_first_order_falls_by_six_decibels_an_octave():
    ratio = math.tan(math.pi * 24000.0 / RATE) / math.tan(math.pi * 4000.0 / RATE)
    assert gain(Mounting(4000.0, 1), 24000.0) == pytest.approx(1.0 / math.sqrt(1.0 + ratio**2), rel=1e-6)


def test_the_mounting_is_causal_and_delays_low_frequencies_by_51_microseconds():
    step = np.zeros((4096, 2))
    step[1000:] = 1.0
    out = mounted(Mounting(11000.0), step, RATE)
    assert not out[:1000].any()
    delay = np.sum(step - out, axis=0) / RATE  # the delay at 0 Hz is the area between the two
    assert delay == pytest.approx(51e-6, abs=0.5e-6)  # as printed


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Mounting(0.0), r"mounting cutoff = 0\.0 Hz; it must be above 0"),
        (lambda: Mounting(100.0, 0), "mounting order = 0; allowed: whole numbers 1 to 12"),
        (lambda: Mounting(100.0, 13), "mounting order = 13; allowed: whole numbers 1 to 12"),
        (
            lambda: mounted(Mounting(500.0), np.zeros((4, 2)), 1000.0),
            r"mounting cutoff = 500\.0 Hz; allowed: from 0 to below 500 Hz",
        ),
    ],
)
def test_an_impossible_mounting_is_refused_with_its_number(make, message):
    with pytest.raises(InvalidParameter, match=message):
        make()


@pytest.mark.parametrize("order", range(1, 13))
def test_every_order_filters_as_scipys_butterworth_does(order):
    signal = np.random.default_rng(order).standard_normal((4000, 2))
    expected = sosfilt(butter(order, 9000.0, fs=RATE, output="sos"), signal, axis=0)
    assert mounted(Mounting(9000.0, order), signal, RATE) == pytest.approx(expected, rel=1e-9, abs=1e-9)
