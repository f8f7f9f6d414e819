"""Making a corpus: from a recipe to shards, manifest and index, by workers, resumed where an earlier run stopped."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path

from datagen.corpus_files.format import Identity, format_hash
from datagen.corpus_files.manifest import manifest_path, read_manifest
from datagen.errors import BadInput
from datagen.files.atomic import locked
from datagen.files.netcdf import check_compression
from datagen.files.places import require_folder
from datagen.recipes.recipe import Recipe
from datagen.runs.plan import plan_shards, selection
from datagen.runs.requirements import require_memory, require_possible_rates, require_room
from datagen.runs.run import Run, Summary
from datagen.runs.task import kernels_loading_in_workers
from datagen.runs.workers import Engine, engaged, none_woken
from datagen.telling import NOBODY, Listener
from datagen.versions import program_hash


def generate(
    recipe: Recipe,
    folder: Path,
    *,
    limit: int | None = None,
    records: Sequence[int] | None = None,
    engine: Engine | None = None,
    listener: Listener = NOBODY,
) -> Summary:
    """Make the recipe's records (all, the first `limit`, or those listed) in `folder`, keeping what is finished there.

    The arrays depend on the recipe alone, not on `engine`, order or interruptions. Raises BadInput before anything is
    written. KeyboardInterrupt leaves a usable corpus of the shards finished so far. Processes that make records, this
    one if it is the only worker, keep the memory of freed arrays (physics.freed_memory).
    """
    began = time.monotonic()
    asked = selection(recipe, limit, records)
    check_compression(recipe.store.compression)
    identity = corpus_identity(recipe)
    check_folder(folder, identity)
    require_memory(recipe)
    require_possible_rates(recipe, asked)
    earlier = read_manifest(folder).asked if manifest_path(folder).exists() else ()
    with engaged(engine or Engine()), nullcontext(none_woken) if earlier else kernels_loading_in_workers() as are_ready:
        # As far as any run was asked to go: a shard that lacks a record is made again with all that it held.
        planned = plan_shards(recipe, max(stop for _, stop in (*earlier, *asked)))
        require_room(recipe, planned, folder)
        _make_folder(folder)
        with locked(folder):
            check_folder(folder, identity)  # again: another run may have been here since
            run = Run(recipe, folder, identity, asked, listener)
            try:
                run.make(planned, are_ready)
            finally:
                run.finish()
    return run.summary(time.monotonic() - began)


def corpus_identity(recipe: Recipe) -> Identity:
    """The hashes that a corpus made now from this recipe carries."""
    from physics.compiled import fingerprint

    return Identity(recipe.hash[:16], fingerprint(), format_hash(), program_hash())


def check_folder(folder: Path, identity: Identity) -> None:
    """Raise BadInput if `folder` is neither empty nor a corpus of the same identity."""
    require_folder(folder)
    if not manifest_path(folder).exists():
        strangers = _strangers(folder)
        if strangers:
            raise BadInput(
                f"this folder holds no corpus but other things ({', '.join(strangers[:3])})", str(folder), "--out"
            )
        return
    found = read_manifest(folder).identity
    changed = {
        "the recipe": found.recipe_hash != identity.recipe_hash,
        "the physics": found.model_hash != identity.model_hash,
        "the file format": found.format_hash != identity.format_hash,
        "the program": found.program_hash != identity.program_hash,
    }
    names = [name for name, differs in changed.items() if differs]
    if names:
        raise BadInput(
            f"the corpus in this folder was begun with another version of {' and '.join(names)}, and a corpus never "
            "mixes versions: choose another folder, or delete this one",
            str(folder),
            "--out",
        )


def _strangers(folder: Path) -> list[str]:
    """Names in `folder` that an interrupted beginning of a run does not explain."""
    if not folder.exists():
        return []
    ours = (".lock", "shards")
    names = [path.name for path in folder.iterdir() if path.name not in ours and not path.name.endswith(".part")]
    return sorted(names) or sorted(path.name for path in (folder / "shards").glob("*.nc"))


def _make_folder(folder: Path) -> None:
    try:
        (folder / "shards").mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise BadInput(f"cannot make this folder: {problem.strerror}", str(folder), "--out") from None
