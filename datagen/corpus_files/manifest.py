"""The manifest of a corpus: the recipe it was made from, by what, and the shards it consists of."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from datagen.corpus_files.format import FORMAT, IMPORTED, SIMULATED, Identity
from datagen.corpus_files.json_values import UNREADABLE, amount, row, text, whole
from datagen.corpus_files.shard import Failure, Sidecar, has_finished_shards, shard_name
from datagen.errors import BadInput
from datagen.files.atomic import write_atomically
from datagen.files.places import MANIFEST
from datagen.scenarios.refused import Refused, add_refused

Span = tuple[int, int]
ANEW = (
    "`spallgen generate` with its recipe and --out {folder}, by the version that made it, writes it anew from what "
    "lies beside its shards (a corpus of recordings: import it again)"
)


class DamagedManifest(BadInput):
    """A manifest file that can be opened but not understood: cut short, or edited by somebody."""


@dataclass(frozen=True)
class ShardEntry:
    """One finished shard: `file` relative to the corpus, how many records it holds and from which to which."""

    file: str
    records: int
    first: int
    last: int
    bytes: int
    sha256: str
    content: str


@dataclass(frozen=True)
class Manifest:
    """What a corpus is.

    `recipe` is the whole recipe as data, or the SPEC of imported recordings with its files; `origin` says which
    ("simulated", "imported"). `asked` are the spans [start, stop) of records that any run was asked for. `shards`,
    `failed`, `bytes`, `seconds` (of work, summed over workers) and `refused` (impossible draws, by parameter) are what
    the sidecars of the shards say.
    """

    name: str
    identity: Identity
    recipe: dict[str, Any]
    recipe_records: int
    asked: tuple[Span, ...]
    made_with: dict[str, str] = field(default_factory=dict)
    shards: tuple[ShardEntry, ...] = ()
    failed: tuple[Failure, ...] = ()
    bytes: int = 0
    seconds: float = 0.0
    refused: dict[str, Refused] = field(default_factory=dict)
    origin: str = SIMULATED

    @property
    def imported(self) -> bool:
        """True if its records are recordings of real machines."""
        return self.origin == IMPORTED

    @property
    def title(self) -> str:
        """One line for people, "" if there is none."""
        return str(self.written.get("title") or "")

    @property
    def written(self) -> dict[str, Any]:
        """What somebody wrote to have it made: the recipe, or the SPEC of recordings without their files."""
        written: dict[str, Any] = self.recipe["spec"] if self.imported else self.recipe
        return written

    @property
    def records(self) -> int:
        """Number of finished records."""
        return sum(shard.records for shard in self.shards)

    @property
    def asked_records(self) -> int:
        """Number of records asked for."""
        return sum(stop - start for start, stop in self.asked)

    @property
    def every_asked(self) -> frozenset[int]:
        """The index of every record asked for."""
        return frozenset(record for start, stop in self.asked for record in range(start, stop))

    def with_shards(self, sidecars: Iterable[Sidecar]) -> Manifest:
        """The manifest with what the sidecars of the finished shards say."""
        found = list(sidecars)
        return replace(
            self,
            shards=tuple(shard_entry(sidecar) for sidecar in found if sidecar.records),
            failed=tuple(failure for sidecar in found for failure in sidecar.failed),
            bytes=sum(sidecar.bytes for sidecar in found),
            seconds=round(sum(sidecar.seconds for sidecar in found), 3),
            refused=add_refused(sidecar.refused for sidecar in found),
        )


def manifest_path(folder: Path) -> Path:
    """Where the manifest of the corpus `folder` lies."""
    return folder / MANIFEST


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Put the manifest into the corpus `folder`, whole or not at all."""
    content = {"format": FORMAT, "records": manifest.records, **asdict(manifest)}
    write_atomically(manifest_path(folder), json.dumps(content, indent=1, allow_nan=False).encode())


def read_manifest(folder: Path) -> Manifest:
    """The manifest of the corpus `folder`; raises BadInput if there is none or it cannot be opened, DamagedManifest if
    it is damaged."""
    path = manifest_path(folder)
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        manifest = Manifest(
            name=text(found["name"]),
            identity=row(Identity, found["identity"]),
            recipe=_recipe(found["recipe"], text(found["origin"])),
            recipe_records=whole(found["recipe_records"]),
            asked=_spans(found["asked"], whole(found["recipe_records"])),
            made_with={text(what): text(version) for what, version in found["made_with"].items()},
            shards=tuple(row(ShardEntry, shard) for shard in found["shards"]),
            failed=tuple(row(Failure, failure) for failure in found["failed"]),
            bytes=whole(found["bytes"]),
            seconds=amount(found["seconds"]),
            refused={text(what): row(Refused, counted) for what, counted in found["refused"].items()},
            origin=text(found["origin"]),
        )
        if found["format"] != FORMAT:
            raise ValueError("another format")
        return manifest
    except (FileNotFoundError, NotADirectoryError):
        raise no_corpus(folder, path.name) from None
    except UNREADABLE as problem:
        kind = BadInput if isinstance(problem, OSError) else DamagedManifest
        remedy = f"; {ANEW.format(folder=folder)}" if kind is DamagedManifest and has_finished_shards(folder) else ""
        raise kind(f"not a manifest of a corpus: {_in_words(problem)}{remedy}", file=str(path)) from None


def stated_records(folder: Path) -> object:
    """The number of records that the readable manifest of the corpus `folder` states for people and for programs of
    others, None if it states none; `Manifest.records` counts them instead."""
    stated: object = json.loads(manifest_path(folder).read_text(encoding="utf-8")).get("records")
    return stated


def no_corpus(folder: Path, lacking: str) -> BadInput:
    """The error of a `folder` that is no corpus because it has no file called `lacking`."""
    if not folder.exists():
        return BadInput("no such folder", file=str(folder), allowed="the folder of a corpus")
    if not folder.is_dir():
        return BadInput("this is not a folder", file=str(folder), allowed="the folder of a corpus")
    if has_finished_shards(folder):
        return BadInput(
            f"the {lacking} of this corpus is lost, or its run was killed or is not done yet; "
            f"{ANEW.format(folder=folder)}",
            file=str(folder),
        )
    return BadInput(
        f"this folder has no {lacking}, so it is not a corpus, or its making was interrupted or is not done yet",
        file=str(folder),
    )


def _recipe(found: dict[str, Any], origin: str) -> dict[str, Any]:
    """The recipe, or what recordings of that `origin` have in its place, their SPEC with its files; what reading JSON
    raises for any other."""
    if origin not in (SIMULATED, IMPORTED):
        raise ValueError("another origin")
    if origin == IMPORTED:
        return dict(found) | {"spec": dict(found["spec"])}
    return dict(found) | {"seed": whole(found["seed"])}


def _spans(found: list[Any], records: int) -> tuple[Span, ...]:
    """Spans as they are written, none beyond the recipe's records; ValueError."""
    spans = tuple((whole(start), whole(stop)) for start, stop in found)
    if not all(0 <= start <= stop <= records for start, stop in spans):
        raise ValueError("spans beyond the records of the recipe")
    return spans


def _in_words(problem: Exception) -> str:
    if isinstance(problem, OSError):
        return f"cannot be read ({problem.strerror})"
    if isinstance(problem, json.JSONDecodeError):
        return f"not JSON from line {problem.lineno}, column {problem.colno} on"
    if isinstance(problem, RecursionError):
        return "it is nested too deeply"
    if isinstance(problem, UnicodeDecodeError):
        return "no text"
    if isinstance(problem, KeyError):
        return f'it lacks "{problem.args[0]}"'
    return "its entries are not those of this version of the format"


def shard_entry(sidecar: Sidecar) -> ShardEntry:
    """What the manifest of a corpus says of a finished shard."""
    return ShardEntry(
        file=shard_name(sidecar.shard),
        records=len(sidecar.records),
        first=sidecar.records[0],
        last=sidecar.records[-1],
        bytes=sidecar.bytes,
        sha256=sidecar.sha256,
        content=sidecar.content,
    )


def add_spans(asked: tuple[Span, ...], more: Iterable[Span]) -> tuple[Span, ...]:
    """The union of spans [start, stop), sorted and merged."""
    merged: list[Span] = []
    for start, stop in sorted((*asked, *more)):
        if merged and start <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(stop, merged[-1][1]))
        else:
            merged.append((start, stop))
    return tuple(merged)
