"""What one worker does: make the records of one shard, write them, and return one small row."""

from __future__ import annotations

import time
import traceback
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from datagen.corpus_files.format import SIMULATED_ATTRIBUTES, Identity, to_dataset
from datagen.corpus_files.shard import Failure, Sidecar, write_shard
from datagen.errors import BadInput
from datagen.files.atomic import NO_SPACE
from datagen.files.temporary import NoTemporaryRoom
from datagen.freed_memory import keep_freed_memory
from datagen.progress import Say
from datagen.recipes.recipe import Recipe
from datagen.records.record import Record, make_record
from datagen.runs.plan import PlannedShard
from datagen.runs.redraws import counted_redraws
from datagen.scenarios.refused import Redraw, count_refused
from datagen.scenarios.sampling import draw_scenario
from physics.outcome import SimulationFailed


@dataclass(frozen=True)
class ShardRow:
    """How making a `shard` (its number) ended: `error` is a sentence or a traceback if it failed, else ""."""

    shard: int
    error: str = ""


def compile_kernels(say: Say) -> None:
    """Make sure that the cache holds every kernel undamaged, compiling what it lacks, before workers start."""
    from physics.warming import is_warm, warm_up

    if is_warm():
        load_kernels()
    else:
        say("compiling the physics; this is done once for each version of it")
        warm_up()


@cache
def load_kernels() -> None:
    """Load every kernel into this process; those missing from the cache of this machine, or damaged, are compiled."""
    from physics.warming import warm_up

    warm_up()


def make_shard(recipe: Recipe, folder: Path, planned: PlannedShard, identity: Identity) -> ShardRow:
    """Make and write all records of a planned shard; raises what no other shard would escape: OSError if the disk is
    full, NoTemporaryRoom if that of temporary files is.

    The process keeps the memory of freed arrays from then on (datagen.freed_memory).
    """
    keep_freed_memory()
    try:
        load_kernels()
        return _make_shard(recipe, folder, planned, identity)
    except NoTemporaryRoom:
        raise
    except BadInput as problem:  # such as a recording that is gone
        return ShardRow(planned.number, str(problem))
    except Exception as problem:
        if isinstance(problem, OSError) and problem.errno in NO_SPACE:
            raise
        return ShardRow(planned.number, traceback.format_exc())


def _make_shard(recipe: Recipe, folder: Path, planned: PlannedShard, identity: Identity) -> ShardRow:
    began = time.perf_counter()
    records: list[Record] = []
    failed: list[Failure] = []
    redraws: list[Redraw] = []
    for index in planned.records:
        scenario = draw_scenario(recipe, index)
        redraws += counted_redraws(recipe, scenario)
        try:
            records.append(make_record(scenario, planned.stored))
        except SimulationFailed as problem:
            failed.append(Failure(index, str(problem)))
    dataset = to_dataset(records, _attributes(recipe, identity)) if records else None
    sidecar = Sidecar(
        shard=planned.number,
        identity=identity,
        failed=tuple(failed),
        seconds=round(time.perf_counter() - began, 3),
        refused=count_refused(redraws),
    )
    write_shard(folder, sidecar, dataset, recipe.store.compression)
    return ShardRow(planned.number)


def _attributes(recipe: Recipe, identity: Identity) -> dict[str, str]:
    """What a shard says of the recipe that it comes from, besides what all shards of simulated records say."""
    about = {"title": recipe.title or recipe.name, "id": recipe.name, **identity.to_dict()}
    if recipe.licence:
        about["license"] = recipe.licence
    if recipe.citation:
        about["references"] = f"{SIMULATED_ATTRIBUTES['references']}; {recipe.citation}"
    return about
