"""The finished shards of a corpus folder, and what they lack of a plan."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from datagen.corpus_files.format import Identity
from datagen.corpus_files.shard import Sidecar, is_whole, read_sidecar, sidecar_path, sidecars
from datagen.runs.plan import PlannedShard


@dataclass(frozen=True)
class Finished:
    """The finished shards of a `folder`: their sidecars by number, without labels, which would fill the memory.

    `torn` has those of shards whose file is another one: a run that was to replace it was killed before it had written
    the sidecar too, or something outside has damaged it.
    """

    folder: Path
    shards: Mapping[int, Sidecar] = field(default_factory=dict)
    torn: Mapping[int, Sidecar] = field(default_factory=dict)

    def made_of(self, wanted: frozenset[int]) -> int:
        """How many of the `wanted` records they hold."""
        return sum(len(wanted.intersection(sidecar.records)) for sidecar in self.shards.values())

    def settled_of(self, shard: PlannedShard) -> frozenset[int]:
        """The records that the file of a planned shard settles, made or failed."""
        return self.shards[shard.number].settled if shard.number in self.shards else frozenset()

    def lacking(self, planned: Sequence[PlannedShard], wanted: Collection[int]) -> list[PlannedShard]:
        """Planned shards that lack a wanted record, each with all the records that it must then hold: these, and what
        it held before."""
        todo = []
        for shard in planned:
            there = self.settled_of(shard)
            if any(record in wanted and record not in there for record in shard.records):
                held = there | (self.torn[shard.number].settled if shard.number in self.torn else frozenset())
                records = tuple(record for record in shard.records if record in wanted or record in held)
                todo.append(replace(shard, records=records))
        return todo

    def by_first_record(self) -> Iterator[Sidecar]:
        """The sidecars, read again with their labels, by first record: where records were picked out, shard numbers do
        not follow the order of the records."""
        for known in sorted(self.shards.values(), key=lambda sidecar: min(sidecar.settled)):
            sidecar = read_sidecar(sidecar_path(self.folder, known.shard))
            if sidecar is not None:
                yield sidecar


def find_finished(folder: Path, identity: Identity) -> Finished:
    """The shards of that `identity` that are finished in `folder`, found from the disk alone."""
    own = [replace(sidecar, labels={}) for sidecar in sidecars(folder) if sidecar.identity == identity]
    whole = {sidecar.shard: sidecar for sidecar in own if is_whole(folder, sidecar)}
    return Finished(folder, whole, {sidecar.shard: sidecar for sidecar in own if sidecar.shard not in whole})
