import math

import numpy as np
import pytest

from labels.band import components_in, holds_a_line
from labels.envelope import FALLBACK_SHARES, band_envelope, default_band, squared_envelope_spectrum
from physics import catalog

RATE = 65536.0
TIME = np.arange(32768) / RATE
BAND = (10000.0, 11000.0)


def modulated(depth=0.5, height=3.0, carrier=10500.0, modulation=40.0):
    return height * (1.0 + depth * np.cos(2.0 * np.pi * modulation * TIME)) * np.cos(2.0 * np.pi * carrier * TIME + 0.4)


def test_the_envelope_of_a_modulated_carrier_is_its_modulation():
    expected = 3.0 * (1.0 + 0.5 * np.cos(2.0 * np.pi * 40.0 * TIME))
    # All three lines lie on bins of a half-second record, so only rounding remains.
    assert np.allclose(band_envelope(modulated(), RATE, BAND), expected, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("size", [32768, 32767, 30011])
def test_the_envelope_of_a_pure_tone_is_constant_away_from_the_ends(size):
    time = np.arange(size) / RATE
    envelope = band_envelope(2.0 * np.cos(2.0 * np.pi * 10503.7 * time + 1.0), RATE, BAND)
    # The ends of the record act like a click, whose ringing has died to 1 % thirty widths (30 / 1000 Hz) away.
    middle = slice(round(0.03 * RATE), size - round(0.03 * RATE))
    assert np.allclose(envelope[middle], 2.0, rtol=0.01)


def test_what_lies_outside_the_band_does_not_touch_the_envelope():
    other = 50.0 * np.cos(2.0 * np.pi * 9998.0 * TIME) + 50.0 * np.sin(2.0 * np.pi * 11002.0 * TIME) + 7.0
    # Rounding of the much larger neighbours.
    assert np.allclose(
        band_envelope(modulated() + other, RATE, BAND), band_envelope(modulated(), RATE, BAND), atol=1e-10
    )


@pytest.mark.parametrize(("rate", "samples"), [(20_480.0, 6144), (25_600.0, 7680), (100_000.0, 30_000)])
def test_a_component_at_a_round_edge_is_kept_however_its_frequency_is_rounded(rate, samples):
    for edge in range(500, 10_000, 500):
        tone = np.cos(2.0 * np.pi * edge * np.arange(samples) / rate)
        for band in ((edge, edge + 100.0), (edge - 100.0, edge)):
            np.testing.assert_allclose(band_envelope(tone, rate, band), 1.0, atol=1e-9)
            assert holds_a_line((edge, edge + 1e-9) if band[0] == edge else (edge - 1e-9, edge), samples, rate)


def test_components_on_both_edges_of_the_band_are_kept():
    tones = np.cos(2.0 * np.pi * BAND[0] * TIME) + np.cos(2.0 * np.pi * BAND[1] * TIME)
    assert np.allclose(
        band_envelope(tones, RATE, BAND), 2.0 * np.abs(np.cos(np.pi * 1000.0 * TIME)), atol=1e-10
    )  # rounding


def test_the_envelope_moves_with_the_signal_and_grows_with_it_and_ignores_its_sign():
    generator = np.random.default_rng(5)
    signal = generator.standard_normal(TIME.size)
    envelope = band_envelope(signal, RATE, BAND)
    assert np.allclose(band_envelope(np.roll(signal, 777), RATE, BAND), np.roll(envelope, 777), atol=1e-12)  # rounding
    assert np.allclose(band_envelope(-2.5 * signal, RATE, BAND), 2.5 * envelope, atol=1e-12)  # rounding


def test_the_envelope_of_an_impulse_peaks_on_the_impulse():
    signal = np.zeros(TIME.size)
    signal[12345] = 1.0
    envelope = band_envelope(signal, RATE, BAND)
    assert int(np.argmax(envelope)) == 12345
    # Twice the share of the bins that the band keeps: 501 of 32768.
    assert envelope[12345] == pytest.approx(2.0 * 501 / 32768, rel=1e-12)


def test_the_full_band_gives_the_analytic_signal_and_counts_unpaired_components_once():
    signal = 2.0 + np.cos(np.pi * np.arange(64))
    assert np.allclose(band_envelope(signal, 64.0, (0.0, 32.0)), np.abs(signal), atol=1e-14)  # rounding


@pytest.mark.parametrize("band", [(5000.0, 5000.0), (6000.0, 5000.0), (-1.0, 5000.0), (9000.0, 40000.0)])
def test_an_impossible_band_is_refused_with_its_edges_and_the_limit(band):
    with pytest.raises(ValueError, match=f"{band[0]:g} to {band[1]:g} Hz.*32768"):
        band_envelope(TIME, RATE, band)


def test_a_band_between_two_components_is_refused():
    with pytest.raises(ValueError, match="lie 2 Hz apart"):
        band_envelope(TIME, RATE, (10000.5, 10001.5))


@pytest.mark.parametrize("size", [16, 17, 1000, 1023])
def test_a_band_that_holds_a_line_is_one_that_has_an_envelope(size):
    edges = np.random.default_rng(size).uniform(0.0, 22050.0, (300, 1))
    lines = np.fft.rfftfreq(size, 1.0 / 44100.0)[1:, None]
    widths = 44100.0 / size * np.array([[0.1, 0.5, 1.0]])
    bands = [*zip(edges[:, 0], edges[::-1, 0], strict=True), *zip(lines[:, 0], lines[:, 0] + widths[0, 0], strict=True)]
    bands += [(low, low + width) for low in edges[:, 0] for width in widths[0]]
    tried = [band for band in bands if band[0] < band[1] <= 22050.0]
    answers = {holds_a_line(band, size, 44100.0) for band in tried}
    for band in tried:
        if holds_a_line(band, size, 44100.0):
            assert band_envelope(np.ones(size), 44100.0, band).size == size
        else:
            assert band[1] - band[0] < 44100.0 / size
            with pytest.raises(ValueError, match="holds no component"):
                band_envelope(np.ones(size), 44100.0, band)
    assert answers == {True, False}
    assert not holds_a_line((0.0, 1e-3), size, 44100.0)  # the mean is no line


def test_a_band_that_begins_just_above_a_line_holds_the_next_one():
    """Of 100 000 samples lines lie 0.441 Hz apart; divided by that, the number after 13 lines is still 13."""
    above = float(np.nextafter(13.0 * 0.441, 6.0))
    assert above * 100_000 / 44100.0 == 13.0
    assert components_in((above, 14.0 * 0.441), 100_000, 44100.0) == slice(14, 15)
    assert holds_a_line((above, 14.0 * 0.441), 100_000, 44100.0)
    assert not holds_a_line((above, 13.9 * 0.441), 100_000, 44100.0)


def test_the_squared_envelope_of_a_modulated_carrier_has_two_lines_of_known_height():
    envelope = band_envelope(modulated(depth=0.5, height=3.0), RATE, BAND)
    frequency, amplitude = squared_envelope_spectrum(envelope, RATE)
    # A² (1 + m cos)² = A² (1 + m²/2 + 2m cos + m²/2 cos 2): lines of 2mA² and m²A²/2 at once and twice the modulation.
    assert amplitude[frequency == 40.0] == pytest.approx(2.0 * 0.5 * 9.0, rel=1e-10)
    assert amplitude[frequency == 80.0] == pytest.approx(0.5**2 * 9.0 / 2.0, rel=1e-10)
    quiet = (np.abs(frequency - 40.0) > 2.0) & (np.abs(frequency - 80.0) > 2.0)
    assert np.all(amplitude[quiet & (frequency > 0.0)] < 1e-9)  # rounding


def test_the_default_band_holds_the_coupled_resonator_of_both_rigs():
    # Check values: coupled resonators of 10547.9 and 9900.1 Hz, band ± 5 %.
    for name, pole in (("gearbox", 10547.9), ("fan", 9900.1)):
        low, high = default_band(catalog.rig(name), RATE)
        assert low == pytest.approx(0.95 * pole, rel=2e-4)  # x and y modes differ by up to 1.8 Hz
        assert high == pytest.approx(1.05 * pole, rel=2e-4)  # likewise


def test_a_record_too_slow_for_the_resonator_gets_the_upper_part_of_what_it_holds():
    rig = catalog.rig("gearbox")
    _, high = default_band(rig, RATE)
    assert default_band(rig, 2.0 * high * 1.001)[1] == high
    assert default_band(rig, 2.0 * high) == (FALLBACK_SHARES[0] * 2.0 * high, FALLBACK_SHARES[1] * 2.0 * high)
    assert math.isclose(default_band(rig, 12000.0)[0], 3600.0)
    assert default_band(rig, 12000.0)[1] < 6000.0


def test_an_infinite_rate_has_no_bands():
    with pytest.raises(ValueError, match="band 100 to 200 Hz"):
        band_envelope(np.arange(1000.0), np.inf, (100.0, 200.0))
