"""Importing recordings: everything is read and checked before anything is written, and the corpus appears whole."""

from __future__ import annotations

import math
import os
import re
import shutil
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from datagen.corpus_files.format import IMPORTED, Identity, data_hash, format_hash
from datagen.corpus_files.index import write_index
from datagen.corpus_files.manifest import Manifest, write_manifest
from datagen.corpus_files.shard import finished_shards, write_shard
from datagen.errors import BadInput
from datagen.files.atomic import TEMPORARY_SUFFIX
from datagen.files.places import require_folder
from datagen.recordings.dataset import imported_dataset
from datagen.recordings.doubts import turns_doubt
from datagen.recordings.listing import Listing, Request, list_requests
from datagen.recordings.recorded import Key, Recorded, read_recording
from datagen.recordings.source import remembered_files, source_hash
from datagen.recordings.spec import Spec
from datagen.recordings.spec_files import shipped_specs
from datagen.recordings.unchanged import require_unchanged
from datagen.telling import Say, unheard
from datagen.versions import program_hash, program_versions
from labels.schema import UNKNOWN

if TYPE_CHECKING:
    import xarray

SHARD_BYTES = 64e6
# An import that ends within this time tells no progress.
SECONDS_UNTOLD = 2.0


@dataclass(frozen=True)
class Imported:
    """How an import ended: `absent` are listed files that were not there, `skipped` recordings left out as repeats,
    `dead` those with axes without a signal, as if the sensor were not connected; `doubts` are those that are odd in
    another way, by which, and `few_turns` a sentence on the shortest record if the shaft hardly turns in it."""

    folder: str
    records: int
    shards: int
    bytes: int
    seconds: float
    files: int
    absent: tuple[str, ...]
    skipped: tuple[str, ...]
    dead: tuple[str, ...]
    doubts: dict[str, tuple[str, ...]]
    few_turns: str


@dataclass(frozen=True)
class _Planned:
    """A record whose samples have been checked and dropped again: `piece` of `request`, with its index.

    `content` is the hash by which its samples are known again.
    """

    index: int
    request: Request
    piece: int
    key: Key
    bytes: int
    content: str


def import_recordings(spec: Spec, folder: Path, root: Path | None = None, tell: Say = unheard) -> Imported:
    """Make the corpus of the SPEC's recordings in `folder`, which must not exist or be empty.

    Files are looked for below `root`, by default the SPEC's own. Where it takes long, `tell` hears how far it has got.
    Raises BadInput for anything wrong in the SPEC or the files, before `folder` is touched.
    """
    with remembered_files():
        return _import(spec, folder, root or _own_root(spec), _patient(tell))


def _patient(tell: Say) -> Say:
    began = time.monotonic()
    return lambda step: tell(step) if time.monotonic() - began >= SECONDS_UNTOLD else None


def _own_root(spec: Spec) -> Path:
    if spec.source in shipped_specs().values():
        raise BadInput("this SPEC comes without its recordings", field="--root", allowed="the folder that holds them")
    return spec.source.parent / spec.root


def _import(spec: Spec, folder: Path, root: Path, tell: Say) -> Imported:
    began = time.monotonic()
    _check_folder(folder)
    listing = list_requests(spec, root)
    plan = _Plan(spec)
    for number, request in enumerate(listing.requests, start=1):
        tell(f"checking {request.name}, {number} of {len(listing.requests)}")
        plan.add(request)
    manifest = _manifest(spec, listing, len(plan.records))
    with _staged(folder) as staging:
        for number, planned in enumerate(plan.shards):
            tell(f"writing shard {number + 1} of {len(plan.shards)}")
            start = time.perf_counter()
            dataset = _dataset(planned, manifest)
            seconds = round(time.perf_counter() - start, 3)
            with _writing(folder):
                write_shard(staging, number, manifest.identity, dataset, (), "zlib", seconds)
        with _writing(folder):
            write_index(staging, finished_shards(staging))
            manifest = manifest.with_shards(staging, finished_shards(staging))
            write_manifest(staging, manifest)
        for path in {*(request.path for request in listing.requests), *listing.tables}:
            require_unchanged(path)  # so that what was read is what the hashes in the manifest are of
    return Imported(
        str(folder), len(plan.records), len(manifest.shards), manifest.bytes, round(time.monotonic() - began, 3),
        len({request.path for request in listing.requests}), listing.absent, tuple(plan.skipped), tuple(plan.dead),
        {doubt: tuple(names) for doubt, names in plan.doubts.items()}, plan.few_turns,
    )  # fmt: skip


def _check_folder(folder: Path) -> None:
    require_folder(folder)
    if folder.exists() and any(folder.iterdir()):
        raise BadInput(
            "this folder is not empty, and an import never adds to what is there", str(folder), "--out",
            allowed="a new or an empty folder",
        )  # fmt: skip


class _Plan:
    """The records found so far, none of them twice, and the shards they go into."""

    def __init__(self, spec: Spec) -> None:
        self.spec = spec
        self.records: list[_Planned] = []
        self.skipped: list[str] = []
        self.dead: list[str] = []
        self.doubts: dict[str, list[str]] = {}
        self.fewest_turns, self.few_turns = math.inf, ""
        self.names: dict[str, str] = {}
        self.contents: dict[str, str] = {}
        self.splits: dict[str, str] = {}

    def add(self, request: Request) -> None:
        """Read the records of a request, check them against all before, and keep what is needed to read them again."""
        for piece, record in enumerate(read_recording(request)):
            if self._is_new(record, request):
                self._check_split(record, request)
                self._doubt(record, request)
                self.records.append(
                    _Planned(len(self.records), request, piece, record.key, record.bytes, record.content)
                )

    def _doubt(self, record: Recorded, request: Request) -> None:
        """Keep what is odd about a record."""
        name = record.labels["recording"]
        if record.dead:
            self.dead.append(f"{name} ({', '.join(record.dead)})")
        for doubt, figures in record.doubts.items():
            self.doubts.setdefault(doubt, []).append(f"{name} ({figures})" if figures else name)
        if record.turns < self.fewest_turns:
            self.fewest_turns = record.turns
            self.few_turns = turns_doubt(record.turns, record.labels, request.settings)

    def _is_new(self, record: Recorded, request: Request) -> bool:
        name, where = record.labels["recording"], f"{request.name} ({request.place})"
        if name in self.names:
            raise BadInput(
                f"this name is already taken by {self.names[name]}", request.place, "recording", name,
                'a different name for each record, as in recording = "{path} {channel}"',
            )  # fmt: skip
        self.names[name] = where
        if record.dead == record.axes:
            return True  # all that is dead looks alike, and need be no repeat
        twin = self.contents.setdefault(record.content, name)
        if twin == name or self.spec.same_samples == "keep":
            return True
        if self.spec.same_samples == "refuse":
            raise BadInput(
                f'record "{name}" has exactly the samples of "{twin}", {self.names[twin]}', str(request.path),
                "same_samples", "refuse", '"skip", which leaves such repeats out, or "keep"',
            )  # fmt: skip
        self.skipped.append(name)
        return False

    def _check_split(self, record: Recorded, request: Request) -> None:
        bearing, split = record.labels["bearing_id"], record.labels["split"]
        if bearing != UNKNOWN and self.splits.setdefault(bearing, split) != split:
            problem = f"the records of bearing {bearing} would be in the splits {self.splits[bearing]} and {split}"
            raise BadInput(problem, request.place, "split", split, "one split for each bearing")

    @cached_property
    def shards(self) -> list[list[_Planned]]:
        """The records by shard: of one kind, in order, up to 64 MB together."""
        shards: list[list[_Planned]] = []
        growing: dict[Key, list[_Planned]] = {}
        for planned in self.records:
            shard = growing.get(planned.key)
            if shard is None or sum(one.bytes for one in shard) + planned.bytes > SHARD_BYTES:
                shard = growing[planned.key] = []
                shards.append(shard)
            shard.append(planned)
        return shards


def _dataset(shard: list[_Planned], manifest: Manifest) -> xarray.Dataset:
    """The records of a shard, read again."""
    records = list(_read_again(shard))
    spec = manifest.recipe["spec"]
    about = {"title": spec["title"] or spec["name"], "id": spec["name"], "license": spec["licence"]}
    about |= {"references": spec["citation"], **manifest.identity.to_dict()}
    about = {name: text for name, text in about.items() if text}
    return imported_dataset([planned.index for planned in shard], records, about)


def _read_again(shard: list[_Planned]) -> Iterator[Recorded]:
    wanted: dict[Request, dict[int, str]] = {}
    for planned in shard:
        wanted.setdefault(planned.request, {})[planned.piece] = planned.content
    for request, contents in wanted.items():
        for piece, record in enumerate(read_recording(request)):
            if piece in contents:
                if record.content != contents[piece]:
                    raise BadInput("the file changed while it was being imported", str(request.path))
                yield record


def _manifest(spec: Spec, listing: Listing, records: int) -> Manifest:
    content: dict[str, Any] = {
        "spec": spec.model_dump(mode="json"),
        "files": {request.name: source_hash(request.path) for request in listing.requests},
        "tables": {path.name: source_hash(path) for path in listing.tables},
    }
    return Manifest(
        name=spec.name,
        identity=Identity(data_hash(content), "", format_hash(), program_hash()),
        recipe=content,
        recipe_records=records,
        asked=((0, records),),
        made_with=program_versions(),
        origin=IMPORTED,
    )


def _sweep(place: Path, beginning: str) -> None:
    """Delete what imports of the same name left in `place` whose process, on this computer, was killed."""
    name = re.compile(re.escape(beginning) + r"(\d+)" + re.escape(TEMPORARY_SUFFIX))
    for path in place.glob(".*") if place.is_dir() else ():
        found = name.fullmatch(path.name)
        if found and not _alive(int(found[1])):
            shutil.rmtree(path, ignore_errors=True)


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        pass  # somebody else's
    return True


@contextmanager
def _staged(folder: Path) -> Iterator[Path]:
    """A folder beside `folder` that takes its place at the end, or is gone if anything goes wrong.

    What goes wrong in the block is left as it is: it may be a recording that cannot be read.
    """
    beginning = f".{folder.name}.{socket.gethostname()}."
    staging = folder.with_name(f"{beginning}{os.getpid()}{TEMPORARY_SUFFIX}")
    _sweep(folder.parent, beginning)
    try:
        with _writing(folder):
            (staging / "shards").mkdir(parents=True)
        yield staging
        with _writing(folder):
            if folder.exists():
                folder.rmdir()
            staging.rename(folder)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    """BadInput that names `folder` in place of an OSError of the block, which does nothing but write."""
    try:
        yield
    except OSError as problem:
        raise BadInput(f"cannot write here: {problem.strerror}", str(folder), "--out") from None
