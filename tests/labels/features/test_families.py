"""Evidence of line families, against closed forms."""

import math

import numpy as np
import pytest

from labels.features.conditioning import condition, local_mean_power
from labels.features.envelopes import envelope_spectra
from labels.features.families import evidence, find_family, harmonic_evidence, sideband_evidence, tempered
from labels.features.kinematics import Kinematics
from labels.features.known_lines import mains_components, near_multiples, races_in_mains, without_shaft
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


def family_of(height, spread, step=0.1, fundamental=70.0, count=4):
    """A floor of 1 and lines of that `height` at multiples of the `fundamental` (Hz), `spread` (Hz) wide for each."""
    excess = np.ones((1, 4000))
    for k in range(1, count + 1):
        middle, half = round(k * fundamental / step), round(k * spread / step)
        excess[0, middle - half : middle + half + 1] = height
    return lines_in(excess, step)


def test_a_family_pays_for_the_places_that_were_searched():
    # A line is read over 1.5 components, one independent one: a mean of (60 + 0.5) / 1.5.
    mean = 60.5 / 1.5
    # 5 % of 70 Hz at the fourth harmonic are 140 components.
    expected = 4.0 * (mean - 1.0 - math.log(mean)) - math.log(140.0)
    found = find_family(family_of(60.0, 0.0), 70.0, 0.025, 20.0)
    assert found.evidence[0] == pytest.approx(expected, rel=1e-9)
    assert found.parts[0] == pytest.approx(np.full(4, mean - 1.0 - math.log(mean)), rel=1e-9)


def test_wide_lines_pay_for_as_many_places_as_they_are_wide():
    # Harmonic k is 1.2 k Hz wide, 0.06 orders of 20 Hz each: 8 k independent components of a mean of 9.
    expected = 8.0 * 10.0 * (8.0 - math.log(9.0)) - math.log(14.0 / 1.2)
    found = find_family(family_of(9.0, 0.6), 70.0, 0.025, 20.0)
    assert found.evidence[0] == pytest.approx(expected, rel=1e-9)
    assert found.parts[0] == pytest.approx(8.0 * (8.0 - math.log(9.0)) * np.arange(1.0, 5.0), rel=1e-9)


def test_a_fundamental_away_from_its_place_pays_for_the_slip_that_it_takes():
    lines = family_of(60.0, 0.0, fundamental=71.05)  # 1.5 % above
    free, slipping = (find_family(lines, 70.0, 0.025, 20.0, prior).evidence[0] for prior in (math.inf, 0.01))
    assert free - slipping == pytest.approx(0.5 * 1.5**2, rel=1e-9)


@pytest.mark.parametrize("beside", [0.025, 0.05, 0.075])
def test_no_harmonic_slips_through_between_the_places_that_are_searched(beside):
    """A component of the fourth harmonic is a quarter of one of the first."""
    found = find_family(family_of(60.0, 0.0, fundamental=70.0 + beside), 70.0, 0.025, 20.0)
    assert found.fundamental[0] == pytest.approx(70.0 + beside, abs=0.026)
    assert found.parts[0, 3] > 20.0


def test_a_floor_is_no_family_however_few_places_are_searched():
    floor = lines_in(np.ones((2, 4000)), 0.01)
    for centre in (4.0, 8.0):  # the widest lines have less than one place there, and more than one
        assert find_family(floor, centre, 0.025, 20.0).evidence == pytest.approx(np.zeros(2), abs=1e-20)


def test_each_band_has_its_own_family():
    one, other = family_of(60.0, 0.0, fundamental=69.5), family_of(9.0, 0.6, fundamental=70.5)
    both = find_family(Lines(np.concatenate([one.cumulated, other.cumulated]), 0.1), 70.0, 0.025, 20.0)
    for band, lines in enumerate((one, other)):
        alone = find_family(lines, 70.0, 0.025, 20.0)
        assert both.evidence[band] == alone.evidence[0]
        assert both.fundamental[band] == alone.fundamental[0] == pytest.approx((69.5, 70.5)[band], abs=0.1)
        assert both.parts[band].tolist() == alone.parts[0].tolist()


def test_strong_lines_count_by_their_logarithm_and_weak_ones_as_they_are():
    # 12 ln(1 + n / 12): the twelve nats of the knee are 12 ln 2, and 12 (e - 1) are 12.
    found = tempered(np.array([0.0, 0.012, 12.0, 12.0 * (math.e - 1.0)]))
    assert found == pytest.approx(np.array([0.0, 0.012, 12.0 * math.log(2.0), 12.0]), rel=1e-3)


def test_sidebands_are_looked_for_beside_two_harmonics_of_each_bands_own_fundamental():
    """Bands at 70 and 75 Hz with sidebands 20 Hz beside, and one without."""
    excess = np.ones((3, 4000))
    for band, fundamental in ((0, 70.0), (1, 75.0)):
        for k, side in ((1, -1.0), (1, 1.0), (2, -1.0), (2, 1.0)):
            excess[band, round((k * fundamental + side * 20.0) / 0.1)] = 61.0
    found = sideband_evidence(lines_in(excess, 0.1), np.array([70.0, 75.0, 72.0]), 20.0, 20.0)
    # 0.02 orders of 20 Hz to both sides: eight components, 8 / 1.5 of them independent.
    mean = 1.0 + 60.0 / 8.0
    assert found[:2] == pytest.approx(np.full(2, 4.0 * 8.0 / 1.5 * (mean - 1.0 - math.log(mean))), rel=1e-9)
    assert found[2] == pytest.approx(0.0, abs=1e-20)
    swapped = sideband_evidence(lines_in(excess, 0.1), np.array([75.0, 70.0, 72.0]), 20.0, 20.0)
    assert swapped == pytest.approx(np.zeros(3), abs=1e-20)


def test_sidebands_of_a_short_record_are_read_as_single_lines():
    excess = np.ones((1, 400))
    excess[0, [50, 90, 120, 160]] = 61.0
    mean = (61.0 + 0.5) / 1.5
    found = sideband_evidence(lines_in(excess, 1.0), np.array([70.0]), 20.0, 20.0)
    assert found[0] == pytest.approx(4.0 * (mean - 1.0 - math.log(mean)), rel=1e-9)


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


@pytest.mark.parametrize(
    ("bpfo_hz", "hidden"), [(100.5, ("outer",)), (101.0, ("outer",)), (101.7, ()), (99.0, ("outer",))]
)
def test_a_race_lies_in_the_mains_as_far_as_slip_and_the_mains_itself_move_both(bpfo_hz, hidden):
    # Near 100 Hz the cage's speed scatters by 0.7 Hz, mains and stated rate are off by 0.6 Hz, a component is 0.1 Hz.
    # Eight balls of a quarter of the pitch diameter pass the outer race 3 times a turn and the inner one 5 times.
    assert races_in_mains(Kinematics(8, 0.25, 1.9, bpfo_hz / 3.0), 0.1) == hidden
