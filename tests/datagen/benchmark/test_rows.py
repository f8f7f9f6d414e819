"""Records that give no rows, or rows of some of their pieces only."""

import numpy as np
import pandas
import pytest

from datagen.benchmark.rows import TOO_SHORT, Reading, record_rows
from labels.liveness import DEAD

RATE = 12_000.0


def labels(**changes):
    """What the labels say of a small bearing at 30 Hz."""
    known = {"balls": 9, "pitch_diameter": 39.04e-3, "ball_diameter": 7.94e-3, "contact_angle": 0.0}
    named = {"bearing_id": "b", "recording": "r", "record": 1, "rate_hz": RATE, "speed_rpm": 1800.0}
    return pandas.Series(named | known | changes)


def shaking(size):
    """White noise of a machine that shakes."""
    return np.random.default_rng(size).standard_normal((size, 1))


@pytest.mark.parametrize("size", [16, 40, 63])
@pytest.mark.parametrize("reading", [Reading(), Reading(copies_db=(-18.0, 12.0)), Reading(noise_db=-10.0)])
def test_a_record_of_few_samples_is_rejected_with_its_reason(size, reading):
    assert record_rows(shaking(size), labels(), reading) == ([], TOO_SHORT)


@pytest.mark.parametrize("size", [64, 65, 97, 200, 499])
def test_a_record_of_few_samples_more_has_finite_features(size):
    rows, reason = record_rows(shaking(size), labels(), Reading(copies_db=(-18.0, 12.0)))
    assert reason == ""
    assert np.isfinite([row.values for row in rows]).all()


def test_a_window_without_signal_leaves_the_vote_to_the_others():
    signal = shaking(3000)
    signal[1000:2000] = signal[1000]
    rows, reason = record_rows(signal, labels(), Reading(window=1000 / RATE))
    assert (len(rows), reason) == (2, "")
    assert record_rows(np.full((3000, 1), 2.5), labels(), Reading(window=1000 / RATE)) == ([], DEAD)


def test_a_record_that_begins_in_silence_is_heard():
    signal = np.concatenate([np.zeros((5000, 1)), shaking(7000)])
    rows, reason = record_rows(signal, labels(), Reading())
    assert (len(rows), reason) == (1, "")
