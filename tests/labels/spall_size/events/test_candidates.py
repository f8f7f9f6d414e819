"""Events that may be the entry or the exit, and what is told of each."""

import math
from dataclasses import replace

import numpy as np
import pytest
from made_passes import PERIOD, RATE, mean_of_steps

from labels.spall_size.columns.event_shapes import event_shapes
from labels.spall_size.estimation.gathering import gather_evidence
from labels.spall_size.events.candidates import candidate_places
from labels.spall_size.signal.mean_pass import Channel
from labels.spall_size.signal.running_energy import RunningEnergy


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


def test_a_single_candidate_is_no_evidence(pulse_train, monkeypatch):
    train = pulse_train(150.0 / RATE, 0.011)
    monkeypatch.setattr("labels.spall_size.estimation.gathering.candidate_places", lambda mean: np.array([3.0]))
    assert gather_evidence(train.signal, RATE, {"outer": 0.011}) is None
