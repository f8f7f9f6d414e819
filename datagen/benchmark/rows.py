"""Rows of the feature table of a corpus: one for each axis and window of a record, read shard by shard."""

from __future__ import annotations

import zlib
from collections.abc import Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from itertools import repeat
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from datagen.benchmark.fitness import unfit
from datagen.benchmark.known import known_kinematics
from datagen.corpus import Corpus
from datagen.telling import Count, unheard
from labels.band_tree import COMMON_BANDWIDTH
from labels.classifier.liveness import DEAD, liveness
from labels.dead_sensor import is_dead
from labels.features.analysis import analyse
from labels.features.conditioning import FEWEST_SAMPLES_USED
from labels.features.glitches import without_glitches
from labels.features.kinematics import Kinematics
from labels.features.shocks import without_shocks
from labels.features.table import FEATURE_NAMES, feature_values
from labels.features.turning import Turning
from labels.noise import with_white_noise
from labels.variables import SHAFT_ANGLE
from physics.arrays import Array

if TYPE_CHECKING:
    import pandas

# s: about the longest record of the transfer corpus. Evidence of a weak modulation, which every healthy bearing has,
# grows with the length of what is looked at; so what is longer than anything learned from is cut, and the pieces vote.
LONGEST_WINDOW = 10.5
SHORTEST_COPY = 0.3
NOISY_COPIES = 2
RECORDS_A_TASK = 24


@dataclass(frozen=True)
class Reading:
    """How records are turned into rows.

    `bandwidth` (Hz) limits all records alike; `window` (s) is the longest piece; white noise of `noise_db` (signal over
    noise, None: none) is added in `noise_draw`. `speed_error` and `lowest_bandwidth` are for training on simulated
    records, whose speed is exact and whose rate is one: the speed told is off by up to that share, and each record is
    limited to a bandwidth drawn between that and its own; beside it as it is, all of it and a stretch from 0.3 s up are
    read with white noise at levels drawn from `copies_db`.
    """

    bandwidth: float = COMMON_BANDWIDTH
    window: float = LONGEST_WINDOW
    noise_db: float | None = None
    noise_draw: int = 0
    speed_error: float = 0.0
    lowest_bandwidth: float | None = None
    copies_db: tuple[float, float] | None = None


@dataclass(frozen=True)
class Row:
    """Values (F,) of the feature table of one axis and window, whether noise was added, why not to classify it, and
    which axis of its record it is."""

    values: Array
    noisy: bool
    reason: str
    axis: int = 0


@dataclass(frozen=True)
class RecordRows:
    """The rows of one record, why it must not be classified ("" if it may), how many glitches were drawn over in it and
    how many shocks cut."""

    rows: list[Row]
    reason: str
    glitches: int = 0
    shocks: int = 0


@dataclass(frozen=True)
class Rows:
    """Rows (N, F) of the feature table, the record (N,) of each, per record why it must not be classified, how many
    glitches and how many shocks it had (where any), which rows (N,) had noise added (None: none), and which axis (N,)
    of its record each is (None: not told, as of one)."""

    table: NDArray[Any]
    record: NDArray[np.int64]
    rejected: dict[int, str] = field(default_factory=dict)
    noisy: NDArray[np.bool_] | None = None
    glitches: dict[int, int] = field(default_factory=dict)
    shocks: dict[int, int] = field(default_factory=dict)
    axis: NDArray[np.int64] | None = None

    @property
    def axes(self) -> NDArray[np.int64]:
        """The axis (N,) of each row, 0 where it is not told."""
        return np.zeros(len(self.record), dtype=np.int64) if self.axis is None else self.axis


def read_rows(
    folder: Path, records: NDArray[np.int64], reading: Reading, workers: int = 2, count: Count = unheard
) -> Rows:
    """Rows of the `records` of a corpus, made by several processes, each with one waveform in memory; `count` hears how
    many are done."""
    tasks = [records[start : start + RECORDS_A_TASK] for start in range(0, records.size, RECORDS_A_TASK)]
    found: list[Rows] = []
    count(0, records.size)
    with closing(_results(folder, tasks, reading, workers)) as results:
        for rows in results:
            found.append(rows)
            count(sum(task.size for task in tasks[: len(found)]), records.size)
    tables = [rows.table for rows in found] or [np.empty((0, len(FEATURE_NAMES)))]
    owners = [rows.record for rows in found] or [np.empty(0, dtype=np.int64)]
    noisy = [rows.noisy for rows in found if rows.noisy is not None] or [np.empty(0, dtype=bool)]
    axes = [rows.axes for rows in found] or [np.empty(0, dtype=np.int64)]
    rejected: dict[int, str] = {}
    glitches: dict[int, int] = {}
    shocks: dict[int, int] = {}
    for rows in found:
        rejected |= rows.rejected
        glitches |= rows.glitches
        shocks |= rows.shocks
    return Rows(
        np.concatenate(tables),
        np.concatenate(owners),
        rejected,
        np.concatenate(noisy),
        glitches,
        shocks,
        np.concatenate(axes),
    )


def _results(
    folder: Path, tasks: Sequence[NDArray[np.int64]], reading: Reading, workers: int
) -> Generator[Rows, None, None]:
    """The rows of each task, in order, as they come."""
    from joblib import Parallel, delayed, parallel_config

    if workers <= 1 or len(tasks) < 2:
        return (_task(folder, task, reading) for task in tasks)
    with parallel_config(backend="loky", inner_max_num_threads=1):
        parallel = Parallel(n_jobs=workers, batch_size=1, max_nbytes=None, return_as="generator")
    results: Generator[Rows, None, None] = parallel(delayed(_task)(folder, task, reading) for task in tasks)
    return results


def _task(folder: Path, records: NDArray[np.int64], reading: Reading) -> Rows:
    with Corpus(folder) as corpus:
        labels = corpus.labels.set_index("record", drop=False)
        found = {
            record: record_rows(corpus.waveform(record), labels.loc[record], reading, _turning(corpus, record))
            for record in records.tolist()
        }
    rows = [row for own in found.values() for row in own.rows]
    owners = [record for record, own in found.items() for _ in own.rows]
    return Rows(
        np.array([row.values for row in rows]) if rows else np.empty((0, len(FEATURE_NAMES))),
        np.array(owners, dtype=np.int64),
        {record: own.reason for record, own in found.items() if own.reason},
        np.array([row.noisy for row in rows], dtype=bool),
        {record: own.glitches for record, own in found.items() if own.glitches},
        {record: own.shocks for record, own in found.items() if own.shocks},
        np.array([row.axis for row in rows], dtype=np.int64),
    )


def _turning(corpus: Corpus, record: int) -> Turning | None:
    """How the shaft of a record turns, if its speed is known to change."""
    return Turning(corpus.waveform(record, SHAFT_ANGLE.name)) if corpus.has(record, SHAFT_ANGLE.name) else None


def record_rows(
    signals: NDArray[Any], labels: pandas.Series[Any], reading: Reading, turning: Turning | None = None
) -> RecordRows:
    """Rows of one record (T, A), one an axis and window, none if it cannot be judged; `turning` where its speed
    changes."""
    kinematics, rate = known_kinematics(labels), float(labels["rate_hz"])
    reason = unfit(labels, kinematics, len(signals), rate, reading.bandwidth)
    if kinematics is None or reason:
        return RecordRows([], reason)
    rows: list[Row] = []
    reasons: list[str] = []
    glitches = shocks = 0
    turns = kinematics.shaft_hz * len(signals) / rate
    for axis, signal in enumerate(np.asarray(signals, dtype=np.float64).T):
        drawn_over = cut = 0
        if not is_dead(signal):
            signal, drawn_over = without_glitches(signal, turns)
            signal, cut = without_shocks(signal, turns)
        found = signal_rows(signal, rate, kinematics, reading, [*_seed(labels), axis], turning)
        glitches, shocks = glitches + drawn_over, shocks + cut
        rows += [replace(row, axis=axis) for row in found]
        reasons += [row.reason for row in found] or [DEAD]
    return RecordRows(rows, reasons[0] if reasons and all(reasons) else "", glitches, shocks)


def signal_rows(
    signal: Array,
    rate: float,
    kinematics: Kinematics,
    reading: Reading,
    seed: list[int],
    turning: Turning | None = None,
) -> list[Row]:
    """Rows of one axis (T,), none of pieces too short or without a signal; `seed` sets the random numbers."""
    if is_dead(signal):
        return []
    rows = []
    for copy in range(1 if reading.copies_db is None else 1 + NOISY_COPIES):
        level = 0 if reading.noise_db is None else int(1000 + round(10 * reading.noise_db))
        stream = np.random.default_rng([*seed, reading.noise_draw, level, copy])
        heard = _noisy(signal, reading, stream, copy)
        part = _stretch(heard.size, rate, stream) if copy > 1 else slice(None)
        pieces = windows(heard[part], rate, reading.window)
        angles = repeat(None) if turning is None else windows(turning.angle[part], rate, reading.window)
        for piece, angle in zip(pieces, angles, strict=False):
            given = kinematics.at(kinematics.shaft_hz * (1.0 + reading.speed_error * stream.uniform(-1.0, 1.0)))
            bandwidth = _bandwidth(rate, reading, stream)
            if piece.size < FEWEST_SAMPLES_USED or is_dead(piece[: fft.prev_fast_len(piece.size, real=True)]):
                continue
            analysis = analyse(piece, rate, given, bandwidth, None if angle is None else Turning(angle))
            rows.append(Row(feature_values(analysis), copy > 0, liveness(analysis, piece).reason))
    return rows


def windows(signal: Array, rate: float, longest: float) -> Iterator[Array]:
    """The signal (T,) in as few equal pieces as are no longer than `longest` (s)."""
    count = max(1, int(np.ceil(signal.size / rate / longest - 0.05)))
    yield from np.array_split(signal, count)


def _stretch(samples: int, rate: float, stream: np.random.Generator) -> slice:
    """A stretch of so many samples, its length log-uniform from 0.3 s to the whole, anywhere in them."""
    shortest = min(SHORTEST_COPY * rate, samples)
    size = int(np.exp(stream.uniform(np.log(shortest), np.log(samples))))
    start = int(stream.integers(0, samples - size, endpoint=True))
    return slice(start, start + size)


def _seed(labels: pandas.Series[Any]) -> list[int]:
    """Numbers that follow from the record alone, whatever is read beside it."""
    return [zlib.crc32(f"{labels['bearing_id']}/{labels['recording']}".encode()), int(labels["record"])]


def _noisy(signal: Array, reading: Reading, stream: np.random.Generator, copy: int) -> Array:
    level = reading.noise_db
    if copy and reading.copies_db is not None:
        level = stream.uniform(*reading.copies_db)
    return signal if level is None else with_white_noise(signal, level, stream)


def _bandwidth(rate: float, reading: Reading, stream: np.random.Generator) -> float:
    top = min(reading.bandwidth, rate / 2.0)
    if reading.lowest_bandwidth is None or reading.lowest_bandwidth >= top:
        return top
    return float(np.exp(stream.uniform(np.log(reading.lowest_bandwidth), np.log(top))))
