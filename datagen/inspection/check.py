"""Checking a corpus: every byte, every array, every label, and that its scenarios still give its records."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.corpus_files.format import FORMAT, content_hash, format_hash
from datagen.corpus_files.index import LABEL_COLUMNS, read_index
from datagen.corpus_files.manifest import Manifest, read_manifest, shard_entry
from datagen.corpus_files.reading import READ_ERRORS, unencodable
from datagen.corpus_files.shard import Sidecar, label_columns, read_sidecar, shard_path, shards_folder, sidecar_path
from datagen.counts import counted
from datagen.errors import BadInput
from datagen.files.atomic import is_held
from datagen.files.digest import file_hash
from datagen.files.netcdf import ONE_AT_A_TIME
from datagen.files.places import FAILURES
from datagen.inspection.conformity import violations
from datagen.inspection.manifest_check import differences, recipe_of
from datagen.inspection.remaking import remake_record
from datagen.inspection.remedy import State, remedy
from datagen.versions import program_hash
from labels.schema import UNKNOWN

if TYPE_CHECKING:
    import pandas
    import xarray

FORBIDDEN = "it cannot be read for lack of permission; change its permissions"


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
    folder = Path(folder)
    manifest = read_manifest(folder)
    if manifest.identity.format_hash != format_hash():
        raise BadInput(f"written in another version of the format than this program's ({FORMAT})", str(folder))
    check = _Check(folder, manifest)
    check.files()
    for sidecar in check.sidecars:
        check.shard(sidecar)
    check.whole()
    check.remake(remake)
    state = State(tuple(check.damaged), check.unfinished, check.missing, is_held(folder))
    return Verdict(
        folder=str(folder),
        shards=len(check.sidecars),
        records=len(check.records),
        imported=manifest.imported,
        remade=tuple(check.remade),
        largest_difference=check.difference,
        problems=tuple(check.problems),
        damaged=state.damaged,
        missing=state.missing,
        remedy=remedy(manifest, folder, state),
    )


class _Check:
    """The problems found so far, and what the parts of a corpus say of each other."""

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        self.folder, self.manifest = folder, manifest
        self.problems: list[str] = []
        self.damaged: list[str] = []
        # Files that a run which ends writes anew: the index, the manifest, shards without sidecar.
        self.unfinished = False
        self.unlisted: frozenset[str] = frozenset()
        self.missing = 0
        self.sidecars: list[Sidecar] = []
        self.records: set[int] = set()
        self.remade: list[int] = []
        self.difference = 0.0
        self.index = self._read_index()
        self.recipe, problems = recipe_of(manifest, folder)
        self.problems += problems

    def _read_index(self) -> pandas.DataFrame | None:
        try:
            return read_index(self.folder)
        except BadInput as problem:
            self.problems.append(str(problem))
            self.unfinished = True
            return None

    def files(self) -> None:
        """Read every sidecar, and find files that do not belong together."""
        shards = shards_folder(self.folder)
        for path in sorted(shards.glob("*.json")):
            sidecar = read_sidecar(path)
            if sidecar is None:
                self.damaged.append(str(path.relative_to(self.folder)))
                self.problems.append(f"{self.damaged[-1]}: cannot be read")
            elif path != (own := sidecar_path(self.folder, sidecar.shard)):
                name = path.relative_to(self.folder).as_posix()
                self.problems.append(f"{name}: by what it says this is {own.name} under another name")
            else:
                self.sidecars.append(sidecar)
        known = {shard_path(self.folder, sidecar.shard) for sidecar in self.sidecars if sidecar.records}
        for path in sorted({*shards.glob("*.nc")} - known):
            self.unfinished = True
            name = path.relative_to(self.folder).as_posix()
            self.problems.append(f"{name}: unfinished: the sidecar that vouches for it is missing")
        self._compare_lists({path.relative_to(self.folder).as_posix() for path in known})

    def _compare_lists(self, known: set[str]) -> None:
        """Find shards that only the manifest lists, or only their sidecars."""
        listed = {entry.file for entry in self.manifest.shards}
        self.unlisted = frozenset(known - listed)
        if self.unlisted:
            self.unfinished = True
            more = f" and {len(self.unlisted) - 1} more finished shards are" if len(self.unlisted) > 1 else " is"
            self.problems.append(f"manifest.json: {min(self.unlisted)}{more} not listed")
        self.problems += [f"{name}: missing, but listed in manifest.json" for name in sorted(listed - known)]

    def shard(self, sidecar: Sidecar) -> None:
        """Find everything wrong with one shard."""
        if not sidecar.records:
            return
        entry = shard_entry(sidecar, self.folder)
        dataset, damage = _opened(shard_path(self.folder, sidecar.shard), sidecar)
        if damage and damage != [FORBIDDEN]:
            self.damaged.append(entry.file)
        for sentence in (*damage, *self._wrong_shard(sidecar, dataset)):
            self.problems.append(f"{entry.file}: {sentence}")
        if entry not in self.manifest.shards and entry.file not in self.unlisted:
            self.problems.append(f"{entry.file}: manifest.json and its sidecar disagree about it")
        twice = self.records.intersection(sidecar.records)
        if twice:
            self.problems.append(f"{entry.file}: record {min(twice)} is in another shard too")
        self.records.update(sidecar.records)

    def _wrong_shard(self, sidecar: Sidecar, dataset: xarray.Dataset | None) -> Iterator[str]:
        if sidecar.identity != self.manifest.identity:
            yield "made from another recipe, physics or format than the manifest states"
        if dataset is None:
            return
        yield from violations(dataset)
        yield from self._missing_signals(dataset)
        yield from self._wrong_labels(sidecar, dataset)
        yield from self._wrong_scenarios(dataset)

    def _missing_signals(self, dataset: xarray.Dataset) -> Iterator[str]:
        from datagen.runs.plan import signals_of_every_record

        for name in signals_of_every_record(self.recipe) if self.recipe else ():
            if name not in dataset:
                yield f"{name} is missing, but the recipe asks for it"

    def _wrong_labels(self, sidecar: Sidecar, dataset: xarray.Dataset) -> Iterator[str]:
        if label_columns(dataset) != sidecar.labels:
            yield "its labels are not those of its sidecar"
        if self.index is None:
            return
        name = shard_entry(sidecar, self.folder).file
        if name in self.unlisted and name not in self._rows_of_shard:
            return  # both are written at the end of a run
        rows = self.index.iloc[self._rows_of_shard.get(name, [])].sort_values("position")
        stated = {c: [None if value != value else value for value in rows[c].tolist()] for c in LABEL_COLUMNS}
        if stated != sidecar.labels or rows["position"].tolist() != list(range(len(sidecar.records))):
            self.unfinished = True
            yield "index.csv disagrees about its records"

    @cached_property
    def _rows_of_shard(self) -> Mapping[Hashable, NDArray[np.int64]]:
        """Places of the rows of the index by shard."""
        return {} if self.index is None else self.index.groupby("shard").indices

    def _wrong_scenarios(self, dataset: xarray.Dataset) -> Iterator[str]:
        from datagen.scenarios.sampling import draw_scenario
        from datagen.scenarios.scenario_text import scenario_json

        if self.recipe is None or not self.recipe.drawable or self.manifest.identity.program_hash != program_hash():
            return
        for record, text in zip(dataset["record"].values.tolist(), dataset["scenario"].values, strict=True):
            if scenario_json(draw_scenario(self.recipe, record)) != str(text):
                yield f"the recipe gives record {record} another scenario than the stored one"
                return

    def whole(self) -> None:
        """Find what is wrong between the shards: records missing or twice, machines in two splits."""
        asked = {record for start, stop in self.manifest.asked for record in range(start, stop)}
        failed = {failure.record for failure in self.manifest.failed}
        missing = asked - self.records - failed
        self.missing = len(missing)
        if missing:
            self.problems.append(
                f"{len(missing)} of {len(asked)} records asked for are missing, the first {min(missing)}"
            )
        self.problems += differences(self.manifest, self.folder, self.sidecars, compare_sums=not self.unlisted)
        if failed & asked:
            self.problems.append(f"{counted(len(failed & asked), 'record')} could not be made; {FAILURES} says why")
        if self.index is None:
            return
        if set(self.index["record"]) != self.records or not self.index["record"].is_unique:
            self.unfinished = True
            self.problems.append("index.csv does not list every record of the shards exactly once")
        known = self.index[self.index["bearing_id"] != UNKNOWN]
        splits = known.groupby("bearing_id")["split"].nunique()
        if (splits > 1).any():
            self.problems.append(f"the records of bearing {splits.idxmax()} are in more than one split")

    def remake(self, count: int) -> None:
        """Simulate `count` records, spread over the corpus, again from their stored scenarios and compare."""
        from datagen.corpus import Corpus
        from physics.compiled import fingerprint

        if not count or not self.records or self.problems or self.manifest.identity.model_hash != fingerprint():
            return  # imported recordings have no model and so end here too
        ordered = sorted(self.records)
        with Corpus(self.folder) as corpus:
            for place in np.unique(np.linspace(0, len(ordered) - 1, count).round().astype(int)):
                remade = remake_record(corpus, ordered[place])
                self.problems += remade.problems
                if remade.difference is not None:
                    self.remade.append(ordered[place])
                    self.difference = max(self.difference, remade.difference)


def _opened(path: Path, sidecar: Sidecar) -> tuple[xarray.Dataset | None, list[str]]:
    """What a shard's file holds, None if it cannot be read, and in what it differs from what was written."""
    import xarray

    if not path.is_file():
        return None, ["missing"]
    found = []
    try:
        if file_hash(path) != sidecar.sha256:
            found.append("its bytes have changed since it was written (SHA-256 differs)")
        with ONE_AT_A_TIME, xarray.open_dataset(path, engine="netcdf4") as opened:
            dataset = opened.load()
        if content_hash(dataset) != sidecar.content:
            found.append("its arrays are not those originally written")
    except UnicodeEncodeError:
        raise unencodable(path) from None
    except PermissionError:
        return None, [FORBIDDEN]
    except READ_ERRORS as problem:
        return None, [*found, f"cannot be read: {problem}"]
    return dataset, found
