"""Raw windows of a corpus, for estimators that make features of their own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryFile

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from datagen.benchmark.rows import Rows
from datagen.corpus import Corpus
from datagen.files.temporary import no_temporary_file
from datagen.progress import Count, ignore
from labels.dead_sensor import is_dead
from physics.arrays import Array

WINDOW_SAMPLES = 4096
MOST_WINDOWS = 8


def common_rate(folders: Iterable[Path], bandwidth: float) -> float:
    """The rate (Hz) that the windows of all corpora are resampled to: the lowest of theirs and twice the bandwidth."""
    lowest = min(float(Corpus(folder).labels["rate_hz"].min()) for folder in folders)
    return min(lowest, 2.0 * bandwidth)


def read_windows(folder: Path, records: NDArray[np.int64], rate: float, count: Count = ignore) -> Rows:
    """Windows (N, 4096) at `rate` (Hz), in m/s², of at most eight places of each axis of a record.

    An axis whose sensor is dead has none. What the window is too long for is padded with silence. They lie in a
    temporary file, read as they are needed, so that memory does not grow with the corpus. `count` is called with how
    many records are read. Raises NoTemporaryRoom where that file does not fit.
    """
    owners: list[int] = []
    axes: list[int] = []
    with ExitStack() as opened:
        corpus = opened.enter_context(Corpus(folder))
        with _room_for_windows(records.size):
            file = opened.enter_context(TemporaryFile())
        rates = corpus.labels.set_index("record")["rate_hz"]
        for done, record in enumerate(records.tolist(), start=1):
            for axis, signal in enumerate(np.asarray(corpus.waveform(record), dtype=np.float64).T):
                if not is_dead(signal):
                    found = cut(resampled(signal, float(rates[record]), rate))
                    with _room_for_windows(records.size):
                        file.write(np.asarray(found, dtype=np.float32).tobytes())
                    owners += [record] * len(found)
                    axes += [axis] * len(found)
            count(done, records.size)
        with _room_for_windows(records.size):
            file.flush()
        # The mapping keeps the file alive after it is closed, and an empty one cannot be mapped.
        shape = (len(owners), WINDOW_SAMPLES)
        table = np.memmap(file, np.float32, "r", shape=shape) if owners else np.empty(shape, np.float32)
    owner, of_axis = np.array(owners, dtype=np.int64), np.array(axes, dtype=np.int64)
    return Rows(table, owner, of_axis, np.zeros(len(owners), dtype=bool))


@contextmanager
def _room_for_windows(records: int) -> Iterator[None]:
    """BadInput that names the folder of temporary files, for the windows of so many records, in place of an OSError of
    the block, which does nothing but write there."""
    try:
        yield
    except OSError as problem:
        needed = records * MOST_WINDOWS * WINDOW_SAMPLES * np.dtype(np.float32).itemsize
        raise no_temporary_file(problem, needed, "a folder with room for all windows") from None


def resampled(signal: Array, rate: float, target: float) -> Array:
    """The signal (T,) at the `target` rate (Hz, not above `rate`): its Fourier components up to half of that."""
    size = round(signal.size * target / rate)
    if size >= signal.size:
        return signal
    return np.asarray(fft.irfft(fft.rfft(signal)[: size // 2 + 1], size)) * (size / signal.size)


def cut(signal: Array) -> list[Array]:
    """At most eight windows of 4096 samples, spread evenly over the signal (T,)."""
    if signal.size < WINDOW_SAMPLES:
        return [np.pad(signal, (0, WINDOW_SAMPLES - signal.size))]
    count = min(MOST_WINDOWS, signal.size // WINDOW_SAMPLES)
    starts = np.linspace(0, signal.size - WINDOW_SAMPLES, count).astype(np.int64)
    return [signal[start : start + WINDOW_SAMPLES] for start in starts]
