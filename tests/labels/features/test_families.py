"""Evidence of line families, against closed forms."""

import math

import numpy as np
import pytest

from labels.features.conditioning import condition, local_mean_power
from labels.features.envelopes import envelope_spectra
from labels.features.families import evidence, find_family, harmonic_evidence
from labels.features.known_lines import mains_components, near_multiples, without_shaft
from labels.features.lines import Lines, lines_in
from labels.features.modulation import line_strength


def test_evidence_is_the_log_likelihood_ratio_of_exponential_components():
    values = np.array([3.0, 5.0, 4.0])
    mean = values.mean()
    # Density exp(−x/m)/m: the sum of ln(p(x | m = mean) / p(x | m = 1)).
    ratio = sum(-x / mean - math.log(mean) + x for x in values)
    assert evidence(np.array(mean), 3.0) == pytest.approx(ratio, rel=1e-12)


def test_a_mean_at_the_floor_or_below_is_no_evidence():
    assert evidence(np.array([0.2, 1.0]), 5.0).tolist() == [0.0, 0.0]


def test_the_line_of_amplitude_modulated_noise_stands_as_high_as_computed():
    """Noise n(t) sqrt(1 + m cos wt): its squared envelope has a line m/2 · mean and a floor of known density."""
    rate, size, depth, frequency = 20_000.0, 200_000, 0.3, 80.0
    generator = np.random.default_rng(4)
    time = np.arange(size) / rate
    noise = generator.standard_normal(size) * np.sqrt(1.0 + depth * np.cos(2.0 * np.pi * frequency * time))
    record = condition(noise, rate)
    spectra = envelope_spectra(record, 25.0, 300.0, 600.0)
    place = round(frequency / spectra.step)
    # Hann: a line on a component keeps its height, the floor of squared Gaussian noise of bandwidth B over time T has a
    # mean power of 6 mean² / (B T) near 0 Hz: (2/N)² · N · mean², times 3/2 for the window.
    components = record.bandwidth * record.duration
    expected = depth**2 / (6.0 / components * (1.0 - frequency / record.bandwidth))
    # The line scatters by twice the root of the floor over it, 4 %; the median of the floor by 15 %.
    assert spectra.excess[0, place] == pytest.approx(expected, rel=0.35)
    assert spectra.depth[0, place] == pytest.approx(depth, rel=0.1)


def test_means_are_those_of_the_components_that_a_stretch_covers():
    excess = np.random.default_rng(3).exponential(size=(4, 60))
    found = lines_in(excess, 0.5).means(np.array([[5.0, 28.0, 29.8], [6.1, 0.0, 29.8]]), np.array([0.75, 0.2]))
    assert found.shape == (2, 4, 3)
    # 5 ± 0.75 are components 9 to 11, 28 ± 0.75 are 55 to 57; beyond the middle of the last but one nothing is read.
    covered = np.stack([excess[:, 9:12].mean(axis=1), excess[:, 55:58].mean(axis=1), np.zeros(4)], axis=1)
    assert found[0] == pytest.approx(covered)
    # 6.1 ± 0.2 is 0.35 of component 12, which covers 5.75 to 6.25, and 0.05 of component 13; 0 ± 0.2 lies in one.
    assert found[1, :, 0] == pytest.approx((0.35 * excess[:, 12] + 0.05 * excess[:, 13]) / 0.4)
    assert found[1, :, 2] == pytest.approx(np.zeros(4))


def test_nothing_is_read_at_places_that_are_no_numbers_or_lie_outside():
    lines = lines_in(np.ones((2, 60)), 0.5)
    places = np.array([[np.nan, np.inf, 1e300, 10.0]])
    assert lines.means(places, np.array([0.75]))[0] == pytest.approx(np.array([[0.0, 0.0, 0.0, 1.0]] * 2))
    assert np.all(lines.means(np.array([[-np.inf, -1e300]]), np.array([0.75])) == 0.0)
    assert np.all(lines.means(places, np.array([np.nan])) == 0.0)


def test_a_family_is_found_where_it_is_and_not_elsewhere():
    excess = np.random.default_rng(5).exponential(1.0, (1, 4000))
    step, fundamental = 0.1, 71.3
    for k in (1, 2, 3, 4):
        excess[0, round(k * fundamental / step)] = 60.0
    lines = lines_in(excess, step)
    found = find_family(lines, 70.5, 0.025, 20.0)
    assert found.fundamental[0] == pytest.approx(fundamental, abs=step)
    assert found.evidence[0] > 100.0  # four lines of 60 give 4 · (60 − 1 − ln 60) = 220 less the search's price
    assert find_family(lines, 60.0, 0.025, 20.0).evidence[0] < 10.0


def test_noise_alone_is_hardly_ever_evidence_whatever_the_length_of_the_record():
    for count in (400, 4000, 20_000):
        excess = np.random.default_rng(count).exponential(1.0, (20, count))
        found = find_family(lines_in(excess, 400.0 / count), 70.0, 0.025, 20.0)
        assert np.median(found.evidence) < 6.0  # a search that was not paid for would give 10 to 20 nats


def test_lines_of_the_shaft_do_not_count_for_a_family():
    excess = np.ones((1, 4000))
    excess[0, 700] = excess[0, 1400] = 500.0
    kept = without_shaft(excess, 0.1, 10.0)
    assert kept.max() == 1.0
    assert without_shaft(excess, 0.1, 10.7).max() == 500.0


def test_nothing_is_taken_off_for_the_shaft_in_a_record_of_a_few_turns():
    excess = np.full((1, 400), 500.0)
    assert without_shaft(excess, 1.25, 10.0).min() == 500.0  # eight turns: an eighth of an order between components
    assert without_shaft(excess, 1.0, 10.0).min() == 1.0


def test_what_lies_near_a_multiple_is_taken_for_it_and_what_lies_near_zero_is_not():
    taken = np.flatnonzero(near_multiples(50, 0.1, 2.0, 0.25))
    assert taken.tolist() == [18, 19, 20, 21, 22, 38, 39, 40, 41, 42]


def test_lines_of_the_mains_do_not_count_but_those_beside_them_do():
    mains = mains_components(4000, 0.05)
    assert (mains[2400], mains[2500]) == (True, False)  # 120 and 125 Hz
    assert not mains_components(4000, 2.5).any()


@pytest.mark.parametrize("rate_error", [-0.004, -0.001, 0.001, 0.004])
def test_lines_of_the_mains_do_not_count_where_a_stated_rate_is_a_little_off(rate_error):
    at = np.round(np.array([100.0, 120.0]) * (1.0 + rate_error) / 0.05).astype(int)
    assert mains_components(40_000, 0.05)[at].all()


def test_a_line_of_the_mains_takes_its_neighbours_and_0_hz_is_none():
    # 1 Hz apart: 1.01 Hz to both sides, and 0.6 % of the frequency or 0.8 Hz.
    places = np.flatnonzero(mains_components(195, 1.0)).tolist()
    assert places == [line + beside for line in (50, 60, 100, 120, 150, 180) for beside in (-1, 0, 1)]


def test_high_multiples_of_the_mains_may_be_off_by_a_thousandth():
    mains = mains_components(70_000, 0.05)
    # 3000 Hz is a multiple of both; 2.7 Hz are 0.09 % of it, 3.5 Hz 0.12 %.
    assert mains[round(3002.7 / 0.05)]
    assert not mains[round(3003.5 / 0.05)]


def test_high_multiples_of_the_mains_cover_no_more_of_the_axis_than_low_ones_by_far():
    left = ~mains_components(40_000, 0.05)
    # Multiples of 50 and of 60 Hz, 0.85 Hz to both sides, are 6 % of the axis; 0.1 % of 2 kHz makes that 11 %.
    assert left[10_000:16_000].mean() == pytest.approx(0.94, abs=0.01)
    assert left[32_000:].mean() > 0.87


def test_a_band_so_silent_that_its_running_sum_falls_by_rounding_has_lines_of_no_strength():
    falling = Lines(1e6 - 1e-10 * np.arange(2001.0)[None, :], 0.5)
    assert line_strength(falling, 100.0, 0.02) == 0.0


def test_a_band_says_nothing_of_frequencies_that_it_is_too_narrow_to_hold():
    record = condition(np.random.default_rng(6).standard_normal(40_000), 20_000.0)
    spectra = envelope_spectra(record, 25.0, 4000.0, 600.0)
    frequency = np.arange(spectra.excess.shape[1]) * spectra.step
    for (low, high), excess in zip(spectra.edges, spectra.excess, strict=True):
        width = (high - low) * record.bandwidth
        assert (excess[frequency > 0.85 * width] == 1.0).all()
        assert excess[frequency < 0.8 * width].std() > 0.5  # that of noise is 1
    assert spectra.edges[-1].tolist() == [0.875, 1.0]  # an eighth of 9.5 kHz, far below 4 kHz


def test_a_higher_harmonic_is_looked_for_over_as_many_times_the_width():
    excess = np.ones((1, 4000))
    for k in (1, 2, 3):
        excess[0, 700 * k - 10 * k : 700 * k + 10 * k + 1] = 9.0  # 70 Hz ± 1 Hz, 140 Hz ± 2 Hz, 210 Hz ± 3 Hz
    found = harmonic_evidence(lines_in(excess, 0.1), np.array([70.0]), 20.0, 0.1, 3)[:, 0, 0]
    # k · 20 components of a mean of 9, of which a Hann window leaves one in 1.5 independent.
    assert found == pytest.approx(20.0 / 1.5 * (8.0 - np.log(9.0)) * np.array([1.0, 2.0, 3.0]), rel=1e-6)


def test_the_kurtosis_of_a_band_is_that_of_its_complex_signal_over_the_noises():
    generator, size = np.random.default_rng(8), 40_000
    steady = generator.standard_normal(size)
    # On for a fifth of the time: ⟨|z|⁴⟩ / ⟨|z|²⟩² is 2 / 0.2 where noise has 2.
    bursts = np.where(np.arange(size) % 5000 < 1000, steady, 0.0) + 1e-3 * generator.standard_normal(size)
    for signal, kurtosis in ((steady, 0.0), (bursts, 8.0)):
        spectra = envelope_spectra(condition(signal, 20_000.0), 25.0, 300.0, 600.0)
        assert spectra.kurtosis[0] == pytest.approx(kurtosis, abs=0.1)  # of 8000 to 40 000 samples


def test_the_floor_under_a_slope_is_the_slope():
    power = np.exp(-np.arange(4000) / 400.0)
    # A block's median of e^(-x) is its middle's value, over ln 2; the axis ends half a block beyond the first and last.
    assert local_mean_power(power, 100)[50:3950] == pytest.approx(power[50:3950] / np.log(2.0), rel=0.01)
