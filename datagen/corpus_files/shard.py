"""One shard: a netCDF file of records and, written after it, the small JSON beside it that says it is finished."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from datagen.corpus_files.format import Identity, content_hash, format_hash
from datagen.corpus_files.json_values import UNREADABLE, amount, row, text, whole
from datagen.files.atomic import sweep_temporaries, write_atomically
from datagen.files.netcdf import netcdf_bytes
from datagen.files.places import SHARDS
from datagen.scenarios.refused import Refused
from labels.schema import LABELS

if TYPE_CHECKING:
    import xarray

LABEL_COLUMNS = tuple(column for label in LABELS for column in label.columns)


@dataclass(frozen=True)
class Failure:
    """A record that could not be made: `reason` is one sentence; of a fault in the program, its traceback."""

    record: int
    reason: str


@dataclass(frozen=True)
class Sidecar:
    """What is known of a finished shard without opening it; a shard counts only once its sidecar is there.

    `sha256` is of the file's bytes, `content` of its decoded arrays; `seconds` is what making it took.
    `labels` holds a list per column of the labels' flat table, in the order of `records`; None stands for NaN.
    `refused` counts the impossible draws of its records by parameter; those of a machine count with its first record.
    A shard whose every record failed has no file: `bytes` is 0 and both hashes are empty.
    """

    shard: int
    identity: Identity
    records: tuple[int, ...] = ()
    failed: tuple[Failure, ...] = ()
    bytes: int = 0
    sha256: str = ""
    content: str = ""
    seconds: float = 0.0
    labels: dict[str, list[Any]] = field(default_factory=dict)
    refused: dict[str, Refused] = field(default_factory=dict)

    @property
    def settled(self) -> frozenset[int]:
        """Records that need no further work: made, or known to be impossible."""
        return frozenset(self.records) | {failure.record for failure in self.failed}


def shards_folder(folder: Path) -> Path:
    """Where the shards of the corpus `folder` lie."""
    return folder / SHARDS


def shard_path(folder: Path, shard: int) -> Path:
    """Where the file of a shard lies in the corpus `folder`."""
    return shards_folder(folder) / f"shard_{shard:06d}.nc"


def shard_name(shard: int) -> str:
    """What the file of a shard is called in index and manifest: its path in the corpus."""
    return shard_path(Path(), shard).as_posix()


def sidecar_path(folder: Path, shard: int) -> Path:
    """Where the JSON beside the file of a shard lies."""
    return shard_path(folder, shard).with_suffix(".json")


def write_shard(folder: Path, sidecar: Sidecar, dataset: xarray.Dataset | None, compression: str) -> Sidecar:
    """Write the file of a shard whole or not at all, then its sidecar; returns that with what it says of the file.

    `sidecar` says what is known before the file is: number, identity, failures, cost and redraws. `dataset` holds the
    records, None if every one failed; then there is no file. Raises OSError on a full disk.
    """
    if dataset is not None:
        content = memoryview(netcdf_bytes(dataset, compression))
        sidecar = replace(
            sidecar,
            records=tuple(int(record) for record in dataset["record"].values),
            bytes=content.nbytes,
            sha256=hashlib.sha256(content).hexdigest(),
            content=content_hash(dataset),
            labels=label_columns(dataset),
        )
        write_atomically(shard_path(folder, sidecar.shard), content)
    path = sidecar_path(folder, sidecar.shard)
    write_atomically(path, json.dumps(sidecar, default=vars, allow_nan=False).encode())
    return sidecar


def label_columns(dataset: xarray.Dataset) -> dict[str, list[Any]]:
    """The labels of a shard's `dataset` as a flat table: a list of plain values per column, None where unknown."""
    columns: dict[str, list[Any]] = {}
    for label in LABELS:
        if label.name not in dataset.variables:
            columns |= {column: [None] * dataset.sizes["record"] for column in label.columns}
            continue
        values = dataset[label.name].values
        for place, column in enumerate(label.columns):
            chosen = (values[:, place] if label.components else values).tolist()
            columns[column] = [None if value != value else value for value in chosen]
    return columns


def read_sidecar(path: Path) -> Sidecar | None:
    """The sidecar at `path`, or None if it is absent or not one."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        identity, records = row(Identity, found["identity"]), tuple(whole(record) for record in found["records"])
        return Sidecar(
            shard=whole(found["shard"]),
            identity=identity,
            records=records,
            failed=tuple(row(Failure, failure) for failure in found["failed"]),
            bytes=whole(found["bytes"]),
            sha256=text(found["sha256"]),
            content=text(found["content"]),
            seconds=amount(found["seconds"]),
            labels=_labels(found["labels"], identity, len(records)),
            refused={str(what): row(Refused, counted) for what, counted in found["refused"].items()},
        )
    except UNREADABLE:
        return None


def _labels(found: dict[str, Any], identity: Identity, records: int) -> dict[str, list[Any]]:
    """The columns of labels, each of as many `records`; what reading JSON raises for any other."""
    columns = {str(name): list(column) for name, column in found.items()}
    if any(len(column) != records for column in columns.values()):
        raise ValueError("columns of another length")
    # The labels of another version of the format are others.
    if records and identity.format_hash == format_hash() and columns.keys() != {*LABEL_COLUMNS}:
        raise ValueError("other labels")
    return columns


def is_whole(folder: Path, sidecar: Sidecar) -> bool:
    """True if the shard's file is there with the size its sidecar states (`spallgen check` reads it all)."""
    if not sidecar.records:
        return True
    path = shard_path(folder, sidecar.shard)
    return path.is_file() and path.stat().st_size == sidecar.bytes


def by_number(paths: Iterable[Path]) -> list[Path]:
    """Sidecars in the order of their shards: their names have six digits, and more from shard 1 000 000 on."""
    return sorted(paths, key=lambda path: (len(path.name), path.name))


def finished_shards(folder: Path) -> Iterator[Sidecar]:
    """Every finished shard of the corpus `folder`, by number: those with a valid sidecar and a file of the right size.

    Copies of a sidecar under another name do not count.
    """
    return (sidecar for sidecar in sidecars(folder) if is_whole(folder, sidecar))


def sidecars(folder: Path) -> Iterator[Sidecar]:
    """Every valid sidecar of the corpus `folder`, by number, whatever has become of its file."""
    for path in by_number(shards_folder(folder).glob("shard_*.json")):
        sidecar = read_sidecar(path)
        if sidecar is not None and path == sidecar_path(folder, sidecar.shard):
            yield sidecar


def sweep_unfinished(folder: Path) -> None:
    """Delete what killed writers left in the corpus `folder`: temporary files, and shard files without a sidecar.

    Call it with the folder locked and no writer at work in it.
    """
    for place in (folder, shards_folder(folder)):
        sweep_temporaries(place)
    for path in shards_folder(folder).glob("shard_*.nc"):
        if not path.with_suffix(".json").exists():
            path.unlink(missing_ok=True)


def has_finished_shards(folder: Path) -> bool:
    """True if the corpus `folder` holds a finished shard."""
    return next(finished_shards(folder), None) is not None
