"""Passes lined up on their strongest event."""

import numpy as np
import pytest
from made_passes import LAG, PERIOD, RATE, offset_from

from labels.spall_size.signal.alignment import aligned
from labels.spall_size.signal.pass_track import CELLS, PassTrack, track_passes
from labels.spall_size.signal.prewhitening import prewhitened


def test_anchors_lie_on_one_event_to_a_fraction_of_a_sample(pulse_train):
    train = pulse_train(LAG, PERIOD)
    energy = prewhitened(train.signal).residual ** 2
    found = aligned(energy, RATE, track_passes(energy, RATE, PERIOD))
    away = offset_from(found.place / RATE, np.concatenate([train.entry, train.exit])) * RATE
    # Pulses are placed to the nearest sample: ±0.5, quartiles ±0.25.
    assert np.subtract(*np.percentile(away, [75, 25])) < 0.7


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
