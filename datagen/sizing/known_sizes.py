"""Records whose spall was measured, and how they correct the other records of their machine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from datagen.corpus_files.index import read_index
from datagen.errors import BadInput
from datagen.files.number_texts import number, whole_number
from datagen.sizing.estimators import AnyEstimator
from datagen.sizing.record_errors import arc_error, extent_error
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.sized_records import SizedRecord
from datagen.sizing.stated_situation import reason_against
from labels.schema import UNKNOWN
from labels.spall_size.known_size import known_size_factor

FIELD = "--known-size"
ALLOWED = "RECORD=MM, the index of a record and the length of its spall in mm, above 0"


@dataclass(frozen=True)
class KnownSize:
    """The spall of `record` on `machine` is `known_mm` long and was estimated as `estimated_mm`.

    So the sizes of `corrected` other records of that machine were multiplied by `factor`, which all known sizes of a
    machine share. `arc_error_without` and `arc_error_with` are the mean |error| / true of those records without and
    with it, NaN if the truth is unknown.
    """

    record: int
    machine: str
    known_mm: float
    estimated_mm: float
    factor: float
    corrected: int = 0
    arc_error_without: float = math.nan
    arc_error_with: float = math.nan


def parse_known_sizes(texts: Iterable[str]) -> dict[int, float]:
    """Lengths (mm) by record from texts like "3=1.5"; raises BadInput for any other text and for a record with two."""
    sizes: dict[int, float] = {}
    for text in texts:
        index, _, length = text.partition("=")
        try:
            record, millimetres = whole_number(index), number(length)
        except ValueError:
            record, millimetres = -1, math.nan
        if record < 0 or not (math.isfinite(millimetres) and millimetres > 0.0):
            raise BadInput(field=FIELD, value=text, allowed=ALLOWED)
        if record in sizes:
            raise BadInput("this record has a size already", field=FIELD, value=text, allowed="one size a record")
        sizes[record] = millimetres
    return sizes


def machine_of(bearing_id: str, rig: str) -> str:
    """What the records of one machine have in common: the name of the bearing, or else of the rig; empty if neither is
    known."""
    return next((name for name in (bearing_id, rig) if name not in ("", UNKNOWN)), "")


def machine_by_labels(labels: Mapping[str, Any]) -> str:
    """`machine_of` the record with these labels."""
    return machine_of(str(labels["bearing_id"]), str(labels["rig"]))


def known_sizes(
    folder: Path, sizes: Mapping[int, float], records: Iterable[SizedRecord], estimator: AnyEstimator
) -> list[KnownSize]:
    """What each of the `records` says about its machine, the length (mm) of whose spall is known; `sizes` are these by
    record.

    Raises BadInput if one is not in the corpus, gets no estimate, or is of an unknown machine.
    """
    _check(folder, sizes)
    return shared_factors([_known_size(folder, sized, sizes[sized.record], estimator) for sized in records])


def _check(folder: Path, sizes: Mapping[int, float]) -> None:
    if not sizes:
        return
    table = read_index(folder)
    chosen = table[table["record"].isin(sizes)].to_dict("records")
    rows = {int(row["record"]): {str(name): value for name, value in row.items()} for row in chosen}
    for record in sizes:
        if record not in rows:
            allowed = f"{table['record'].min()} to {table['record'].max()}"
            raise BadInput(
                "not in this corpus", file=str(folder), field=f"{FIELD}: record", value=record, allowed=allowed
            )
        if reason := reason_against(rows[record]):
            raise BadInput(f"it gets no estimate: {reason}", file=str(folder), field=f"{FIELD}: record", value=record)
        if not machine_by_labels(rows[record]):
            allowed = "a record whose bearing_id or rig is known"
            raise BadInput(
                "its machine is not known", file=str(folder), field=f"{FIELD}: record", value=record, allowed=allowed
            )


def _known_size(folder: Path, sized: SizedRecord, known_mm: float, estimator: AnyEstimator) -> KnownSize:
    estimate = estimator.estimate(sized.acceleration, sized.rate, sized.situation)
    if not estimate.found:
        raise BadInput(
            f"it gets no estimate: {estimate.reason}", file=str(folder), field=f"{FIELD}: record", value=sized.record
        )
    factor = known_size_factor(estimate.extent_mm, known_mm)
    return KnownSize(sized.record, machine_by_labels(sized.labels), known_mm, estimate.extent_mm, factor)


def shared_factors(known: list[KnownSize]) -> list[KnownSize]:
    """The same with one factor per machine: the geometric mean of those of its known sizes."""
    logarithms: dict[str, list[float]] = {}
    for size in known:
        logarithms.setdefault(size.machine, []).append(math.log(size.factor))
    return [replace(size, factor=math.exp(float(np.mean(logarithms[size.machine])))) for size in known]


def factor_for(known: list[KnownSize], record: int, machine: str) -> float:
    """The factor on the size of a record: 1 if its own size is known, or that of no other record of its machine is."""
    if any(size.record == record for size in known):
        return 1.0
    return next((size.factor for size in known if size.machine == machine), 1.0)


def with_effect(known: list[KnownSize], records: list[ScoredRecord]) -> list[KnownSize]:
    """The known sizes with how many of the scored `records` they corrected, and what that did to their errors."""
    of_known_size = {size.record for size in known}
    others = [record for record in records if record.found and record.truth.record not in of_known_size]
    return [_with_effect(size, [record for record in others if _is_of(record, size.machine)]) for size in known]


def _is_of(record: ScoredRecord, machine: str) -> bool:
    return machine_of(record.truth.bearing_id, record.truth.rig) == machine


def _with_effect(size: KnownSize, corrected: list[ScoredRecord]) -> KnownSize:
    scored = [record for record in corrected if record.truth.known and record.scorable]
    if not scored:
        return replace(size, corrected=len(corrected))
    without = [arc_error(record, record.answer.own_extent) for record in scored]
    given = [extent_error(record) for record in scored]
    means = float(np.mean(without)), float(np.mean(given))
    return replace(size, corrected=len(corrected), arc_error_without=means[0], arc_error_with=means[1])
