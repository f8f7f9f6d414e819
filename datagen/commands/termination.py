"""SIGTERM ends a command as Ctrl-C does: by an exception, so that workers stop and nothing is left half-written."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class Terminated(KeyboardInterrupt):
    """SIGTERM came; whatever tidies up after Ctrl-C does so after this too."""


@contextmanager
def terminable() -> Iterator[None]:
    """In the block the first SIGTERM raises Terminated in the main thread, and those that follow do nothing: batch
    systems send several, and tidying up must not be interrupted. Afterwards SIGTERM does what it did before.

    Where somebody else handles or ignores it, and outside the main thread, it is left to them.
    """
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) != signal.SIG_DFL:
        yield
        return
    came = False

    def end(number: int, frame: FrameType | None) -> None:
        nonlocal came
        if not came:
            came = True
            raise Terminated

    signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
