"""SIGTERM ends a command as Ctrl-C does: by an exception, so that workers stop and nothing is left half-written."""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

# Signals of one request come within this time (s), and what tidies up after the first is done by then.
TOGETHER = 10.0


class Terminated(KeyboardInterrupt):
    """SIGTERM was received; whatever tidies up after Ctrl-C does so after this too."""


@contextmanager
def terminable() -> Iterator[None]:
    """Within the block SIGTERM raises Terminated in the main thread; those that come TOGETHER with one are ignored:
    batch systems send several, and tidying up must not be interrupted. A later one raises it again, as Python drops an
    exception that is raised while an object is being finalised. Afterwards SIGTERM does what it did before.

    Nothing is changed if SIGTERM already has a handler or is ignored, or outside the main thread.
    """
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) != signal.SIG_DFL:
        yield
        return
    raised = -math.inf

    def end(number: int, frame: FrameType | None) -> None:
        nonlocal raised
        now = time.monotonic()
        if now - raised > TOGETHER:
            raised = now
            raise Terminated

    signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
