"""The records of a corpus as a size estimator sees them, with the truth to score it by where there is one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.corpus_files.index import no_records, read_index
from datagen.corpus_files.open_shards import OpenShards
from datagen.errors import BadInput
from datagen.sizing.stated_situation import reason_against, situation_of, speed_found, wrong_speed
from datagen.sizing.stored_record import StoredRecord, stored_record
from labels.features.mending import mended
from labels.spall_size.event_truth import EventTruth
from labels.spall_size.situation import Situation
from physics.angular_speed import RPM, in_hertz
from physics.arrays import Array

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class SizedRecord:
    """One record: `acceleration` and the `clean` one (T, axes) in m/s², labels, and what may be known of the machine.

    `clean` is None if it was not stored, `truth` None for recordings whose ball passes are unknown. `speed_changes` is
    True for recordings that say how unevenly the shaft turned.
    """

    record: int
    rate: float
    acceleration: Array
    clean: Array | None
    labels: dict[str, Any]
    situation: Situation
    truth: EventTruth | None
    speed_changes: bool = False


@dataclass(frozen=True)
class UnsizedRecord:
    """The labels of a record that cannot be sized, and the reason in words."""

    labels: dict[str, Any]
    reason: str


def sized_records(
    folder: Path, splits: tuple[str, ...] | None = None, only: Collection[int] | None = None
) -> Iterator[SizedRecord]:
    """The records of a corpus that can be sized, or `only` those of these indices, shard by shard, one in memory at a
    time.

    The stated shaft speed of simulated records is wrong by up to ±2 %, so that no estimator may rely on it. That of
    recordings is used as it is, or refined from the signal if it is only nominal. Load and Hertz factor are given where
    both are known.
    """
    table = _rows(folder, splits)
    able = [not reason_against(labels) for labels in table.to_dict("records")]
    chosen = table[np.array(able, dtype=np.bool_) & (table["record"].isin(only) if only is not None else True)]
    for shard, rows in chosen.groupby("shard", sort=True):
        with closing(OpenShards(folder)) as shards:  # none is read again, and each open one takes megabytes
            for labels in rows.to_dict("records"):
                with shards.reading(str(shard)) as file:
                    stored = stored_record(file, int(labels["position"]), int(labels["record"]))
                yield _sized(stored, {str(key): value for key, value in labels.items()})


def without_load(records: Iterable[SizedRecord]) -> Iterator[SizedRecord]:
    """The records as an estimator sees them that is given neither load nor Hertz factor."""
    return (replace(record, situation=record.situation.without_load()) for record in records)


def unsized_records(folder: Path, splits: tuple[str, ...] | None) -> list[UnsizedRecord]:
    """The records of a corpus that cannot be sized, in order; BadInput if all are like that, or there are none."""
    rows = [{str(key): value for key, value in row.items()} for row in _rows(folder, splits).to_dict("records")]
    if not rows:
        raise no_records(folder)
    reasons = [reason_against(labels) for labels in rows]
    if not all(reasons):
        return [UnsizedRecord(labels, reason) for labels, reason in zip(rows, reasons, strict=True) if reason]
    counts = ", ".join(f"{count} ({reason})" for reason, count in Counter(reasons).most_common())
    raise BadInput(f"none of its {len(rows)} records can be sized: {counts}", file=str(folder))


def count_records(folder: Path, splits: tuple[str, ...] | None) -> int:
    """How many records there are, whether they can be sized or not."""
    return len(_rows(folder, splits))


def _rows(folder: Path, splits: tuple[str, ...] | None) -> pandas.DataFrame:
    table = read_index(folder)
    return table if splits is None else table[table["split"].isin(splits)]


def _sized(stored: StoredRecord, labels: dict[str, Any]) -> SizedRecord:
    record = int(labels["record"])
    acceleration = stored.acceleration if stored.simulated else _mended(stored.acceleration, labels)
    factor = wrong_speed(record) if stored.simulated else speed_found(labels, acceleration)
    return SizedRecord(
        record=record,
        rate=float(labels["rate_hz"]),
        acceleration=acceleration,
        clean=stored.clean,
        labels=labels,
        situation=replace(
            situation_of(labels, stored.contact_stiffness(), factor),
            polarity_known=stored.simulated,  # no recording says which way its sensor looked
        ),
        truth=stored.truth(labels),
        speed_changes=stored.speed_changes,
    )


def _mended(acceleration: Array, labels: Mapping[str, Any]) -> Array:
    """The acceleration (T, axes) of a recording without jumps and drift of its sensors' bias, glitches and shocks."""
    turns = in_hertz(float(labels["speed_rpm"]) * RPM) * len(acceleration) / float(labels["rate_hz"])
    return np.column_stack([mended(signal, turns).signal for signal in acceleration.T])
