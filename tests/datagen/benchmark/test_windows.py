"""Raw windows for estimators that make features of their own."""

import numpy as np

from datagen.benchmark.windows import WINDOW_SAMPLES, cut, read_windows, resampled
from datagen.corpus import Corpus


def test_raw_windows_of_any_rate_hold_the_same_tone():
    tone = np.cos(2.0 * np.pi * 100.0 * np.arange(10_000) / 10_000.0)
    slow = resampled(tone, 10_000.0, 2000.0)
    np.testing.assert_allclose(slow, np.cos(2.0 * np.pi * 100.0 * np.arange(2000) / 2000.0), atol=1e-9)
    assert [window.size for window in cut(tone)] == [WINDOW_SAMPLES, WINDOW_SAMPLES]


def test_raw_windows_lie_in_a_file_and_are_those_of_the_records(tiny_corpus):
    corpus = Corpus(tiny_corpus)
    record, rate = int(corpus.labels["record"].iloc[0]), float(corpus.labels["rate_hz"].iloc[0])
    found = read_windows(tiny_corpus, np.array([record]), rate)
    assert isinstance(found.table, np.memmap)
    first = cut(corpus.waveform(record)[:, 0].astype(np.float64))
    np.testing.assert_allclose(found.table[: len(first)], first, rtol=1e-6, atol=1e-12)  # float32 in the file
    assert set(found.record.tolist()) == {record}
    assert found.axis.tolist() == np.repeat([0, 1], len(found) // 2).tolist()


def test_an_axis_whose_sensor_is_dead_has_no_windows(tiny_corpus, monkeypatch):
    heard = Corpus.waveform

    def without_y(corpus, record):
        return heard(corpus, record) * np.array([1.0, 0.0])

    monkeypatch.setattr(Corpus, "waveform", without_y)
    corpus = Corpus(tiny_corpus)
    record, rate = int(corpus.labels["record"].iloc[0]), float(corpus.labels["rate_hz"].iloc[0])
    found = read_windows(tiny_corpus, np.array([record]), rate)
    assert set(found.axis.tolist()) == {0}
    assert found.table.any(axis=1).all()
