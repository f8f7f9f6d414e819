"""How to mend or finish a corpus in which a check found something wrong."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from datagen.corpus_files.manifest import Manifest
from datagen.versions import program_hash


@dataclass(frozen=True)
class State:
    """What of a corpus must be made again: `damaged` files, `unfinished` ones that a run which ends writes anew (True
    if there are any), `missing` records; `held` is True while a run is writing into it."""

    damaged: tuple[str, ...]
    unfinished: bool
    missing: int
    held: bool


def remedy(manifest: Manifest, folder: Path, state: State) -> str:
    """A sentence on how to mend or finish the corpus in `folder`, empty if there is nothing to do."""
    if not (state.damaged or state.unfinished or state.missing):
        return ""
    if manifest.imported:
        return "to mend it, delete this folder and import the recordings again"
    if state.held:
        return "a run is writing into this folder: it is not complete before that ends; check it again then"
    there = [name for name in state.damaged if (folder / name).exists()]
    first = f"delete {', '.join(there)} and " if there else ""
    aim = "to mend it" if state.damaged or not state.missing else "it is not complete: to go on where its run stopped"
    version = "" if manifest.identity.program_hash == program_hash() else ", by the version of spallgen that made it"
    return f"{aim}, {first}run `spallgen generate` again with the same recipe and --out {folder}{version}"
