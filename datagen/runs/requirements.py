"""The sampling rate, memory and disk space that records need: what can never be made is refused before any worker
starts."""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Iterable, Sequence
from itertools import chain
from pathlib import Path

from datagen.corpus_files.manifest import Span, manifest_path
from datagen.counts import bytes_text
from datagen.errors import BadInput
from datagen.files.places import OUT
from datagen.recipes.recipe import Recipe
from datagen.runs.plan import PlannedShard, stored_bytes
from datagen.runs.rates import against_rate, lowest_rate
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from datagen.settings.problems import dotted
from datagen.settings.toml_lines import Location, place_in_file
from physics.response.oversampling import oversampling

MOST_LOOKED_AT = 20  # records of a part, one of which must be possible
SAMPLE_BYTES = 220.0  # that a simulated sample takes while its record is made (measured: 170 to 220)
COPIES = 4.0  # of what is stored of a record: as computed, as kept, in the dataset, in the file (measured: 2 to 4.5)
CONTAINER_LIMIT = Path("/sys/fs/cgroup/memory.max")


def require_possible_rates(recipe: Recipe, asked: Sequence[Span]) -> None:
    """Raise BadInput if, in any part, the sampling rate is too low for all of the first records asked for."""
    for part, records in zip(recipe.part, _first_of_parts(recipe, asked), strict=True):
        refusal = None
        for record in records:
            scenario = draw_scenario(recipe, record)
            problem = against_rate(scenario)
            if not problem:
                break
            allowed = f"about {math.ceil(lowest_rate(scenario))} Hz or more"
            problem = f'part "{part.name}": {problem}'
            refusal = refusal or _refusal(recipe, ("signal", "rate_hz"), problem, scenario.rate, allowed)
        else:
            if refusal is not None:
                raise refusal


def _first_of_parts(recipe: Recipe, asked: Sequence[Span]) -> list[list[int]]:
    """For each part the first records asked for, at most MOST_LOOKED_AT."""
    found: list[list[int]] = [[] for _ in recipe.part]
    lacking = len(found)
    for record in chain.from_iterable(range(*span) for span in asked):
        of_part = found[recipe.place(record).part]
        if len(of_part) < MOST_LOOKED_AT:
            of_part.append(record)
            lacking -= len(of_part) == MOST_LOOKED_AT
            if not lacking:
                break
    return found


def require_memory(recipe: Recipe) -> None:
    """Raise BadInput if even the shortest record of the recipe does not fit into memory; nothing is drawn."""
    rate, duration = recipe.signal.rate_hz.lowest, recipe.signal.duration_s.lowest
    _require_record(recipe, rate, duration, SAMPLE_BYTES * rate * (duration + recipe.signal.settle_s))


def require_record_memory(recipe: Recipe, scenario: Scenario, stored: tuple[str, ...]) -> None:
    """Raise BadInput if a record of `scenario` with the optional signals `stored` does not fit into memory."""
    _require_record(recipe, scenario.rate, scenario.duration, record_memory(scenario, stored))


def record_memory(scenario: Scenario, stored: tuple[str, ...]) -> float:
    """About how many bytes of memory a record takes while it is made."""
    factor = 1 if against_rate(scenario) else oversampling(scenario.scene, scenario.rate, scenario.chain.fastest)
    return SAMPLE_BYTES * scenario.simulated_samples * factor + COPIES * stored_bytes(scenario, stored, "none")


def require_room(recipe: Recipe, planned: Iterable[PlannedShard], folder: Path) -> None:
    """Raise BadInput if a shard does not fit into memory, or one of its records not onto the disk of a new `folder`."""
    shards = _one_of_each_size(planned)
    free = math.inf if manifest_path(folder).exists() else shutil.disk_usage(_existing(folder)).free
    for shard in shards:
        if shard.record_bytes > free:
            raise BadInput(
                f"one record needs about {bytes_text(shard.record_bytes)} of disk space; {bytes_text(free)} are free",
                field=OUT, value=str(folder), allowed="a folder on a larger disk, or shorter records",
            )  # fmt: skip
    require_shard_memory(recipe, shards)


def require_shard_memory(recipe: Recipe, planned: Iterable[PlannedShard]) -> None:
    """Raise BadInput if a shard, or one of its records, does not fit into memory.

    Only one shard of each size is looked at, and only its first record: drawing all of them again would take too long.
    """
    memory = memory_bytes()
    for shard in _one_of_each_size(planned):
        scenario = draw_scenario(recipe, shard.records[0])
        require_record_memory(recipe, scenario, shard.stored)
        left = memory - record_memory(scenario, shard.stored)
        if len(shard.records) * COPIES * shard.raw_bytes > left:
            need = bytes_text(len(shard.records) * COPIES * shard.raw_bytes)
            raise _refusal(
                recipe, ("store", "records_per_shard"),
                f"a shard of {len(shard.records)} records needs about {need} of memory, and this machine has "
                f"{bytes_text(memory)}",
                recipe.store.records_per_shard, f"at most {max(int(left / (COPIES * shard.raw_bytes)), 1)}",
            )  # fmt: skip


def _one_of_each_size(planned: Iterable[PlannedShard]) -> list[PlannedShard]:
    return list({(shard.record_bytes, shard.raw_bytes, len(shard.records)): shard for shard in planned}.values())


def _require_record(recipe: Recipe, rate: float, duration: float, need: float) -> None:
    memory, settling = memory_bytes(), recipe.signal.settle_s
    if need <= memory:
        return
    longest = (duration + settling) * memory / need  # s, what settles included
    setting, value, room = "duration_s", duration, f"{longest - settling:.2g} s"
    if longest <= settling:
        room = f"{longest:.2g} s, settle_s included,"
        if longest > duration:
            setting, value, room = "settle_s", settling, f"{longest - duration:.2g} s"
    begin = f" after {settling:g} s of settling" if settling else ""
    raise _refusal(
        recipe, ("signal", setting),
        f"a record of {rate * duration:.3g} samples{begin} needs about {bytes_text(need)} of memory, and this machine "
        f"has {bytes_text(memory)}",
        value, f"at most about {room} at {rate:g} Hz",
    )  # fmt: skip


def _refusal(recipe: Recipe, location: Location, problem: str, value: object, allowed: str) -> BadInput:
    return BadInput(
        problem,
        file=place_in_file(recipe.source, location),
        field=dotted(location),
        value=value,
        allowed=allowed,
    )


def memory_bytes() -> float:
    """The memory of this machine, or what its container may use of it."""
    whole = float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    try:
        return min(whole, float(CONTAINER_LIMIT.read_text()))
    except (OSError, ValueError):  # no container, or one without a limit
        return whole


def _existing(folder: Path) -> Path:
    return next(path for path in (folder.absolute(), *folder.absolute().parents) if path.exists())
