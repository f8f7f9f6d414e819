"""The records of a corpus as a size estimator sees them, with the truth to score it by where there is one."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from datagen.corpora.index import read_index
from datagen.corpora.open_shards import OpenShards
from datagen.errors import BadInput
from datagen.sizing.stated_situation import reason_against, situation_of, wrong_speed
from labels.spall_size.event_truth import EventTruth, event_truth
from labels.spall_size.situation import Situation

if TYPE_CHECKING:
    import pandas

Array = NDArray[np.float64]
PASS_COLUMNS = ("exit_time", "release_time", "regain_time", "fall_time", "rise_time")
LATEST_REGAIN_SPACINGS = 0.5  # behind the exit


@dataclass(frozen=True)
class SizedRecord:
    """One record: `acceleration` (T, axes), the clean one or None, its labels, what may be told of the machine, truth.

    `truth` is None for recordings whose ball passes are unknown.
    """

    record: int
    rate: float
    acceleration: Array
    clean: Array | None
    labels: dict[str, Any]
    situation: Situation
    truth: EventTruth | None


@dataclass(frozen=True)
class UnsizedRecord:
    """The labels of a record that cannot be sized, and the reason in words."""

    labels: dict[str, Any]
    reason: str


def sized_records(
    folder: Path,
    *,
    load_known: bool,
    splits: tuple[str, ...] | None = None,
    seed: int = 0,
    only: Collection[int] | None = None,
) -> Iterator[SizedRecord]:
    """The records of a corpus that can be sized, or `only` those of these indices, in order, one in memory at a time.

    The stated shaft speed of simulated records is wrong by up to ±2 %, drawn from `seed`, so that no estimator may lean
    on it; that of recordings is as wrong as it is.
    """
    table = _rows(folder, splits)
    able = [not reason_against(labels) for labels in table.to_dict("records")]
    chosen = table[np.array(able, dtype=np.bool_) & (table["record"].isin(only) if only is not None else True)]
    with closing(OpenShards(folder)) as shards:
        for shard, rows in chosen.groupby("shard", sort=True):
            for labels in rows.to_dict("records"):
                with shards.reading(str(shard)) as file:
                    stored = _read(file, int(labels["position"]), int(labels["record"]))
                yield _sized(stored, {str(key): value for key, value in labels.items()}, load_known, seed)


def unsized_records(folder: Path, splits: tuple[str, ...] | None = None) -> list[UnsizedRecord]:
    """The records of a corpus that cannot be sized, in order; BadInput if all are like that."""
    rows = [{str(key): value for key, value in row.items()} for row in _rows(folder, splits).to_dict("records")]
    reasons = [reason_against(labels) for labels in rows]
    if not all(reasons):
        return [UnsizedRecord(labels, reason) for labels, reason in zip(rows, reasons, strict=True) if reason]
    counts = ", ".join(f"{count} ({reason})" for reason, count in Counter(reasons).most_common())
    raise BadInput(f"none of its {len(rows)} records can be sized: {counts}", str(folder))


def _rows(folder: Path, splits: tuple[str, ...] | None) -> pandas.DataFrame:
    table = read_index(folder)
    return table if splits is None else table[table["split"].isin(splits)]


class _Stored(NamedTuple):
    """What a shard holds of a record: `acceleration` and the `clean` one (T, axes), whether it is `simulated`, the JSON
    `text` that says how it came about ("" if there is none), and PASS_COLUMNS of its ball passes, if any are known."""

    acceleration: Array
    clean: Array | None
    simulated: bool
    text: str
    passes: list[Array] | None


def _read(file: Any, position: int, record: int) -> _Stored:
    clean, simulated = file.variables.get("acceleration_clean"), "scenario" in file.variables
    text = file.variables.get("scenario" if simulated else "provenance")
    passes = None
    if set(PASS_COLUMNS) <= set(file.variables):
        own = np.flatnonzero(np.asarray(file.variables["pass_record"][:]) == record)
        passes = [np.asarray(file.variables[name][:], dtype=np.float64)[own] for name in PASS_COLUMNS]
    return _Stored(
        acceleration=np.asarray(file.variables["acceleration"][position], dtype=np.float64),
        clean=None if clean is None else np.asarray(clean[position], dtype=np.float64),
        simulated=simulated,
        text="" if text is None else str(text[position]),
        passes=passes,
    )


def _sized(stored: _Stored, labels: dict[str, Any], load_known: bool, seed: int) -> SizedRecord:
    record, contact = int(labels["record"]), _stiffness(stored.text) if load_known else None
    return SizedRecord(
        record=record,
        rate=float(labels["rate_hz"]),
        acceleration=stored.acceleration,
        clean=stored.clean,
        labels=labels,
        situation=replace(
            situation_of(labels, contact, wrong_speed(seed, record) if stored.simulated else 1.0),
            polarity_known=stored.simulated,  # where a sensor looked is not told with a recording
        ),
        truth=None if stored.passes is None else _truth(stored.passes, labels),
    )


def _stiffness(text: str) -> tuple[float, float] | None:
    """Hertz factor and exponent from the scenario or the provenance; None if it does not tell them."""
    try:
        parameters = json.loads(text)["parameters"]
        return float(parameters["K"]), float(parameters["n"])
    except (KeyError, TypeError, ValueError):
        return None


def nominal_period(labels: Mapping[str, Any]) -> float:
    """Time between two ball passes without slip, s; of the outer race if there is no spall."""
    order = {"outer": "bpfo", "inner": "bpfi"}.get(str(labels["location"]), "bpfo")
    return 60.0 / (float(labels["speed_rpm"]) * float(labels[order]))


def _truth(passes: list[Array], labels: Mapping[str, Any]) -> EventTruth:
    leave, release, regain, fall, rise = passes
    return event_truth(release, regain, fall, rise, leave + LATEST_REGAIN_SPACINGS * nominal_period(labels))
