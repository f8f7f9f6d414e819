"""Importing recordings: everything is read and checked before anything is written, and the corpus appears whole."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from datagen.corpus_files.format import IMPORTED, Identity, data_hash, format_hash
from datagen.corpus_files.index import write_index
from datagen.corpus_files.manifest import Manifest, write_manifest
from datagen.corpus_files.shard import Sidecar, finished_shards, write_shard
from datagen.errors import BadInput
from datagen.files.atomic import writing
from datagen.files.places import OUT, from_home, require_folder
from datagen.progress import Say, Throttle, ignore
from datagen.recordings.dataset import imported_dataset
from datagen.recordings.import_plan import ImportPlan, PlannedRecord
from datagen.recordings.listing import Listing, Request, list_requests
from datagen.recordings.opened_files import remembered_files, source_hash
from datagen.recordings.recorded import Recorded, read_recording
from datagen.recordings.spec import Spec
from datagen.recordings.spec_files import shipped_specs
from datagen.recordings.staging import staged
from datagen.recordings.unchanged import changed, require_unchanged
from datagen.versions import program_hash, program_versions

if TYPE_CHECKING:
    import xarray

# An import that ends within this time shows no progress.
SECONDS_BETWEEN_STEPS = 2.0


@dataclass(frozen=True)
class Imported:
    """How an import ended.

    `absent` are listed files that were not there, `skipped` recordings left out as repeats, and `dead` those with axes
    without a signal, as if the sensor were not connected. `doubts` names the recordings that are odd in another way, by
    what is odd; `few_turns` is a sentence on the shortest record if the shaft hardly turns in it.
    """

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


def import_recordings(spec: Spec, folder: str | Path, root: str | Path | None = None, step: Say = ignore) -> Imported:
    """Make the corpus of the SPEC's recordings in `folder`, which must not exist or be empty.

    Files are looked for below `root`, by default the SPEC's own. `step` is called with how far it has got where that
    takes long. Raises BadInput for anything wrong in the SPEC or the files, before `folder` is touched.
    """
    with remembered_files():
        return _import(spec, from_home(folder), _given_root(root) if root else _stated_root(spec), _seldom(step))


def _seldom(step: Say) -> Say:
    """`step`, passed on no more often than a person can read."""
    reports = Throttle(SECONDS_BETWEEN_STEPS, time.monotonic() + SECONDS_BETWEEN_STEPS)
    return lambda sentence: step(sentence) if reports.due(time.monotonic()) else None


def _given_root(root: str | Path) -> Path:
    found = from_home(root)
    if not found.is_dir():
        raise BadInput("no such folder", field="--root", value=str(root), allowed="the folder of the recordings")
    return found


def _stated_root(spec: Spec) -> Path:
    """The folder of the recordings as the SPEC states it; BadInput for a shipped SPEC, which cannot know it."""
    if spec.source in shipped_specs().values():
        raise BadInput("this SPEC comes without its recordings", field="--root", allowed="the folder that holds them")
    return spec.source.parent / spec.root


def _import(spec: Spec, folder: Path, root: Path, step: Say) -> Imported:
    began = time.monotonic()
    _require_new(folder)
    listing = list_requests(spec, root)
    plan = ImportPlan(spec)
    for number, request in enumerate(listing.requests, start=1):
        step(f"checking {request.name}, {number} of {len(listing.requests)}")
        plan.add(request)
    manifest = _write(plan, _manifest(spec, listing, len(plan.records)), listing, folder, step)
    return Imported(
        folder=str(folder),
        records=len(plan.records),
        shards=len(manifest.shards),
        bytes=manifest.bytes,
        seconds=round(time.monotonic() - began, 3),
        files=len({request.path for request in listing.requests}),
        absent=listing.absent,
        skipped=tuple(plan.skipped),
        dead=tuple(plan.dead),
        doubts={doubt: tuple(names) for doubt, names in plan.doubts.items()},
        few_turns=plan.few_turns,
    )


def _write(plan: ImportPlan, manifest: Manifest, listing: Listing, folder: Path, step: Say) -> Manifest:
    """Write the planned shards, the index and the manifest; returns the manifest with its shards."""
    with staged(folder) as staging:
        for number, planned in enumerate(plan.shards):
            step(f"writing shard {number + 1} of {len(plan.shards)}")
            start = time.perf_counter()
            dataset = _dataset(planned, manifest)
            seconds = round(time.perf_counter() - start, 3)
            with writing(folder):
                write_shard(staging, Sidecar(number, manifest.identity, seconds=seconds), dataset, "zlib")
        with writing(folder):
            write_index(staging, finished_shards(staging))
            manifest = manifest.with_shards(finished_shards(staging))
            write_manifest(staging, manifest)
        for path in {*(request.path for request in listing.requests), *listing.tables.values()}:
            require_unchanged(path)  # so that the hashes in the manifest are those of what was read
    return manifest


def _require_new(folder: Path) -> None:
    require_folder(folder)
    if folder.exists():
        require_folder(folder.resolve().parent)  # beside which the new one is filled
    if folder.resolve().is_mount():
        raise BadInput(
            "an import puts a folder of its own in this place, and one that a file system is mounted on cannot be "
            "replaced", file=str(folder), field=OUT, allowed="a folder in it, or another one, new or empty",
        )  # fmt: skip
    if folder.exists() and os.path.samefile(folder, "."):
        raise BadInput(
            "an import puts a folder of its own in this place, and the current one cannot be replaced",
            file=str(folder),
            field=OUT,
            allowed="another folder, new or empty",
        )
    if folder.exists() and any(folder.iterdir()):
        raise BadInput(
            "this folder is not empty, and an import never adds to what is there", file=str(folder), field=OUT,
            allowed="a new or an empty folder",
        )  # fmt: skip


def _dataset(shard: list[PlannedRecord], manifest: Manifest) -> xarray.Dataset:
    """The records of a shard, read again."""
    records = list(_read_again(shard))
    spec = manifest.written
    about = {"title": spec["title"] or spec["name"], "id": spec["name"], "license": spec["licence"]}
    about |= {"references": spec["citation"], **manifest.identity.to_dict()}
    about = {name: text for name, text in about.items() if text}
    return imported_dataset([planned.index for planned in shard], records, about)


def _read_again(shard: list[PlannedRecord]) -> Iterator[Recorded]:
    wanted: dict[Request, dict[int, PlannedRecord]] = {}
    for planned in shard:
        wanted.setdefault(planned.request, {})[planned.piece] = planned
    for request, pieces in wanted.items():
        band = next(iter(pieces.values())).band
        for piece, record in enumerate(read_recording(request, band)):
            if piece in pieces:
                if record.content != pieces[piece].content:
                    raise changed(request.path)
                yield record


def _manifest(spec: Spec, listing: Listing, records: int) -> Manifest:
    content: dict[str, Any] = {
        "spec": spec.model_dump(mode="json"),
        "files": {request.name: source_hash(request.path) for request in listing.requests},
        "tables": {name: source_hash(path) for name, path in listing.tables.items()},
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
