"""When balls pass, found in the signal."""

import math

import numpy as np
import pytest
from made_passes import LAG, PERIOD, RATE, bursts, offset_from
from scipy.signal import lfilter

from labels.spall_size.signal.pass_track import CELLS, track_passes
from labels.spall_size.signal.prewhitening import prewhitened


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
