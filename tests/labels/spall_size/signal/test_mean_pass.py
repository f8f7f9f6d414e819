"""The mean of all passes, in each band."""

import math
from dataclasses import replace

import numpy as np
import pytest
from made_passes import LAG, PERIOD, RATE, mean_of_passes, mean_of_steps

from labels.spall_size.events.candidates import candidate_places
from labels.spall_size.signal.alignment import Alignment, aligned
from labels.spall_size.signal.mean_pass import Channel, mean_pass
from labels.spall_size.signal.pass_track import CELLS, PassTrack, track_passes
from labels.spall_size.signal.prewhitening import prewhitened
from labels.spall_size.signal.running_energy import RunningEnergy


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


def test_energy_is_periodic():
    mean = replace(mean_of_steps(0, 0), energy=np.tile(1.0 + np.arange(-440, 441) % 400, (4, 1)))
    summed, ends = RunningEnergy(mean), np.array([[-460.0, -450.0], [-60.0, -50.0], [340.0, 350.0]])
    # Offsets 340 to 350, both included, have energies of 341 to 351, the same as those a period or two earlier.
    assert summed.level(*ends.T)[0] == pytest.approx(np.full(3, math.log(346.0)))
    assert summed.level(np.array([445.0]), np.array([455.0]))[0] == pytest.approx([math.log(51.0)])


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
