"""The shape of a waveform, against closed forms of the normal distribution."""

import math
from dataclasses import replace

import numpy as np
import pytest

from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics
from labels.features.waveform import measure

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)


def test_the_shape_of_noise_is_that_of_a_normal_distribution():
    noise = np.random.default_rng(0).standard_normal(400_000)
    found = measure(analyse(noise, 20_000.0, KNOWN))
    mean = math.sqrt(2.0 / math.pi)  # of the size of a standard normal variable
    assert found["kurtosis"] == pytest.approx(math.log(3.0), abs=0.01)
    assert found["shape_factor"] == pytest.approx(-math.log(mean), abs=0.005)
    # Quantiles of the size at 99.9 and 99.99 %; the latter follows from the 40 largest samples.
    assert found["impulse_factor"] == pytest.approx(math.log(3.2905 / mean), abs=0.02)
    assert found["crest_factor"] == pytest.approx(math.log(3.8906), abs=0.04)


def test_a_sensor_that_drifts_hides_no_impulse():
    rate, size = 20_000.0, 200_000
    impulsive = np.random.default_rng(2).standard_normal(size)
    impulsive[::400] += 5.0
    drift = 30.0 * np.sin(2.0 * np.pi * 0.7 * np.arange(size) / rate)
    steady, drifting = (measure(analyse(signal, rate, KNOWN)) for signal in (impulsive, impulsive + drift))
    assert math.log(4.0) < steady["kurtosis"] < math.log(5.0)  # beyond which it is cut
    for name in ("kurtosis", "crest_factor", "shape_factor", "impulse_factor"):
        assert drifting[name] == pytest.approx(steady[name], abs=0.01)


def test_shocks_count_up_to_a_kurtosis_of_five():
    """Impulses of height h at a share p of the samples have a kurtosis near 1 / p where they rule the signal."""
    crackle = np.random.default_rng(3).standard_normal(100_000)
    crackle[np.random.default_rng(4).choice(100_000, 300, replace=False)] += 60.0
    assert measure(analyse(crackle, 20_000.0, KNOWN))["kurtosis"] == pytest.approx(math.log(5.0), rel=1e-12)


def test_the_kurtosis_of_the_most_impulsive_band_is_told_whatever_the_others_are():
    # Bursts for a fifth of the time, in one of 15 bands: the kurtosis of its complex signal is 2 / 0.2 - 2.
    size = 100_000
    noise, other = np.random.default_rng(1).standard_normal((2, size))
    bursts = np.fft.rfft(np.where(np.arange(size) % 5000 < 1000, other, 0.0))
    spectrum = np.fft.rfft(noise)
    edge = int(0.875 * 0.95 * spectrum.size)  # features see 0.95 of half the rate
    spectrum[edge:] = bursts[edge:]
    found = measure(analyse(np.fft.irfft(spectrum, size), 20_000.0, KNOWN))
    assert found["band_kurtosis"] == pytest.approx(math.log(1.0 + 8.0), abs=0.15)
    assert found["median_band_kurtosis"] < 0.2


def test_skewness_is_told_whatever_its_side_up_to_five():
    smooth = np.convolve(np.random.default_rng(5).exponential(size=400_000), np.full(8, 0.125), mode="valid")
    for side in (1.0, -1.0):
        # That of an exponential is 2, of the mean of eight 2/√8.
        assert measure(analyse(side * smooth, 20_000.0, KNOWN))["skewness"] == pytest.approx(2.0 / 8.0**0.5, abs=0.03)
    rare = np.where(np.arange(100_000) % 1000 == 500, 100.0, 0.0) + smooth[:100_000]
    assert measure(analyse(rare, 20_000.0, KNOWN))["skewness"] == 5.0


def test_bands_less_impulsive_than_noise_count_as_noise():
    found = analyse(np.random.default_rng(6).standard_normal(20_000), 20_000.0, KNOWN)
    vars(found)["envelopes"] = replace(found.envelopes, kurtosis=np.array([-1.0, 0.5, -0.2]))
    told = measure(found)
    assert (told["band_kurtosis"], told["median_band_kurtosis"]) == pytest.approx((math.log(1.5), 0.0))


def test_impulses_below_a_loud_resonance_show_where_the_spectrum_is_flattened():
    noise, size = np.random.default_rng(7).standard_normal(100_000), 100_000
    spectrum = np.fft.rfft(np.random.default_rng(8).standard_normal(size))
    spectrum[:20_000], spectrum[25_000:] = 0.0, 0.0
    impulsive = noise + 12.0 * (np.random.default_rng(9).random(size) < 0.002)
    found = measure(analyse(impulsive + 30.0 * np.fft.irfft(spectrum, size), 20_000.0, KNOWN))
    assert found["kurtosis"] == pytest.approx(math.log(3.0), abs=0.05)
    # Impulses of height h at a share p have (3 + 6 p h² + p h⁴) / (1 + p h²)² = 28; less of the band makes it less.
    assert found["flat_kurtosis"] > math.log(10.0)


def test_what_lies_just_below_half_a_turn_is_drift():
    time = np.arange(20_000) / 20_000.0
    noise = np.random.default_rng(9).standard_normal(time.size)
    found = measure(analyse(noise + 30.0 * np.cos(2.0 * np.pi * 12.0 * time), 20_000.0, KNOWN))
    assert found["kurtosis"] == pytest.approx(math.log(3.0), abs=0.1)  # a tone has ln 1.5
