"""Which record goes into which shard: a function of the recipe alone, so that a run can stop and resume anywhere."""

from __future__ import annotations

import math
import time
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, replace
from operator import index

import numpy as np

from datagen.corpus_files.format import ZLIB_SHARE
from datagen.corpus_files.manifest import Span, add_spans
from datagen.errors import BadInput
from datagen.progress import Say, Throttle, ignore
from datagen.recipes.recipe import Recipe
from datagen.records.profile_grid import PROFILE_POINTS
from datagen.records.stiffness_axis import shard_key, stiffness_axis
from datagen.runs.rates import TooLowRates
from datagen.runs.redraws import RedrawCount
from datagen.runs.unseen_passes import UnseenPasses
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from labels.schema import LAYERS
from labels.variables import AXES, SIGNALS
from physics.words import STIFFNESS_COMPONENTS

# Bytes that a shard takes besides its signals and their axes: labels, tables, scenarios and the library's blocks.
SHARD_OVERHEAD = 300_000.0
# Compressed over raw size of the axes: they rise evenly.
ZLIB_SHARE_OF_AXES = 0.1
# s; a plan that takes longer reports how far it has got.
SECONDS_BETWEEN_REPORTS = 10.0


@dataclass(frozen=True)
class PlannedShard:
    """A shard of the whole corpus: its number, its records and the optional signals that they all store.

    `record_bytes` is about what the signals of one record take on the disk, `raw_bytes` about what they take in memory,
    `axis_bytes` what the axes of all of them take on the disk, and `record_seconds` the length of a record, s.
    """

    number: int
    records: tuple[int, ...]
    stored: tuple[str, ...]
    record_bytes: float
    raw_bytes: float
    axis_bytes: float
    record_seconds: float


def plan_shards(recipe: Recipe, stop: int, say: Say = ignore) -> list[PlannedShard]:
    """The shards that hold records 0 … `stop` − 1 of the recipe, the last ones perhaps not yet full.

    Records go, in their order, to the open shard of their kind (sampling, bearing size, stored signals), and a shard
    is closed when it holds `records_per_shard`: so a longer plan continues a shorter one. `say` is told the progress of
    a plan that takes long and, at the end, of impossible draws if they were many, of sampling rates that are too
    low and of ball passes that many records do not show. Raises BadInput if a record can hardly be drawn.
    """
    filled = _Filled(recipe)
    kinds_met: set[tuple[str, str]] = set()
    redraws, rates, unseen = RedrawCount(recipe), TooLowRates(), UnseenPasses()
    reports = Throttle(SECONDS_BETWEEN_REPORTS, time.monotonic() + SECONDS_BETWEEN_REPORTS)
    for record in range(stop):
        if reports.due(time.monotonic()):
            say(f"{record} of {stop} records are drawn; none is made before all are")
        scenario = draw_scenario(recipe, record)
        redraws.add(scenario)
        rates.add(scenario)
        unseen.add(scenario)
        kind = (scenario.rig, scenario.condition)
        filled.add(record, scenario, stored_signals(recipe, first_of_kind=kind not in kinds_met))
        kinds_met.add(kind)
    for sentence in filter(None, (redraws.sentence(), rates.sentence(), *unseen.sentences())):
        say(sentence)
    return filled.planned()


class _Filled:
    """Shards of a recipe, in the order of their first records; of each kind of record one at most is open."""

    def __init__(self, recipe: Recipe) -> None:
        self._store = recipe.store
        self._shards: list[PlannedShard] = []  # as yet without their records
        self._records: list[list[int]] = []  # of each shard
        self._open: dict[Hashable, int] = {}  # number of the open shard of a kind

    def add(self, record: int, scenario: Scenario, stored: tuple[str, ...]) -> None:
        """Put a record with these optional signals into the open shard of its kind, or else into a new one."""
        kind = (shard_key(scenario), stored)
        if kind not in self._open:
            self._open[kind] = len(self._shards)
            on_disk = stored_bytes(scenario, stored, self._store.compression)
            raw = stored_bytes(scenario, stored, "none")
            axes = _axis_bytes(scenario, stored, self._store.compression)
            self._shards.append(PlannedShard(len(self._shards), (), stored, on_disk, raw, axes, scenario.duration))
            self._records.append([])
        held = self._records[self._open[kind]]
        held.append(record)
        if len(held) == self._store.records_per_shard:
            del self._open[kind]

    def planned(self) -> list[PlannedShard]:
        """The shards with the records added so far."""
        return [replace(shard, records=tuple(held)) for shard, held in zip(self._shards, self._records, strict=True)]


def stored_signals(recipe: Recipe, *, first_of_kind: bool) -> tuple[str, ...]:
    """Names of the optional signals stored for a record, which may be the first of its rig and condition: a recipe may
    ask for the contact forces of these alone."""
    keep_force = recipe.store.contact_force == "first_of_each" and first_of_kind
    return signals_of_every_record(recipe) + (("contact_force",) if keep_force else ())


def signals_of_every_record(recipe: Recipe) -> tuple[str, ...]:
    """Names of the optional signals that the recipe asks for in every record."""
    store = recipe.store
    asked = {
        "acceleration_clean": store.clean,
        "acceleration_sensor": store.sensor,
        "background": store.background,
        "cage_angle": store.cage_angle,
        "profile_depth": store.profile,
        "contact_force": store.contact_force == "all",
    }
    return tuple(name for name, keep in asked.items() if keep)


def stored_bytes(scenario: Scenario, stored: tuple[str, ...], compression: str) -> float:
    """About how many bytes the signals of one record need on the disk; with `compression` "none", in memory too."""
    bearing = scenario.scene.rig.bearing
    sizes = {
        "record": 1,
        "time": scenario.samples,
        "axis": len(AXES),
        "component": len(STIFFNESS_COMPONENTS),
        "layer": len(LAYERS),
        "stiffness_time": stiffness_axis(scenario).size,
        "profile_angle": PROFILE_POINTS,
        "row": bearing.rows,
        "ball": bearing.balls,
    }
    total = 0.0
    for signal in SIGNALS:
        if signal.required(imported=False) or signal.name in stored:
            raw = math.prod(sizes[dim] for dim in signal.dims) * np.dtype(signal.dtype).itemsize
            total += raw * (ZLIB_SHARE[signal.name] if compression == "zlib" else 1.0)
    return total


def _axis_bytes(scenario: Scenario, stored: tuple[str, ...], compression: str) -> float:
    """About how many bytes the long axes of the signals need in a shard: time, stiffness_time and profile_angle."""
    nodes = scenario.samples + stiffness_axis(scenario).size + (PROFILE_POINTS if "profile_depth" in stored else 0)
    return 8.0 * nodes * (ZLIB_SHARE_OF_AXES if compression == "zlib" else 1.0)


def needed_bytes(shards: Sequence[PlannedShard]) -> float:
    """About how many bytes the shards need on the disk."""
    return sum(SHARD_OVERHEAD + shard.axis_bytes + len(shard.records) * shard.record_bytes for shard in shards)


def longest_first(shards: Iterable[PlannedShard]) -> list[PlannedShard]:
    """The shards in the order that lets several workers finish together: most seconds of signal first."""
    return sorted(shards, key=lambda shard: len(shard.records) * shard.record_seconds, reverse=True)


def selection(recipe: Recipe, limit: int | None, records: Sequence[int] | None) -> tuple[Span, ...]:
    """Spans [start, stop) of the records that a run is asked for: all, the first `limit`, or those listed.

    Raises BadInput for a limit below 1, an empty list, a mask, a record that the recipe does not have, or both at once.
    """
    if limit is not None and records is not None:
        raise BadInput("give only one of them: a limit or a list of records", field="--limit, --records")
    if records is not None:
        if any(isinstance(record, bool | np.bool_) for record in records):
            raise BadInput("this is a mask", field="--records", allowed="the indices of records")
        listed = [index(record) for record in records]
        if not listed:
            raise BadInput("no record is listed", field="--records")
        for record in listed:
            recipe.require(record, "--records")
        return add_spans((), ((record, record + 1) for record in listed))
    if limit is None:
        return ((0, recipe.count),)
    if limit < 1:
        raise BadInput(field="--limit", value=limit, allowed="1 or more")
    return ((0, min(index(limit), recipe.count)),)
