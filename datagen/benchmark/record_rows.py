"""Rows of the feature table of one record: one for each of its axes and windows."""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import repeat
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from datagen.benchmark.fitness import unfit
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.rows import Rows
from datagen.judging.known import known_kinematics
from labels.band_tree import band_edges, usable_bandwidth
from labels.classifier.liveness import DEAD, liveness, recorder_step
from labels.dead_sensor import is_dead
from labels.features.analysis import analyse
from labels.features.conditioning import FEWEST_SAMPLES_USED
from labels.features.kinematics import Kinematics
from labels.features.known_lines import races_in_mains, races_in_shaft
from labels.features.mending import mended
from labels.features.table import FEATURE_NAMES, feature_values
from labels.features.turning import Turning
from physics.angular_speed import RPM_PER_HZ
from physics.arrays import Array

if TYPE_CHECKING:
    import pandas


# A speed found beyond this share of the distance that is searched beside the stated one is far from it: so it is on one
# machine in 200, simulated or recorded, whose stated speed is right.
EDGE = 0.8


@dataclass(frozen=True)
class Row:
    """One row: `values` (F,) of the feature table, of one `window` of one `axis` of a record, both counted from 0.

    It is `noisy` if noise was added for training. `reason` says why its window must not be classified, "" if it may be.
    `shaft_hz` is the frequency of the shaft that was found in it.
    """

    values: Array
    noisy: bool
    reason: str
    axis: int = 0
    shaft_hz: float = math.nan
    window: int = 0


@dataclass(frozen=True)
class RecordFacts:
    """What reading one record showed, beside its rows.

    `reason` says why it must not be classified, "" if it may be. So many `jumps` were levelled in it, `glitches`
    replaced and `shocks` cut; `in_mains` and `in_shaft` are the races whose faults hide among multiples of the mains
    and of the shaft's speed, and so many `bands` were searched for modulation. `found_rpm` is the speed of the shaft
    that was found, rpm: the median over the rows without added noise, None without any. It is `far_from_stated` if it
    lies at the edge of what is searched beside the stated speed.
    """

    reason: str = ""
    jumps: int = 0
    glitches: int = 0
    shocks: int = 0
    in_mains: tuple[str, ...] = ()
    in_shaft: tuple[str, ...] = ()
    bands: int = 0
    found_rpm: float | None = None
    far_from_stated: bool = False

    def shown(self) -> dict[str, Any]:
        """What tables and reports show of it, by the names of their columns."""
        return {
            "levelled": self.jumps,
            "despiked": self.glitches,
            "shocks_cut": self.shocks,
            "in_mains": " ".join(self.in_mains),
            "in_shaft": " ".join(self.in_shaft),
            "bands": self.bands,
        }


@dataclass(frozen=True)
class RecordRows:
    """The rows of one record, none if it cannot be judged, and the `facts` about it."""

    rows: list[Row]
    facts: RecordFacts


def feature_rows(found: Sequence[Row], record: int) -> Rows:
    """The rows that were `found` in a `record`, as a table; it may have none."""
    return Rows(
        np.array([row.values for row in found], dtype=np.float64).reshape(-1, len(FEATURE_NAMES)),
        np.full(len(found), record, dtype=np.int64),
        np.array([row.axis for row in found], dtype=np.int64),
        np.array([row.noisy for row in found], dtype=bool),
    )


def record_rows(
    signals: NDArray[Any], labels: pandas.Series[Any], reading: Reading, turning: Turning | None = None
) -> RecordRows:
    """Rows of one record, `signals` (T, A) in m/s², one for each axis and window; none if it cannot be judged.

    `turning` says how the speed of its shaft changes, if it does.
    """
    kinematics, rate = known_kinematics(labels), float(labels["rate_hz"])
    reason = unfit(labels, kinematics, len(signals), rate, reading.bandwidth)
    if kinematics is None or reason:
        return RecordRows([], RecordFacts(reason))
    rows: list[Row] = []
    reasons: list[str] = []
    jumps = glitches = shocks = 0
    turns = kinematics.shaft_hz * len(signals) / rate
    for axis, signal in enumerate(np.asarray(signals, dtype=np.float64).T):
        whole = mended(signal, turns)
        seed = [*_seed(labels), axis]
        found = signal_rows(whole.signal, rate, kinematics, reading, seed, turning, recorder_step(signal))
        jumps, glitches, shocks = jumps + whole.jumps, glitches + whole.glitches, shocks + whole.shocks
        rows += [replace(row, axis=axis) for row in found]
        reasons += [row.reason for row in found] or [DEAD]
    step = piece_count(len(signals), rate, reading.window) * rate / len(signals)
    found_rpm = _found_rpm(rows)
    turned = kinematics if found_rpm is None else kinematics.at(found_rpm / RPM_PER_HZ)
    # Over the angle of a shaft that changes its speed, mains is no line and nothing is left out for it.
    in_mains = races_in_mains(turned, step) if turning is None else ()
    facts = RecordFacts(
        reason=reasons[0] if reasons and all(reasons) else "",
        jumps=jumps,
        glitches=glitches,
        shocks=shocks,
        in_mains=in_mains,
        in_shaft=races_in_shaft(kinematics, step),
        bands=_band_count(kinematics, usable_bandwidth(rate, reading.bandwidth)) if rows else 0,
        found_rpm=found_rpm,
        far_from_stated=found_rpm is not None and _is_far(found_rpm, kinematics),
    )
    return RecordRows(rows, facts)


def _band_count(kinematics: Kinematics, bandwidth: float) -> int:
    """How many bands of the `bandwidth` (Hz) hold enough harmonics of the ball passes to be searched; all of it is one
    of them in any case."""
    return len(band_edges(bandwidth, kinematics.narrowest_band_hz))


def _found_rpm(rows: Sequence[Row]) -> float | None:
    found = [row.shaft_hz for row in rows if not row.noisy]
    return RPM_PER_HZ * float(np.median(found)) if found else None


def _is_far(found_rpm: float, kinematics: Kinematics) -> bool:
    off = found_rpm / (RPM_PER_HZ * kinematics.shaft_hz) - 1.0
    return abs(off) > EDGE * kinematics.speed_within


def signal_rows(
    signal: Array,
    rate: float,
    kinematics: Kinematics,
    reading: Reading,
    seed: list[int],
    turning: Turning | None = None,
    step: float | None = None,
) -> list[Row]:
    """Rows of the `signal` (T,) of one axis at `rate` (Hz), none for pieces that are too short or without a signal.

    `seed` decides the random numbers; `step` (m/s²) is that of the recorder if the signal has been mended.
    """
    if is_dead(signal):
        return []
    rows = []
    for copy in range(reading.copies):
        stream = reading.stream(seed, copy)
        heard = reading.with_noise(signal, copy, stream)
        # Added noise has no steps.
        heard_step = step if step is not None and heard is signal else recorder_step(heard)
        part = reading.stretch(heard.size, rate, copy, stream)
        pieces = equal_pieces(heard[part], rate, reading.window)
        angles = repeat(None) if turning is None else equal_pieces(turning.angle[part], rate, reading.window)
        for window, (piece, angle) in enumerate(zip(pieces, angles, strict=False)):
            given = kinematics.at(kinematics.shaft_hz * reading.speed_factor(stream))
            bandwidth = reading.drawn_bandwidth(rate, stream)
            if piece.size < FEWEST_SAMPLES_USED or is_dead(piece[: fft.prev_fast_len(piece.size, real=True)]):
                continue
            analysis = analyse(piece, rate, given, bandwidth, None if angle is None else Turning(angle))
            values, reason = feature_values(analysis), liveness(analysis, piece, heard_step).reason
            rows.append(Row(values, copy > 0, reason, shaft_hz=analysis.speed.shaft_hz, window=window))
    return rows


def equal_pieces(signal: Array, rate: float, longest: float) -> Iterator[Array]:
    """The signal (T,) in as few equal pieces as are no longer than `longest` (s)."""
    yield from np.array_split(signal, piece_count(signal.size, rate, longest))


def piece_count(samples: int, rate: float, longest: float) -> int:
    """Into how many equal pieces `samples` at `rate` (Hz) are cut so that none is longer than `longest` (s), or hardly
    longer."""
    return max(1, int(np.ceil(samples / rate / longest - 0.05)))


def _seed(labels: pandas.Series[Any]) -> list[int]:
    """A seed that depends on the record alone, whatever else is read."""
    return [zlib.crc32(f"{labels['bearing_id']}/{labels['recording']}".encode()), int(labels["record"])]
