"""Making a corpus: from a recipe to shards, manifest and index, by workers, resumed where an earlier run stopped."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path

from datagen.corpus_files.format import Identity, format_hash
from datagen.corpus_files.manifest import Span, add_spans
from datagen.corpus_files.shard import shards_folder
from datagen.errors import BadInput
from datagen.files.lock import locked
from datagen.files.netcdf import check_compression
from datagen.files.places import OUT, from_home
from datagen.progress import SILENT, Listener
from datagen.recipes.recipe import Recipe
from datagen.runs.earlier import earlier_runs
from datagen.runs.plan import plan_shards, selection
from datagen.runs.requirements import require_memory, require_possible_rates, require_room
from datagen.runs.run import Run, Summary
from datagen.runs.task import compile_kernels
from datagen.runs.workers import Engine, engaged
from datagen.versions import program_hash


def generate(
    recipe: Recipe,
    folder: str | Path,
    *,
    limit: int | None = None,
    records: Sequence[int] | None = None,
    engine: Engine | None = None,
    listener: Listener = SILENT,
) -> Summary:
    """Make the recipe's records (all, the first `limit`, or those listed) in `folder`, keeping what is finished there.

    The arrays depend on the recipe alone, not on `engine`, the order or interruptions. A lost or damaged manifest is
    written again from the sidecars of the finished shards. Raises BadInput before anything is written; a
    KeyboardInterrupt leaves a usable corpus of the shards finished so far. Processes that make records, this one if it
    is the only worker, keep the memory of freed arrays (datagen.freed_memory).
    """
    began, folder = time.monotonic(), from_home(folder)
    asked = selection(recipe, limit, records)
    check_compression(recipe.store.compression)
    identity = corpus_identity(recipe)
    earlier = earlier_runs(folder, recipe, identity).asked
    require_memory(recipe)
    # Before any scenario is drawn, which takes some of the kernels: here two processes compile them, or a damaged cache
    # is mended.
    compile_kernels(listener.say)
    require_possible_rates(recipe, asked)
    # The plan reaches as far as any run was asked for: a shard that lacks a record is made again with all that it held.
    stop = _last((*earlier, *asked))
    planned = plan_shards(recipe, stop, listener.say)
    require_room(recipe, planned, folder)
    with ExitStack() as once_workers_are_gone, engaged((engine or Engine()).for_tasks(len(planned))):
        _make_folder(folder)
        once_workers_are_gone.enter_context(locked(folder))
        found = earlier_runs(folder, recipe, identity)  # again: another run may have been here since
        if found.lost:
            listener.say(found.lost)
        if _last(found.asked) > stop:
            planned = plan_shards(recipe, _last(found.asked), listener.say)
        run = Run(recipe, folder, identity, add_spans(found.asked, asked), asked, listener)
        once_workers_are_gone.callback(run.finish)
        run.make(planned)
    return run.summary(time.monotonic() - began)


def corpus_identity(recipe: Recipe) -> Identity:
    """The hashes that a corpus made now from this recipe carries."""
    from physics.compiled import fingerprint

    return Identity(recipe.short_hash, fingerprint(), format_hash(), program_hash())


def _last(spans: Iterable[Span]) -> int:
    """Where the last of the spans of records stops; 0 without any."""
    return max((stop for _, stop in spans), default=0)


def _make_folder(folder: Path) -> None:
    try:
        shards_folder(folder).mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise BadInput(f"cannot make this folder: {problem.strerror}", file=str(folder), field=OUT) from None
