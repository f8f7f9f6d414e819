"""Progress shown to a person: a bar or one changing line on a terminal, plain lines every few seconds elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from datagen.progress import Listener, Throttle

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

SECONDS_BETWEEN_LINES = 2.0
CLEARED = "\r\033[K"


class Lines:
    """How many records are done, for pipes and logs: one plain line every few seconds, on standard error."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._began: float | None = None
        self._first = 0
        self._throttle = Throttle(SECONDS_BETWEEN_LINES)

    def say(self, sentence: str) -> None:
        """Print the sentence."""
        print(sentence, file=sys.stderr, flush=True)

    def advance(self, done: int, total: int) -> None:
        """Print the state with rate and remaining time, unless a line was printed a moment ago."""
        now = self._clock()
        if self._began is None:
            self._began, self._first = now, done
        if not self._throttle.due(now) and done < total:
            return
        rate = (done - self._first) / (now - self._began) if now > self._began else 0.0
        pace = f", {rate:.2f} records/s, {(total - done) / rate:.0f} s left" if rate > 0.0 else ""
        self.say(f"{done} of {total} records{pace}")


class Bar:
    """How many records are done, for a terminal: a bar with rate and remaining time, on standard error."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._task: TaskID | None = None

    def say(self, sentence: str) -> None:
        """Print the sentence above the bar."""
        self._progress.console.print(sentence, highlight=False, markup=False, emoji=False)

    def advance(self, done: int, total: int) -> None:
        """Move the bar."""
        if self._task is None:
            self._task = self._progress.add_task("records", total=total, rate="")
            self._progress.advance(self._task, done)  # of an earlier run: a first step says nothing of the pace
        speed = self._progress.tasks[0].speed
        self._progress.update(self._task, completed=done, rate=f"{speed:.2f} records/s" if speed else "")


@contextmanager
def show_records() -> Iterator[Listener]:
    """A listener, for the block, that shows how many records are done: a bar on a terminal, plain lines elsewhere."""
    if not sys.stderr.isatty():
        lines = Lines()
        yield Listener(say=lines.say, advance=lines.advance)
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
        TimeElapsedColumn(),  # moves on while a single slow record is made
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        bar = Bar(progress)
        yield Listener(say=bar.say, advance=bar.advance)


class Steps:
    """Which of many named steps is under way: on a terminal one line that changes, elsewhere a plain line every few
    seconds, on standard error."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._on_terminal = sys.stderr.isatty()
        self._throttle = Throttle(SECONDS_BETWEEN_LINES)

    def step(self, step: str) -> None:
        """Show the step."""
        if self._on_terminal:
            print(f"{CLEARED}{step}", end="", file=sys.stderr, flush=True)
        elif self._throttle.due(self._clock()):
            print(step, file=sys.stderr, flush=True)

    def say(self, sentence: str) -> None:
        """Print a sentence that stays, on standard output."""
        self.clear()
        print(sentence, flush=True)

    def clear(self) -> None:
        """Take the changing line away."""
        if self._on_terminal:
            print(CLEARED, end="", file=sys.stderr, flush=True)


@contextmanager
def show_steps(clock: Callable[[], float] = time.monotonic) -> Iterator[Listener]:
    """A listener, for the block, that shows the step under way; the changing line is gone afterwards."""
    steps = Steps(clock)
    try:
        yield Listener(say=steps.say, step=steps.step)
    finally:
        steps.clear()
