"""Raw windows for estimators that make features of their own."""

import numpy as np
import pytest

from datagen.benchmark.windows import WINDOW_SAMPLES, common_rate, cut, read_windows, resampled
from datagen.corpus import Corpus
from datagen.files.temporary import NoTemporaryRoom


def test_raw_windows_of_any_rate_hold_the_same_tone():
    tone = np.cos(2.0 * np.pi * 100.0 * np.arange(10_000) / 10_000.0)
    slow = resampled(tone, 10_000.0, 2000.0)
    np.testing.assert_allclose(slow, np.cos(2.0 * np.pi * 100.0 * np.arange(2000) / 2000.0), atol=1e-9)
    assert [window.size for window in cut(tone)] == [WINDOW_SAMPLES, WINDOW_SAMPLES]


@pytest.mark.parametrize(("windows", "kept"), [(1.0, 1), (2.5, 2), (8.0, 8), (30.0, 8)])
def test_at_most_eight_windows_are_spread_from_the_first_sample_to_the_last(windows, kept):
    signal = np.arange(windows * WINDOW_SAMPLES)
    found = cut(signal)
    assert len(found) == kept
    assert (found[0][0], found[-1][-1]) == (0.0, signal[-1] if kept > 1 else WINDOW_SAMPLES - 1.0)
    assert set(np.diff([window[0] for window in found])) <= {
        (signal.size - WINDOW_SAMPLES) // max(kept - 1, 1) + k for k in (0, 1)
    }


def test_windows_are_no_faster_than_the_bandwidth_asks_for(tiny_corpus):
    assert common_rate([tiny_corpus], 20_000.0) == 32_768.0
    assert common_rate([tiny_corpus], 500.0) == 1000.0


def test_raw_windows_lie_in_a_file_and_are_those_of_the_records(tiny_corpus):
    corpus = Corpus(tiny_corpus)
    record, rate = int(corpus.labels["record"].iloc[0]), float(corpus.labels["rate_hz"].iloc[0])
    found = read_windows(tiny_corpus, np.array([record]), rate)
    assert isinstance(found.table, np.memmap)
    first = cut(corpus.waveform(record)[:, 0].astype(np.float64))
    np.testing.assert_allclose(found.table[: len(first)], first, rtol=1e-6, atol=1e-12)  # float32 in the file
    assert set(found.record.tolist()) == {record}
    assert found.axis.tolist() == np.repeat([0, 1], len(found) // 2).tolist()


def test_windows_that_find_no_room_name_the_folder_of_temporary_files(tiny_corpus, monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    with pytest.raises(NoTemporaryRoom, match=r"^TMPDIR: .*No such file or directory.*room for all windows$"):
        read_windows(tiny_corpus, np.array([0]), 1000.0)


def test_an_output_that_was_closed_is_not_told_as_a_full_disk(tiny_corpus):
    def closed(done, total):
        raise BrokenPipeError

    with pytest.raises(BrokenPipeError):
        read_windows(tiny_corpus, np.array([0]), 1000.0, closed)


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
