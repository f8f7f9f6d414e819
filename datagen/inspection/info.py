"""What a corpus holds and what it cost, from manifest and index; of shards only size and beginning are looked at."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from datagen.corpus import Corpus
from datagen.corpus_files.manifest import ShardEntry
from datagen.counts import counted
from datagen.files.places import from_home
from datagen.files.time_stamps import HDF5_SIGNATURE
from datagen.inspection.asked_for import asked_of
from datagen.scenarios.refused import Refused
from labels.schema import LABELS, UNKNOWN

if TYPE_CHECKING:
    import pandas

COUNTED = ("condition", "location", "rig", "bearing", "profile", "contact_law", "split", "part")
CROSSED = (("condition", "location"), ("condition", "split"), ("rig", "split"))


@dataclass(frozen=True)
class Range:
    """Smallest, middle and largest value of a label, in `unit`; `missing` counts the records it does not apply to."""

    unit: str
    smallest: float
    median: float
    largest: float
    missing: int


@dataclass(frozen=True)
class Info:
    """Facts of a corpus: records by value of each worded label, ranges of each numeric one, size and cost.

    `signal_seconds` is the summed length of the records; `made_per_second` how many of those seconds one worker made in
    a second; `record_seconds` what a record cost one worker, `record_bytes` what it takes on the disk. `crossed` counts
    records by two labels at once, `bearings_in_split` the known `bearings`, virtual ones where records are simulated;
    `of_unknown_bearing` records are of one that is not known. `outside_validity` records are to be read with care, and
    `validity` counts them by reason. `asked_by_condition` is how many of the records asked for have a condition on
    average, by the weights of the recipe; `refused` are the impossible draws.

    `missing_files` says how many records each shard held that is gone, `damaged_files` each that is cut off,
    overwritten or not to be read; all else is counted as if they were there. `origin` is simulated or imported: of
    recordings nothing was asked for, drawn or solved.
    """

    name: str
    title: str
    records: int
    asked: int
    recipe_records: int
    failed: int
    shards: int
    bytes: int
    signal_seconds: float
    worker_seconds: float
    made_per_second: float
    record_seconds: float
    record_bytes: float
    bearings: int
    of_unknown_bearing: int
    outside_validity: int
    validity: dict[str, int]
    missing_files: dict[str, int]
    damaged_files: dict[str, int]
    bearings_in_split: dict[str, int]
    counts: dict[str, dict[str, int]]
    asked_by_condition: dict[str, float]
    crossed: dict[str, dict[str, dict[str, int]]]
    refused: dict[str, Refused]
    ranges: dict[str, Range]
    identity: dict[str, str]
    made_with: dict[str, str]
    origin: str

    @property
    def bearings_text(self) -> str:
        """How many bearings are known, by split, and how many records are of others."""
        by_split = ", ".join(f"{split} {count}" for split, count in self.bearings_in_split.items())
        known = f"{self.bearings} ({by_split})" if self.bearings else UNKNOWN
        return (
            f"{known}; {counted(self.of_unknown_bearing, 'record')} of unknown ones"
            if 0 < self.of_unknown_bearing < self.records
            else known
        )

    @property
    def readable(self) -> int:
        """Number of the shards that are there and not seen to be damaged."""
        return self.shards - len(self.missing_files) - len(self.damaged_files)


def corpus_info(folder: str | Path) -> Info:
    """The facts of the corpus in `folder`; raises BadInput if there is none."""
    folder = from_home(folder)
    corpus = Corpus(folder)
    manifest, table = corpus.manifest, corpus.labels
    signal_seconds = float(table["duration_s"].sum())
    of_known = table[table["bearing_id"] != UNKNOWN]
    return Info(
        name=manifest.name,
        title=manifest.title,
        records=len(table),
        asked=manifest.asked_records,
        recipe_records=manifest.recipe_records,
        failed=len(manifest.failed),
        shards=len(manifest.shards),
        bytes=manifest.bytes,
        signal_seconds=signal_seconds,
        worker_seconds=manifest.seconds,
        made_per_second=signal_seconds / manifest.seconds if manifest.seconds else 0.0,
        record_seconds=manifest.seconds / max(len(table), 1),
        record_bytes=manifest.bytes / max(len(table), 1),
        bearings=int(of_known["bearing_id"].nunique()),
        of_unknown_bearing=len(table) - len(of_known),
        outside_validity=int((table["validity"] != "").sum()),
        validity=_by_reason(table["validity"]),
        missing_files=_records_of(shard for shard in manifest.shards if not (folder / shard.file).is_file()),
        damaged_files=_records_of(shard for shard in manifest.shards if _is_damaged(folder / shard.file, shard.bytes)),
        bearings_in_split=_counts(of_known.drop_duplicates("bearing_id")["split"]),
        asked_by_condition=asked_of(manifest, folder),
        counts={name: _counts(table[name]) for name in COUNTED},
        crossed={f"{label} x {other}": _crossed(table, label, other) for label, other in CROSSED},
        refused=manifest.refused,
        ranges=_ranges(table),
        identity=manifest.identity.to_dict(),
        made_with=manifest.made_with,
        origin=manifest.origin,
    )


def _records_of(shards: Iterable[ShardEntry]) -> dict[str, int]:
    return {shard.file: shard.records for shard in shards}


def _is_damaged(path: Path, size: int) -> bool:
    """Whether a file that is there is seen at once not to be the shard that was written, of that `size`.

    What a crash of the whole computer leaves may have the size of a shard and hold nothing but zeros.
    """
    if not path.is_file():
        return False
    try:
        with path.open("rb") as file:
            return path.stat().st_size != size or file.read(len(HDF5_SIGNATURE)) != HDF5_SIGNATURE
    except OSError:
        return True


def _counts(column: pandas.Series) -> dict[str, int]:
    return {str(value): int(count) for value, count in column.value_counts().items()}


def _crossed(table: pandas.DataFrame, label: str, other: str) -> dict[str, dict[str, int]]:
    return {str(value): _counts(part[other]) for value, part in table.groupby(label)}


def _ranges(table: pandas.DataFrame) -> dict[str, Range]:
    ranges = {}
    for label in LABELS:
        for name in label.columns:
            known = table[name].dropna()
            if label.dtype not in ("float64", "int64") or known.empty:
                continue
            ranges[name] = Range(
                label.unit, float(known.min()), float(known.median()), float(known.max()), len(table) - len(known)
            )
    return ranges


def _by_reason(validity: Iterable[str]) -> dict[str, int]:
    """Records by reason; the numbers in a reason differ from record to record and are left out."""
    counts = Counter(reason for text in validity for reason in {_without_numbers(part) for part in text.split("; ")})
    del counts[""]
    return dict(counts.most_common())


def _without_numbers(reason: str) -> str:
    return re.sub(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "…", reason)
