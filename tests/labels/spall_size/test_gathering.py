"""The signal processing on pulse trains of known lag through a known resonator."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from labels.spall_size.columns.event_shapes import event_shapes
from labels.spall_size.columns.table import PAIR_COLUMNS
from labels.spall_size.estimation.gathering import gather_evidence, hear, peakedness, predictability
from labels.spall_size.events.candidates import candidate_places
from labels.spall_size.signal.alignment import Alignment, aligned
from labels.spall_size.signal.mean_pass import Channel, MeanPass, mean_pass
from labels.spall_size.signal.noise_floor import log_noise_share
from labels.spall_size.signal.pass_track import CELLS, PassTrack, track_passes
from labels.spall_size.signal.prewhitening import prewhitened
from labels.spall_size.signal.running_energy import RunningEnergy

RATE = 65536.0
PERIOD = 0.011
LAG = 60.0 / RATE


def offset_from(found, true):
    """Distance (s) of each found time from the nearest true one."""
    return found - true[np.abs(true[None, :] - found[:, None]).argmin(axis=1)]


def test_prewhitening_takes_the_ringing_away_and_leaves_the_pulses():
    pulses = np.zeros(20000)
    places = np.arange(500, 19500, 900)
    pulses[places] = np.resize([1.0, -1.0], places.size)  # so that the mean, which is taken off, is nothing
    signal = lfilter([1.0], [1.0, -1.6, 0.95], pulses)
    # The resonator is a predictor of two terms, so all that is left of the ringing is rounding.
    residual = np.abs(prewhitened(signal + 1e-9 * np.random.default_rng(0).standard_normal(20000)).residual)
    quiet = np.delete(residual, places)
    assert residual[places].min() > 1e3 * np.percentile(quiet, 99.0)
    assert residual[places].min() > 10.0 * quiet.max()  # what is left near a pulse, where weights are small


@pytest.mark.parametrize("wrong", [0.97, 1.0, 1.03])
def test_passes_of_a_slipping_cage_are_tracked_though_the_stated_period_is_wrong(pulse_train, wrong):
    train = pulse_train(LAG, PERIOD)
    track = track_passes(prewhitened(train.signal).residual ** 2, RATE, PERIOD * wrong)
    assert track is not None
    assert track.period == pytest.approx(np.diff(train.entry).mean(), rel=2e-3)  # 90 steps of 0.9 % scatter
    away = offset_from(track.time, train.entry)
    # All at one phase of the pass: a cell of the tracker is 0.4 % of a period.
    assert np.percentile(np.abs(away - np.median(away)), 90) < 0.006 * PERIOD


def test_a_record_that_begins_while_it_rings_shows_no_event_there():
    pulses = np.zeros(20000)
    pulses[100:19000:900] = np.resize([1.0, -1.0], 21)
    signal = lfilter([1.0], [1.0, -1.6, 0.95], pulses)[110:]  # begins ten samples after a pulse
    residual = np.abs(prewhitened(signal + 1e-9 * np.random.default_rng(0).standard_normal(signal.size)).residual)
    assert residual[:100].max() < 0.1 * residual[890]


@pytest.fixture(scope="module")
def rough_passes():
    """The energy of 20 passes of 1280 samples, five to each cell of the tracker: log energies of chance in a pass, the
    highest in cell 77, and an eighth of a pass before the first."""
    level = np.random.default_rng(3).standard_normal(CELLS)
    level[77] = 4.0
    return np.concatenate([np.ones(160), np.tile(np.repeat(np.exp(1.5 * level), 5), 20)])


def test_a_pattern_lies_round_the_instants_that_are_told(rough_passes):
    track = track_passes(rough_passes, RATE, 1280 / RATE)
    peak = (track.time + (track.pattern.argmax() - CELLS // 2) * track.period / CELLS) * RATE
    true = 160.0 + 77 * 5 + 2.5 + 1280.0 * np.arange(20)  # the middle of the highest cell of each pass
    assert np.abs(peak[:, None] - true).min(axis=1).max() < 1.0
    # Of passes that are all alike the standard deviation of the record is that of the pattern.
    assert track.score == pytest.approx(math.sqrt(CELLS), rel=0.1)


@pytest.mark.parametrize(("passes", "tracked"), [(4.9, False), (5.1, True)])
def test_five_passes_are_tracked_and_fewer_are_not(rough_passes, passes, tracked):
    found = track_passes(rough_passes[: round(passes * 1280)], RATE, 1280 / RATE)
    assert (found is not None) == tracked


def bursts(cell, height, count):
    """The energy of `count` cells of the tracker, five samples each, all 1 but at a `cell` with an event."""
    energy = np.ones(count)
    energy[np.asarray(cell)] = height
    return np.repeat(energy, 5)


def cells_of(track):
    """Cells in which the events of a track lie by its pattern."""
    return np.round(track.time * RATE / 5.0 - 0.5 + track.pattern.argmax() - CELLS // 2).astype(int)


@pytest.mark.parametrize(
    ("late", "all_found"),
    [(8 * (np.arange(24) % 2), True), (13 * (np.arange(24) % 2), False), (14 * (np.arange(24) >= 12), False)],
)
def test_steps_may_differ_by_four_per_cent_from_their_mean_and_no_more(late, all_found):
    places = 100 + CELLS * np.arange(24) + late  # 8 cells are 3.1 % of 256, 13 and 14 are 5.1 and 5.5 %
    track = track_passes(bursts(places, 1e3, places[-1] + 100), RATE, 1280 / RATE)
    assert np.isin(places[1:-1], cells_of(track)).all() == all_found
    assert np.abs(np.diff(track.time) / track.period - 1.0).max() < 0.045  # and what is left of a cell


def test_something_weaker_beside_the_place_of_a_missing_event_does_not_pull_a_pass_there():
    places = 100 + CELLS * np.arange(24)
    height = np.where(np.arange(24) == 12, 5.0, 1e3)
    track = track_passes(bursts(places + 9 * (height < 1e3), height, places[-1] + 100), RATE, 1280 / RATE)
    assert np.abs(cells_of(track)[:, None] - places).min(axis=0).max() == 0


@pytest.mark.parametrize("wrong", [0.97, 1.03])
def test_through_silence_passes_go_on_as_regularly_as_they_came(wrong):
    places = 100 + CELLS * np.arange(24)
    energy = bursts(places, 1e3, CELLS * 28)  # four passes more in which nothing is heard
    track = track_passes(energy, RATE, wrong * 1280 / RATE)
    late = track.time > (places[-1] + 10) * 5.0 / RATE
    assert late.sum() >= 3
    assert np.diff(track.time[late]) * RATE == pytest.approx(np.full(late.sum() - 1, 1280.0), abs=10.0)  # two cells


def test_silent_passes_leave_the_pattern_of_the_others_as_it_is():
    places = 100 + CELLS * np.arange(24)
    heard = places[np.arange(24) % 4 != 2]
    track = track_passes(bursts(heard, 1e3, places[-1] + 100), RATE, 1280 / RATE)
    # An event 1000 times as strong as what is there otherwise: ln(1 + 1000) above ln(1 + 1).
    assert np.ptp(track.pattern) == pytest.approx(math.log(1001.0 / 2.0), rel=0.02)


def test_too_short_a_record_has_no_track():
    assert track_passes(np.ones(1000), RATE, PERIOD) is None


def test_anchors_lie_on_one_event_to_a_fraction_of_a_sample(pulse_train):
    train = pulse_train(LAG, PERIOD)
    energy = prewhitened(train.signal).residual ** 2
    found = aligned(energy, RATE, track_passes(energy, RATE, PERIOD))
    away = offset_from(found.place / RATE, np.concatenate([train.entry, train.exit])) * RATE
    # Pulses are placed to the nearest sample: ±0.5, quartiles ±0.25.
    assert np.subtract(*np.percentile(away, [75, 25])) < 0.7


@pytest.mark.parametrize("lag_samples", [12, 60, 300])
@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_the_lag_of_two_pulses_is_among_the_candidates_without_bias(pulse_train, lag_samples, noise):
    train = pulse_train(lag_samples / RATE, PERIOD, noise=noise)
    found = gather_evidence(train.signal, RATE, {"outer": PERIOD * 1.01, "inner": PERIOD / 1.45})
    assert found is not None
    assert found.race == "outer"
    # Half a sample of placing, averaged over 85 passes, leaves 0.05; peaks of the mean pass are read to about 0.2.
    # The whole lag is in samples, so slip plays no part in these trains.
    assert np.abs(found.pairs.lag - lag_samples).min() < 0.5


def test_every_pair_has_every_feature_and_all_are_finite(pulse_train):
    train = pulse_train(LAG, PERIOD, noise=0.3)
    pairs = gather_evidence(train.signal, RATE, {"outer": PERIOD}).pairs
    assert pairs.features.shape == (pairs.lag.size, len(PAIR_COLUMNS))
    assert np.isfinite(pairs.features).all()
    assert np.all((pairs.lag > 0.0) & (pairs.lag < 0.97 * PERIOD * 1.02 * RATE))


def test_the_mean_pass_repeats_after_one_period(pulse_train):
    train = pulse_train(LAG, PERIOD, slip=0.0)
    whitened = prewhitened(train.signal).residual
    track = track_passes(whitened**2, RATE, PERIOD)
    mean = mean_pass(train.signal, whitened, aligned(whitened**2, RATE, track), track.period * RATE)
    places = candidate_places(mean)
    assert np.all(np.abs(places) <= 0.5 * mean.period)
    period = round(mean.period)
    middle = mean.energy.shape[1] // 2
    here, later = (mean.energy[0, place - 3 : place + 4].max() for place in (middle, middle + period))
    # Without slip the next pass comes one period later, rounded to a sample: a third of its sharp peak at least.
    assert abs(math.log(later / here)) < math.log(3.0)


def mean_of_steps(first, last, period=400.0):
    """A mean pass with a rumble of a hundredfold energy between two offsets, in every channel."""
    offset = np.arange(-440, 441)
    phase = (offset + 0.5 * period) % period - 0.5 * period
    rumble = np.where((phase >= first) & (phase <= last), 100.0, 1.0)
    flat = np.zeros(offset.size)
    return MeanPass(offset, np.tile(rumble, (4, 1)), flat, flat, 1.0, flat, 1.0, 50.0, period)


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_pairs_know_what_their_record_is_like(pulse_train, race):
    signal = pulse_train(LAG, PERIOD, noise=0.3, duration=0.4).signal
    found = gather_evidence(signal, RATE, {race: PERIOD})
    row, white = dict(zip(PAIR_COLUMNS, found.pairs.features[0], strict=True)), prewhitened(signal)
    assert (found.race, row["inner"]) == (race, float(race == "inner"))
    assert row["score"] == found.track.score
    told = {name: row[name] for name in ("noise", "predictability", "peakedness")}
    facts = (log_noise_share(signal), predictability(signal), peakedness(white.residual**2))
    assert told == pytest.approx(dict(zip(told, facts, strict=True)))
    assert (found.deviation, found.unit) == pytest.approx((signal.std(), white.unit))


def test_what_is_told_in_the_unit_of_the_signal_grows_with_it_and_nothing_else_does(pulse_train):
    signal = pulse_train(LAG, PERIOD, noise=0.3, duration=0.4).signal
    one, other = (gather_evidence(scale * signal, RATE, {"outer": PERIOD}) for scale in (1.0, 1e3))
    for name in ("deviation", "unit"):
        assert getattr(other, name) == pytest.approx(1e3 * getattr(one, name), rel=1e-6)
    for name in ("sway_unit", "give_unit"):
        assert getattr(other.mean, name) == pytest.approx(1e3 * getattr(one.mean, name), rel=1e-6)
    assert other.pairs.features == pytest.approx(one.pairs.features, rel=1e-4, abs=1e-4)


def mean_of_passes(whitened, place, weight=None, signal=None):
    weight = np.ones(len(place)) if weight is None else np.array(weight)
    signal = whitened if signal is None else signal
    return mean_pass(signal, whitened, Alignment(np.asarray(place, dtype=float), weight), 400.0)


def test_each_band_holds_what_lies_in_it():
    """Bursts of 0.01, 0.06 and 0.3 of the rate, at 100 samples before the anchor, at it and 100 behind it."""
    time, place = np.arange(8000), 400 * np.arange(2, 18)
    whitened = 1e-3 * np.random.default_rng(0).standard_normal(time.size)
    for away, share in ((-100, 0.01), (0, 0.06), (100, 0.3)):
        since = time - place[:, None] - away
        whitened += (np.exp(-0.5 * (since / 15.0) ** 2) * np.cos(2.0 * np.pi * share * since)).sum(axis=0)
    mean = mean_of_passes(whitened, place)
    bursts = mean.energy[:, [np.flatnonzero(mean.offset == away)[0] for away in (-100, 0, 100)]]
    # Gaussian edges at 0.03 and 0.12 of the rate leave less than 2 % of the energy of the other ones, and 55 % or more.
    assert (bursts[1:] / bursts[1:].max(axis=1, keepdims=True) > 0.1).tolist() == np.eye(3, dtype=bool).tolist()


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_the_energy_of_each_channel_is_over_its_own_median(scale):
    noise = scale * np.random.default_rng(0).standard_normal(100_000)
    mean = mean_of_passes(noise, 400 * np.arange(2, 240))
    # Half of the squares of a standard normal variable, whose mean is 1, are below 0.6745².
    assert mean.energy.mean(axis=1) == pytest.approx(np.full(4, 1.0 / 0.6745**2), rel=0.05)


def test_neither_passes_without_weight_nor_what_lies_beyond_the_record_count():
    whitened = np.ones(3000)
    whitened[[0, 1650]] = 1e3  # what stands at the start is before the first pass but for 200 samples
    mean = mean_of_passes(whitened, [200, 1000, 1600], [1.0, 1.0, 0.0])
    at = np.flatnonzero(mean.energy[Channel.ALL] > 2.0)
    assert mean.offset[at].tolist() == [-200]


def test_waveform_and_sway_are_of_the_signal_prewhitened_and_as_it_was():
    turn = 2.0 * np.pi * np.arange(20_000) / 400.0
    mean = mean_of_passes(np.sin(20.0 * turn), 400 * np.arange(2, 48), signal=5.0 + 3.0 * np.cos(turn))
    turn = 2.0 * np.pi * mean.offset / 400.0
    assert mean.waveform == pytest.approx(np.sin(20.0 * turn), abs=1e-9)
    assert (mean.sway.mean(), mean.sway.std()) == pytest.approx((0.0, 1.0), abs=1e-12)
    assert mean.sway_unit == pytest.approx((3.0 * np.cos(turn)).std(), rel=0.01)  # a blur of 4 samples leaves 0.998


def test_energy_is_periodic():
    mean = replace(mean_of_steps(0, 0), energy=np.tile(1.0 + np.arange(-440, 441) % 400, (4, 1)))
    summed, ends = RunningEnergy(mean), np.array([[-460.0, -450.0], [-60.0, -50.0], [340.0, 350.0]])
    # Offsets 340 to 350, both included, have energies of 341 to 351, the same as those a period or two earlier.
    assert summed.level(*ends.T)[0] == pytest.approx(np.full(3, math.log(346.0)))
    assert summed.level(np.array([445.0]), np.array([455.0]))[0] == pytest.approx([math.log(51.0)])


@pytest.mark.parametrize("channel", [Channel.LOW, Channel.HIGH])
def test_what_only_one_band_shows_is_a_candidate_too_to_a_fraction_of_a_sample(channel):
    mean = mean_of_steps(500, 600)
    energy = np.ones_like(mean.energy)
    energy[channel] += 50.0 * np.exp(-0.5 * ((mean.offset - 30.3) / 3.0) ** 2)
    assert np.abs(candidate_places(replace(mean, energy=energy)) - 30.3).min() < 0.1


def test_the_ends_of_a_rumble_that_only_one_band_shows_are_no_candidates_and_its_middle_is():
    energy = np.ones((4, 881))
    energy[Channel.LOW] = mean_of_steps(-60, 20).energy[Channel.LOW]
    places = candidate_places(replace(mean_of_steps(-60, 20), energy=energy))
    assert np.abs(places + 20).min() < 1.5
    assert min(np.abs(places - 20).min(), np.abs(places + 60).min()) > 5.0


def test_what_is_more_than_half_a_pass_off_hides_no_candidate():
    mean = mean_of_steps(-60, 20)
    loud = np.where(np.abs(mean.offset - 300) < 3, 1e9, mean.energy)
    assert candidate_places(replace(mean, energy=loud)) == pytest.approx(candidate_places(mean), abs=0.1)


def test_of_peaks_that_all_stand_out_the_eighteen_highest_are_candidates():
    mean, place = mean_of_steps(500, 600), np.arange(-180, 181, 18)
    height = -3.5 * np.random.default_rng(2).permutation(place.size) / place.size
    peaks = np.exp(height - 0.5 * ((mean.offset[:, None] - place) / 2.0) ** 2).sum(axis=1)
    found = candidate_places(replace(mean, energy=np.tile(peaks, (4, 1))))
    assert found == pytest.approx(np.sort(place[np.argsort(-height)[:18]]), abs=0.5)


def test_both_ends_of_a_rumble_are_candidates():
    places = candidate_places(mean_of_steps(-60, 20))
    # The least blur puts an edge one sample inside the rumble, a coarser one further.
    assert np.abs(places - 20).min() < 1.5
    assert np.abs(places + 60).min() < 1.5


def test_candidates_may_be_as_near_as_1_6_samples_and_no_nearer():
    generator, apart = np.random.default_rng(0), []
    for _ in range(30):
        mean = mean_of_steps(-60, 20)
        rough = np.exp(generator.standard_normal(mean.energy.shape))
        places = candidate_places(replace(mean, energy=mean.energy * rough))
        assert places.size == 18
        apart += np.diff(places).tolist()
    # Of some five hundred distances many fall just above the least one that is allowed.
    assert 1.6 <= min(apart) < 1.65


def test_levels_beside_a_candidate_tell_on_which_side_it_is_quiet():
    mean = mean_of_steps(-60, 20)
    shapes = event_shapes(mean, np.array([-60.0, 20.0]), RunningEnergy(mean))
    start, end = ({name: column[k] for name, column in shapes.items()} for k in range(2))
    # A factor of a hundred is 4.6; the core holds 2.5 of 4 samples of the rumble, so it lies 0.3 to 0.5 below it.
    assert start["before_12"] == pytest.approx(-math.log(100.0), abs=0.6)
    assert start["after_12"] == pytest.approx(0.0, abs=0.6)
    assert end["before_12"] == pytest.approx(0.0, abs=0.6)
    assert end["after_12"] == pytest.approx(-math.log(100.0), abs=0.6)
    assert start["low_step_12"] == pytest.approx(math.log(100.0), abs=0.1)  # both windows lie beside the step
    assert end["low_step_12"] == pytest.approx(-math.log(100.0), abs=0.1)


def test_a_signal_upside_down_turns_sway_and_displacement_and_nothing_else(pulse_train):
    train = pulse_train(LAG, PERIOD, noise=0.1)
    one, other = (gather_evidence(sign * train.signal, RATE, {"outer": PERIOD}) for sign in (1.0, -1.0))
    assert np.allclose(one.mean.energy, other.mean.energy, rtol=1e-9)
    assert np.allclose(one.mean.sway, -other.mean.sway, atol=1e-9)
    assert np.allclose(one.mean.give, -other.mean.give, atol=1e-9)
    turned = ("sway", "give", "wave_sign")
    same = [k for k, name in enumerate(PAIR_COLUMNS) if not any(word in name for word in turned)]
    assert np.allclose(one.pairs.features[:, same], other.pairs.features[:, same], atol=1e-6)
    # What was heard once serves both.
    turned_over = hear(train.signal, RATE, {"outer": PERIOD}).evidence(-1.0)
    assert np.array_equal(turned_over.pairs.features, other.pairs.features)
    assert np.array_equal(turned_over.mean.give, other.mean.give)


def test_the_displacement_of_a_sine_is_the_sine_over_its_frequency_squared():
    samples = 800
    turn = 2.0 * math.pi * 3.0 / samples  # three waves a pass
    time = np.arange(40 * samples)
    signal = np.cos(turn * time)
    places = np.arange(2.0, 38.0) * samples
    mean = mean_pass(signal, signal, Alignment(places, np.ones(places.size)), float(samples))
    # A blur of four samples leaves exp(-(4 turn)²/2) = 0.996 of the wave, and interpolation a thousandth.
    assert 0.5 * np.ptp(mean.give) * mean.give_unit == pytest.approx(1.0 / turn**2, rel=6e-3)
    assert np.corrcoef(mean.give, mean.sway)[0, 1] < -0.999


def test_bands_of_the_mean_pass_do_not_ring(pulse_train):
    train = pulse_train(300.0 / RATE, PERIOD, slip=0.0)
    whitened = np.zeros(train.signal.size)
    whitened[np.round(train.entry * RATE).astype(int)] = 1.0
    place = np.round(train.entry * RATE)[1:-1]
    mean = mean_pass(whitened, whitened + 1e-9, Alignment(place, np.ones(place.size)), PERIOD * RATE)
    middle, far = mean.energy.shape[1] // 2, 60
    # A Gaussian band of 0.03 of the rate is 5.3 samples wide in time: nothing but rounding is left 60 samples off.
    assert np.all(mean.energy[:, middle + far] < 1e-12 * mean.energy[:, middle])


@pytest.mark.parametrize(("weight", "passes"), [((1.0, 1.0, 0.0, 0.0), 2.0), ((1.0, 0.5), 1.8), ((0.3,) * 5, 5.0)])
def test_passes_count_by_their_weight(weight, passes):
    # (Σ w)² / Σ w²: the number of equal passes whose mean is as exact.
    noise = np.random.default_rng(0).standard_normal(2000)
    place = 300.0 * (1.0 + np.arange(len(weight)))
    assert mean_pass(noise, noise, Alignment(place, np.array(weight)), 200.0).passes == pytest.approx(passes)


@pytest.mark.parametrize("quiet", [(2,), (0, 1, 2, 4)])
def test_a_pass_half_as_loud_weighs_a_quarter(quiet):
    period, loud = 400, np.where(np.isin(np.arange(20) % 5, quiet), 0.5, 1.0)
    energy = np.zeros(20 * period)
    energy[200 + period * np.arange(20)] = loud**2
    pattern = np.zeros(CELLS)
    pattern[CELLS // 2] = 1.0
    track = PassTrack((200.0 + period * np.arange(20)) / RATE, period / RATE, pattern, 1.0)
    found = aligned(energy, RATE, track)
    assert found.place == pytest.approx(200.0 + period * np.arange(20), abs=1e-6)
    assert found.weight == pytest.approx(loud**2)


def lined_up(place, nominal, second):
    """Where passes of 1600 samples are lined up whose event is at `place` (K,), in samples, `nominal` (K,) being known,
    and followed after six samples by one of the size `second` (K,)."""
    since = np.maximum(np.arange(1600 * place.size) - place[:, None] - np.array([0.0, 6.0])[:, None, None], 0.0)
    events = (since / 1.2) ** 2 * np.exp(-since / 1.2) * np.stack([np.ones(place.size), second])[..., None]
    pattern = np.zeros(CELLS)
    pattern[CELLS // 2] = 1.0
    track = PassTrack(nominal / RATE, 1600 / RATE, pattern, 1.0)
    return aligned(events.sum(axis=(0, 1)) ** 2, RATE, track).place


def test_passes_are_lined_up_to_a_tenth_of_a_sample():
    nominal = 800.0 + 1600.0 * np.arange(20)
    place = nominal + np.random.default_rng(6).uniform(-2.0, 2.0, 20)
    away = lined_up(place, nominal, np.zeros(20)) - place
    assert np.abs(away - away.mean()).max() < 0.1


def test_a_pass_that_shows_the_first_of_two_events_alone_is_lined_up_with_the_others():
    place = 800.0 + 1600.0 * np.arange(20)
    away = lined_up(place, place, np.where(np.arange(20) % 3 == 1, 0.0, 0.8)) - place
    assert np.abs(away - away.mean()).max() < 0.5


@pytest.mark.parametrize(("passes", "enough"), [(2, False), (3, True)])
def test_three_passes_are_enough_to_line_up(passes, enough):
    pattern, nominal = np.eye(CELLS)[CELLS // 2], 800.0 + 1600.0 * np.arange(passes)
    energy = np.zeros(1600 * passes)
    energy[nominal.astype(int)] = 1.0
    found = aligned(energy, RATE, PassTrack(nominal / RATE, 1600 / RATE, pattern, 1.0))
    assert (found is not None) == enough
    assert not enough or found.place == pytest.approx(nominal, abs=1e-6)


def test_a_little_louder_event_far_from_where_it_is_expected_moves_no_pass():
    nominal, pattern = 800.0 + 1600.0 * np.arange(20), np.eye(CELLS)[CELLS // 2]
    energy = np.zeros(1600 * nominal.size)
    energy[nominal.astype(int)] = 1.0
    energy[nominal[::5].astype(int) - 28] = 1.02**2  # up to 32 samples are searched
    found = aligned(energy, RATE, PassTrack(nominal / RATE, 1600 / RATE, pattern, 1.0))
    assert found.place == pytest.approx(nominal, abs=0.1)


def test_prewhitened_noise_is_told_in_units_of_its_median_size():
    noise = 3.0 * np.random.default_rng(0).standard_normal(40_000)
    found = prewhitened(noise)
    assert np.median(np.abs(found.residual)) == pytest.approx(1.0)
    # Of a standard normal variable half are smaller than 0.6745; 40 000 samples tell it to half a per cent.
    assert found.unit == pytest.approx(3.0 * 0.6745, rel=0.02)


def test_of_a_signal_that_is_silent_most_of_the_time_the_unit_is_no_rounding():
    clicks = np.zeros(20_000)
    clicks[::499] = 1.0
    residual = prewhitened(np.concatenate([clicks, -clicks])).residual
    assert np.median(np.abs(residual)) == 0.0
    assert np.isfinite(np.sum(residual**2))


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_differences_of_white_noise_have_twice_its_variance_whatever_its_scale(scale):
    noise = scale * np.random.default_rng(0).standard_normal(100_000)
    assert predictability(noise) == pytest.approx(-math.log(2.0), abs=0.02)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_the_energy_of_white_noise_is_as_peaked_as_its_median_says_whatever_its_scale(scale):
    energy = (scale * np.random.default_rng(0).standard_normal(100_000)) ** 2
    # Half of the squares of a standard normal variable, whose mean is 1, are below 0.6745².
    assert peakedness(energy) == pytest.approx(-2.0 * math.log(0.6745), abs=0.02)
    energy[::100] *= 1e4
    assert peakedness(energy) == pytest.approx(math.log(100.0) - 2.0 * math.log(0.6745), abs=0.1)


def test_a_single_candidate_is_no_evidence(pulse_train, monkeypatch):
    train = pulse_train(150.0 / RATE, 0.011)
    monkeypatch.setattr("labels.spall_size.estimation.gathering.candidate_places", lambda mean: np.array([3.0]))
    assert gather_evidence(train.signal, RATE, {"outer": 0.011}) is None


def test_the_race_that_shows_most_clearly_is_taken_in_whatever_order_they_are_asked_for(pulse_train):
    signal = pulse_train(LAG, PERIOD).signal
    periods = {"outer": 1.01 * PERIOD, "inner": PERIOD / 1.45}
    for races in (("outer", "inner"), ("inner", "outer")):
        assert gather_evidence(signal, RATE, {race: periods[race] for race in races}).race == "outer"
    assert gather_evidence(signal, RATE, {"outer": 1.45 * PERIOD, "inner": PERIOD}).race == "inner"


def test_too_few_passes_give_no_evidence():
    noise = np.random.default_rng(0).standard_normal(1000)  # 1.4 passes
    assert gather_evidence(noise, RATE, {"outer": 0.011}) is None
