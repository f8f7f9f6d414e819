"""Checking a corpus: every byte, every array, every label, and that its scenarios still give its records."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from datagen.corpus_files.format import FORMAT, format_hash
from datagen.corpus_files.manifest import read_manifest
from datagen.corpus_files.shard import shard_name
from datagen.counts import counted
from datagen.errors import BadInput
from datagen.files.lock import is_held
from datagen.files.places import FAILURES, from_home
from datagen.inspection.corpus_parts import CorpusParts, read_parts
from datagen.inspection.findings import Findings, of_file
from datagen.inspection.manifest_check import differences
from datagen.inspection.remaking import Remade, remake_record
from datagen.inspection.remedy import State, remedy
from datagen.inspection.shard_check import check_shard
from labels.schema import UNKNOWN


@dataclass(frozen=True)
class Verdict:
    """What a check found: `problems` are sentences (none: all is well).

    `damaged` are files that are not what was written, `missing` how many records that were asked for are not there
    though none of them failed, `remedy` a sentence on how to mend or finish that (empty: nothing to do).
    `remade` are the records simulated again (none with other physics than theirs), `largest_difference` the largest
    RMS difference of their acceleration from what is stored, relative to its RMS.
    """

    folder: str
    shards: int
    records: int
    imported: bool
    remade: tuple[int, ...]
    largest_difference: float
    problems: tuple[str, ...]
    damaged: tuple[str, ...]
    missing: int
    remedy: str

    @property
    def sound(self) -> bool:
        """True if nothing is wrong."""
        return not self.problems


def check_corpus(folder: str | Path, remake: int = 0) -> Verdict:
    """Read the whole corpus in `folder`, say everything that is wrong, and simulate `remake` of its records again.

    Raises BadInput if the folder holds no corpus, or one of another format.
    """
    folder = from_home(folder)
    manifest = read_manifest(folder)
    if manifest.identity.format_hash != format_hash():
        raise BadInput(f"written in another version of the format than this program's ({FORMAT})", file=str(folder))
    parts, found = read_parts(folder, manifest)
    found += _wrong_shards(parts) + _wrong_between_shards(parts)
    again = {} if found.problems else _made_again(parts, remake)
    differences_by_record = {record: one.difference for record, one in again.items() if one.difference is not None}
    state = State(found.damaged, found.unfinished, len(parts.missing), is_held(folder))
    return Verdict(
        folder=str(folder),
        shards=len(parts.sidecars),
        records=len(parts.records),
        imported=manifest.imported,
        remade=tuple(differences_by_record),
        largest_difference=max(differences_by_record.values(), default=0.0),
        problems=(*found.problems, *(sentence for one in again.values() for sentence in one.problems)),
        damaged=state.damaged,
        missing=state.missing,
        remedy=remedy(manifest, folder, state),
    )


def _wrong_shards(parts: CorpusParts) -> Findings:
    """What is wrong with each shard, and records that several hold."""
    found, seen = Findings(), set[int]()
    for sidecar in parts.sidecars:
        if not sidecar.records:
            continue
        found += check_shard(parts, sidecar)
        twice = seen.intersection(sidecar.records)
        if twice:
            name = shard_name(sidecar.shard)
            found += of_file(name, [f"record {min(twice)} is in another shard too"])
        seen.update(sidecar.records)
    return found


def _wrong_between_shards(parts: CorpusParts) -> Findings:
    """Records that are missing or could not be made, and what manifest and index say otherwise than the shards."""
    problems = []
    if parts.missing:
        problems.append(
            f"{len(parts.missing)} of {parts.manifest.asked_records} records asked for are missing, "
            f"the first {min(parts.missing)}"
        )
    problems += differences(parts.manifest, parts.folder, parts.sidecars, compare_sums=not parts.unlisted)
    if parts.failed:
        problems.append(f"{counted(len(parts.failed), 'record')} could not be made; {FAILURES} says why")
    return Findings(tuple(problems)) + _wrong_index(parts)


def _wrong_index(parts: CorpusParts) -> Findings:
    """Whether the index lists other records than the shards hold, or a bearing in two splits."""
    index, found = parts.index, Findings()
    if index is None:
        return found
    if set(index["record"]) != parts.records or not index["record"].is_unique:
        found += Findings(("index.csv does not list every record of the shards exactly once",), unfinished=True)
    splits = index[index["bearing_id"] != UNKNOWN].groupby("bearing_id")["split"].nunique()
    if (splits > 1).any():
        found += Findings((f"the records of bearing {splits.idxmax()} are in more than one split",))
    return found


def _made_again(parts: CorpusParts, count: int) -> dict[int, Remade]:
    """How `count` records, spread over the corpus, come out again from their stored scenarios; none with other physics
    than theirs, and no recordings, which have no model."""
    from datagen.corpus import Corpus
    from physics.compiled import fingerprint

    if not count or not parts.records or parts.manifest.identity.model_hash != fingerprint():
        return {}
    ordered = sorted(parts.records)
    places = np.unique(np.linspace(0, len(ordered) - 1, min(count, len(ordered))).round().astype(int))
    with Corpus(parts.folder) as corpus:
        return {ordered[place]: remake_record(corpus, ordered[place]) for place in places}
