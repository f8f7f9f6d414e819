"""SIGTERM ends a command as Ctrl-C does: by an exception, so that workers stop and nothing is left half-written."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class Terminated(KeyboardInterrupt):
    """SIGTERM was received; whatever tidies up after Ctrl-C does so after this too."""


@contextmanager
def terminable() -> Iterator[None]:
    """Within the block the first SIGTERM raises Terminated in the main thread, and later ones are ignored: batch
    systems send several, and tidying up must not be interrupted. Afterwards SIGTERM does what it did before.

    Nothing is changed if SIGTERM already has a handler or is ignored, or outside the main thread.
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
