"""The parts of a corpus that say something of its records without a shard being opened, read once for a check."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.corpus_files.index import read_index
from datagen.corpus_files.manifest import Manifest
from datagen.corpus_files.shard import Sidecar, by_number, read_sidecar, shard_path, shards_folder, sidecar_path
from datagen.errors import BadInput
from datagen.inspection.findings import Findings, of_file
from datagen.inspection.manifest_check import recipe_of

if TYPE_CHECKING:
    import pandas

    from datagen.recipes.recipe import Recipe


@dataclass(frozen=True)
class CorpusParts:
    """What the parts of the corpus in `folder` say; `recipe` and `index` are None where they cannot be read.

    `sidecars` are those that vouch for a shard of their own, by its number; `unlisted` the files of finished shards
    that the manifest does not list.
    """

    folder: Path
    manifest: Manifest
    recipe: Recipe | None
    index: pandas.DataFrame | None
    sidecars: tuple[Sidecar, ...]
    unlisted: frozenset[str]

    @cached_property
    def records(self) -> frozenset[int]:
        """The records that the shards hold."""
        return frozenset(record for sidecar in self.sidecars for record in sidecar.records)

    @cached_property
    def failed(self) -> frozenset[int]:
        """The records that could not be made."""
        return frozenset(failure.record for failure in self.manifest.failed)

    @cached_property
    def missing(self) -> frozenset[int]:
        """The records that were asked for and are not there, though none of them failed."""
        return self.manifest.every_asked - self.records - self.failed

    @cached_property
    def rows_of_shard(self) -> Mapping[Hashable, NDArray[np.int64]]:
        """Places of the rows of the index by shard."""
        return {} if self.index is None else self.index.groupby("shard").indices


def read_parts(folder: Path, manifest: Manifest) -> tuple[CorpusParts, Findings]:
    """The parts of the corpus in `folder`, and which of them cannot be read or do not belong together."""
    index, of_index = _index(folder)
    recipe, of_recipe = recipe_of(manifest, folder)
    sidecars, of_sidecars = _sidecars(folder)
    finished = {shard_path(folder, sidecar.shard) for sidecar in sidecars if sidecar.records}
    known = {_name(path, folder) for path in finished}
    listed = {entry.file for entry in manifest.shards}
    unlisted = frozenset(known - listed)
    found = of_index + Findings(tuple(of_recipe), unfinished=bool(of_recipe)) + of_sidecars
    found += _without_sidecar(folder, finished) + _not_listed(unlisted)
    missing = tuple(f"{name}: missing, but listed in manifest.json" for name in sorted(listed - known))
    return CorpusParts(folder, manifest, recipe, index, sidecars, unlisted), found + Findings(missing)


def _name(path: Path, folder: Path) -> str:
    return path.relative_to(folder).as_posix()


def _index(folder: Path) -> tuple[pandas.DataFrame | None, Findings]:
    try:
        return read_index(folder), Findings()
    except BadInput as problem:
        return None, Findings((str(problem),), unfinished=True)


def _sidecars(folder: Path) -> tuple[tuple[Sidecar, ...], Findings]:
    sidecars, found = [], Findings()
    for path in by_number(shards_folder(folder).glob("*.json")):
        sidecar, name = read_sidecar(path), _name(path, folder)
        if sidecar is None:
            found += of_file(name, ["cannot be read"], damaged=True)
        elif path != (own := sidecar_path(folder, sidecar.shard)):
            found += of_file(name, [f"by what it says this is {own.name} under another name"])
        else:
            sidecars.append(sidecar)
    return tuple(sidecars), found


def _without_sidecar(folder: Path, finished: set[Path]) -> Findings:
    """Files of shards that are not among the `finished` ones."""
    others = sorted({*shards_folder(folder).glob("*.nc")} - finished)
    vouched = "unfinished: the sidecar that vouches for it is missing"
    return Findings(tuple(f"{_name(path, folder)}: {vouched}" for path in others), unfinished=bool(others))


def _not_listed(unlisted: frozenset[str]) -> Findings:
    if not unlisted:
        return Findings()
    more = f" and {len(unlisted) - 1} more are" if len(unlisted) > 1 else " is"
    return of_file("manifest.json", [f"{min(unlisted)}{more} not listed"], unfinished=True)
