"""Records as they are read to learn from and to judge: copies, noise, equal pieces."""

import numpy as np
import pytest

from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.record_rows import RecordFacts, RecordRows, equal_pieces, record_rows
from datagen.corpus import Corpus
from datagen.judging.known import UNKNOWN_SPEED
from labels.features.table import FEATURE_NAMES

pytestmark = pytest.mark.usefixtures("short_records_are_judged")


def test_noisy_copies_are_whole_and_a_stretch_from_anywhere(tiny_corpus):
    labels, signal = Corpus(tiny_corpus).labels.iloc[0].copy(), np.random.default_rng(1).standard_normal((40_000, 1))
    labels["rate_hz"] = 20_000.0
    rows = record_rows(signal, labels, Reading(copies_db=(-18.0, 12.0))).rows
    turns = np.exp([row.values[FEATURE_NAMES.index("turns")] for row in rows])
    assert [row.noisy for row in rows] == [False, True, True]
    assert turns[1] == pytest.approx(turns[0], rel=0.03)  # the speed is refined by up to 2.2 %
    assert 0.14 * turns[0] < turns[2] < 1.03 * turns[0]  # 0.3 s of 2 s is the least


def test_noise_is_added_at_the_level_asked_and_another_in_each_draw(tiny_corpus):
    corpus = Corpus(tiny_corpus)
    labels, signal = corpus.labels.iloc[0], corpus.waveform(0)[:, :1]
    clean, one, again, other = (
        record_rows(signal, labels, reading).rows[0].values
        for reading in (
            Reading(),
            Reading(noise_db=-10.0),
            Reading(noise_db=-10.0),
            Reading(noise_db=-10.0, noise_draw=1),
        )
    )
    np.testing.assert_array_equal(one, again)
    assert not np.array_equal(one, clean)
    assert not np.array_equal(one, other)


def test_long_records_are_cut_into_equal_windows_that_lose_nothing():
    pieces = list(equal_pieces(np.arange(25_000.0), 1000.0, 10.0))
    assert [piece.size for piece in pieces] == [8334, 8333, 8333]
    np.testing.assert_array_equal(np.concatenate(pieces), np.arange(25_000.0))
    assert len(list(equal_pieces(np.arange(1290.0), 1000.0, 1.25))) == 1  # 3 % longer is still one


def test_a_record_without_a_speed_is_rejected_with_its_reason(tiny_corpus):
    labels = Corpus(tiny_corpus).labels.iloc[0].copy()
    labels["speed_rpm"] = np.nan
    assert record_rows(np.zeros((100, 2)), labels, Reading()) == RecordRows([], RecordFacts(UNKNOWN_SPEED))


def test_no_bandwidth_is_drawn_where_less_than_the_lowest_is_asked_for_or_there():
    stream = np.random.default_rng(0)
    assert Reading(bandwidth=1500.0, lowest_bandwidth=5500.0).drawn_bandwidth(50_000.0, stream) == 1500.0
    assert Reading(lowest_bandwidth=5500.0).drawn_bandwidth(9000.0, stream) == 4500.0
    drawn = [Reading(lowest_bandwidth=5500.0).drawn_bandwidth(50_000.0, stream) for _ in range(200)]
    assert 5500.0 <= min(drawn) < 6000.0
    assert 18_000.0 < max(drawn) <= 20_000.0


def test_stretches_lie_anywhere_and_are_as_often_shorter_as_longer_than_the_geometric_mean():
    stream, reading = np.random.default_rng(1), Reading(copies_db=(-18.0, 12.0))
    cut = [reading.stretch(30_000, 1000.0, 2, stream) for _ in range(2000)]
    sizes = np.array([part.stop - part.start for part in cut])
    # From 0.3 s to 30 s; the median of 2000 draws from 4.6 nats is known to 0.05.
    assert np.median(sizes) == pytest.approx(3000.0, rel=0.2)
    assert (sizes.min() < 320, sizes.max() > 28_000) == (True, True)
    starts, stops = [part.start for part in cut], [part.stop for part in cut]
    assert 0 <= min(starts) < 100
    assert 29_900 < max(stops) <= 30_000
