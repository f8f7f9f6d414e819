"""Which records an import will write, and into which shards; each has been read, and checked against all before it."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from functools import cached_property

from datagen.errors import BadInput
from datagen.recordings.doubts import turns_doubt
from datagen.recordings.listing import Request
from datagen.recordings.recorded import Key, Recorded, read_recording
from datagen.recordings.spec import Spec
from labels.schema import UNKNOWN

# Bytes of signals that a shard holds at most, unless one recording alone has more.
MOST_SHARD_BYTES = 64e6


@dataclass(frozen=True)
class PlannedRecord:
    """A record whose samples have been checked and are no longer in memory: `piece` of `request`, with its `index`.

    `content` is the hash by which its samples are recognised when they are read again, and `band` (Hz) that of its
    envelope, which takes long to find.
    """

    index: int
    request: Request
    piece: int
    key: Key
    bytes: int
    content: str
    band: tuple[float, float]


class ImportPlan:
    """The records found so far, none of them twice, and the shards they go into."""

    def __init__(self, spec: Spec) -> None:
        self.spec = spec
        self.records: list[PlannedRecord] = []
        self.skipped: list[str] = []
        self.dead: list[str] = []
        self.doubts: dict[str, list[str]] = {}
        self.fewest_turns, self.few_turns = math.inf, ""
        self.names: dict[str, str] = {}
        self.contents: dict[str, str] = {}
        self.splits: dict[str, str] = {}

    def add(self, request: Request) -> None:
        """Read the records of a request, check them against all before, and keep what is needed to read them again."""
        for piece, record in enumerate(read_recording(request)):
            if self._is_new(record, request):
                self._check_split(record, request)
                self._doubt(record, request)
                band = record.labels["envelope_band"]
                self.records.append(
                    PlannedRecord(len(self.records), request, piece, record.key, record.bytes, record.content, band)
                )

    def _doubt(self, record: Recorded, request: Request) -> None:
        """Remember what is odd about a record."""
        name = record.labels["recording"]
        if record.dead:
            self.dead.append(f"{name} ({', '.join(record.dead)})")
        for doubt, figures in record.doubts.items():
            self.doubts.setdefault(doubt, []).append(f"{name} ({figures})" if figures else name)
        if record.turns < self.fewest_turns:
            self.fewest_turns = record.turns
            self.few_turns = turns_doubt(record.turns, record.labels, request.settings)

    def _is_new(self, record: Recorded, request: Request) -> bool:
        name, where = record.labels["recording"], f"{request.name} ({request.place})"
        if name in self.names:
            raise BadInput(
                f"this name is already taken by {self.names[name]}", file=request.place, field="recording", value=name,
                allowed='a different name for each record, as in recording = "{path} {channel}"',
            )  # fmt: skip
        self.names[name] = where
        if record.dead == record.axes:
            return True  # all that is dead looks alike, and need be no repeat
        twin = self.contents.setdefault(record.content, name)
        if twin == name or self.spec.same_samples == "keep":
            return True
        if self.spec.same_samples == "refuse":
            raise BadInput(
                f'record "{name}" has exactly the samples of "{twin}", {self.names[twin]}', file=str(request.path),
                field="same_samples", value="refuse", allowed='"skip", which leaves such repeats out, or "keep"',
            )  # fmt: skip
        self.skipped.append(name)
        return False

    def _check_split(self, record: Recorded, request: Request) -> None:
        bearing, split = record.labels["bearing_id"], record.labels["split"]
        if bearing != UNKNOWN and self.splits.setdefault(bearing, split) != split:
            problem = f"the records of bearing {bearing} would be in the splits {self.splits[bearing]} and {split}"
            raise BadInput(
                problem, file=request.place, field="split", value=split, allowed="one split for each bearing"
            )

    @cached_property
    def shards(self) -> list[list[PlannedRecord]]:
        """The records by shard: of one kind, in order, up to 64 MB together."""
        shards: list[list[PlannedRecord]] = []
        growing: dict[Key, list[PlannedRecord]] = {}
        held: Counter[Key] = Counter()  # bytes of the growing shard of a kind
        for planned in self.records:
            key = planned.key
            if key not in growing or held[key] + planned.bytes > MOST_SHARD_BYTES:
                growing[key], held[key] = [], 0
                shards.append(growing[key])
            growing[key].append(planned)
            held[key] += planned.bytes
        return shards
