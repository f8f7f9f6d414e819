"""One run over one corpus folder, from its first manifest to its summary."""

from __future__ import annotations

import errno
import json
import shutil
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from datagen.corpus_files.format import Identity
from datagen.corpus_files.index import write_index
from datagen.corpus_files.manifest import Manifest, Span, write_manifest
from datagen.corpus_files.shard import Failure, sweep_unfinished
from datagen.counts import bytes_text, counted
from datagen.files.atomic import NO_SPACE, write_atomically
from datagen.files.places import FAILURES
from datagen.files.temporary import NoTemporaryRoom
from datagen.progress import Listener
from datagen.recipes.recipe import Recipe
from datagen.runs.finished import Finished, find_finished
from datagen.runs.plan import PlannedShard, longest_first, needed_bytes
from datagen.runs.task import make_shard
from datagen.runs.workers import WorkerLost, run_tasks
from datagen.versions import program_versions

NO_INDEX = "the disk is full: no room for the index; the same command continues from there"
ATTEMPTS_TOGETHER = 2
LONGEST_TASK_BASE = 600.0
LONGEST_TASK_FACTOR = 30.0


@dataclass(frozen=True)
class Summary:
    """How a run ended: `asked` records were wanted, `made` of them are in the corpus, `new` were made by this run.

    `failed` could not be made; `problem` is a sentence if the run stopped before its end. `bytes` is the size of all
    shards of the corpus, `seconds` wall time of this run.
    """

    folder: str
    asked: int
    made: int
    new: int
    failed: tuple[Failure, ...]
    problem: str
    bytes: int
    seconds: float

    @property
    def complete(self) -> bool:
        """True if every record asked for is in the corpus."""
        return self.made == self.asked


class Run:
    """One run that makes the `wanted` records in `folder`; `asked` are those of all runs so far, this one included.

    Call `make`, then, whatever happened, `finish`.
    """

    def __init__(
        self,
        recipe: Recipe,
        folder: Path,
        identity: Identity,
        asked: tuple[Span, ...],
        wanted: tuple[Span, ...],
        listener: Listener,
    ) -> None:
        self.recipe, self.folder, self.listener = recipe, folder, listener
        self.wanted = frozenset(record for start, stop in wanted for record in range(start, stop))
        self.manifest = Manifest(
            name=recipe.name,
            identity=identity,
            recipe=recipe.model_dump(mode="json"),
            recipe_records=recipe.count,
            asked=asked,
            made_with=program_versions(),
        )
        self.errors: dict[int, tuple[PlannedShard, str]] = {}
        self.finished = Finished(folder)
        self.made_before = 0
        self.done = 0
        self.problem = ""

    def make(self, planned: Sequence[PlannedShard]) -> None:
        """Make every planned shard that is not finished; what cannot be made is remembered, not raised."""
        try:
            self._begin()
            self._make_missing(planned)
        except OSError as problem:
            if problem.errno not in NO_SPACE:
                raise
            self.problem = self._out_of_space(problem, self._lacking(planned))
        except NoTemporaryRoom as problem:
            self.problem = f"{problem}; {_left_to_make(self._lacking(planned))}"

    def _lacking(self, planned: Sequence[PlannedShard]) -> list[PlannedShard]:
        """What is not made, by what is on the disk now."""
        self._rescan()
        return self.finished.lacking(planned, self.wanted)

    def _begin(self) -> None:
        """Sweep what killed writers left, and write the manifest, so that an interrupted folder says what it is."""
        sweep_unfinished(self.folder)
        self._rescan()
        self.made_before = self.finished.made_of(self.wanted)
        write_manifest(self.folder, self.manifest)

    def _make_missing(self, planned: Sequence[PlannedShard]) -> None:
        todo = self.finished.lacking(planned, self.wanted)
        self._count_done(todo)
        if not todo:
            self.listener.say(
                "all records asked for exist already, in files of the right size; `spallgen check` reads them"
            )
            return
        self._announce(todo)
        self.listener.advance(self.done, len(self.wanted))
        self._make_persistently(todo)

    def finish(self) -> None:
        """Rebuild manifest, index and the list of failures from the finished shards; call it once workers are gone.

        What interrupted workers left behind is deleted: a shard without its sidecar would be read by anyone who opens
        all files of the folder.
        """
        sweep_unfinished(self.folder)
        self._rescan()
        try:
            # The manifest first: a folder with an index alone would be taken for somebody else's.
            write_manifest(self.folder, self.manifest)
            write_index(self.folder, self.finished.by_first_record())
            self._write_failures()
        except OSError as problem:
            if problem.errno not in NO_SPACE:
                raise
            self.problem = self.problem or NO_INDEX

    def summary(self, seconds: float) -> Summary:
        """The summary of the run, which took `seconds`."""
        made = self.finished.made_of(self.wanted)
        return Summary(
            folder=str(self.folder),
            asked=len(self.wanted),
            made=made,
            new=max(made - self.made_before, 0),
            failed=tuple(failure for failure in self._failures() if failure.record in self.wanted),
            problem=self.problem,
            bytes=self.manifest.bytes,
            seconds=round(seconds, 3),
        )

    def _rescan(self) -> None:
        """Find out what is finished, from the disk alone."""
        self.finished = find_finished(self.folder, self.manifest.identity)
        self.manifest = self.manifest.with_shards(self.finished.shards.values())

    def _wanted_of(self, shard: PlannedShard) -> int:
        return len(self.wanted.intersection(shard.records))

    def _announce(self, todo: Sequence[PlannedShard]) -> None:
        needed, free = needed_bytes(todo), shutil.disk_usage(self.folder).free
        records = counted(sum(len(shard.records) for shard in todo), "record")
        warning = "" if needed < free else ": the disk will be full before the end"
        self.listener.say(
            f"{records} in {counted(len(todo), 'shard')} to make; they will need about {bytes_text(needed)} of disk "
            f"space, {bytes_text(free)} are free{warning}"
        )

    def _make_persistently(self, todo: list[PlannedShard]) -> None:
        """Make the shards together; if workers keep dying, make those under way one by one, to find the culprit."""
        losses = 0
        while todo:
            started: set[int] = set()
            try:
                self._make_together(todo, started)
                return
            except WorkerLost as loss:
                self.listener.say(f"a worker was lost ({loss}); continuing with what is missing")
            losses += 1
            todo = self._still(todo)
            if losses % ATTEMPTS_TOGETHER == 0:
                for shard in [shard for shard in todo if shard.number in started] or todo[:1]:
                    self._make_alone(shard)
                todo = self._still(todo)

    def _still(self, todo: Sequence[PlannedShard]) -> list[PlannedShard]:
        """Those of `todo` that are neither on the disk nor given up; all others count as done, also those of which a
        lost worker brought no word."""
        self._rescan()
        still = [shard for shard in self.finished.lacking(todo, self.wanted) if shard.number not in self.errors]
        self._count_done(still)
        self.listener.advance(self.done, len(self.wanted))
        return still

    def _count_done(self, todo: Sequence[PlannedShard]) -> None:
        self.done = len(self.wanted) - sum(self._wanted_of(shard) for shard in todo)

    def _make_alone(self, shard: PlannedShard) -> None:
        try:
            self._make_together([shard], set())
        except WorkerLost as loss:
            self.errors[shard.number] = (shard, f"its worker was lost every time ({loss})")
            self.listener.say(f"shard {shard.number} is given up: its worker was lost every time")

    def _make_together(self, todo: Sequence[PlannedShard], started: set[int]) -> None:
        """Make the shards, longest first; `started` collects the numbers of those handed to workers."""
        by_number = {shard.number: shard for shard in todo}
        with closing(run_tasks(make_shard, self._tasks(longest_first(todo), started), _time_limit(todo))) as rows:
            for row in rows:
                shard = by_number[row.shard]
                if row.error:
                    self.errors[row.shard] = (shard, row.error)
                    self.listener.say(f"shard {row.shard} could not be made: {row.error.strip().splitlines()[-1]}")
                self.done += self._wanted_of(shard)
                self.listener.advance(self.done, len(self.wanted))

    def _tasks(self, todo: Sequence[PlannedShard], started: set[int]) -> Iterator[tuple[Any, ...]]:
        folder = self.folder.absolute()
        for shard in todo:
            started.add(shard.number)
            yield self.recipe, folder, shard, self.manifest.identity

    def _out_of_space(self, problem: OSError, todo: Sequence[PlannedShard]) -> str:
        if not todo:
            return NO_INDEX
        missing = max(needed_bytes(todo) - shutil.disk_usage(self.folder).free, 0.0)
        largest = max(needed_bytes([shard]) for shard in todo)
        cause, needed = {
            errno.EFBIG: ("files may not be as large as a shard here (ulimit -f)", f"files of {bytes_text(largest)}"),
            errno.EDQUOT: ("the quota of this disk is used up", bytes_text(needed_bytes(todo))),
        }.get(problem.errno or 0, ("the disk is full", f"{bytes_text(missing)} more"))
        return f"{cause}: {_left_to_make(todo, f', and about {needed} are needed')}"

    def _failures(self) -> list[Failure]:
        """The records that could not be made, by index. Of a shard that failed an earlier file may hold some records,
        which then are not among them."""
        lost = [
            Failure(record, reason)
            for shard, reason in self.errors.values()
            for record in sorted(frozenset(shard.records) - self.finished.settled_of(shard))
        ]
        return sorted((*self.manifest.failed, *lost), key=lambda failure: failure.record)

    def _write_failures(self) -> None:
        path = self.folder / FAILURES
        failures = self._failures()
        if failures:
            write_atomically(path, "".join(f"{json.dumps(asdict(failure))}\n" for failure in failures).encode())
        else:
            path.unlink(missing_ok=True)


def _time_limit(todo: Sequence[PlannedShard]) -> float:
    """Seconds far above what any of the shards can take."""
    longest = max(len(shard.records) * shard.record_seconds for shard in todo)
    return LONGEST_TASK_BASE + LONGEST_TASK_FACTOR * longest


def _left_to_make(todo: Sequence[PlannedShard], needed: str = "") -> str:
    """What a run that stopped before its end leaves to the next, and what that needs."""
    records = sum(len(shard.records) for shard in todo)
    not_made = f"{counted(records, 'record')} {'has' if records == 1 else 'have'} not been made"
    return f"{not_made}{needed}; finished shards are kept; the same command continues from there"
