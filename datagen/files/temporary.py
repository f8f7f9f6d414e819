"""The folder of temporary files: what to say if a file cannot be put there, and whether any other could be."""

from __future__ import annotations

import shutil
from tempfile import gettempdir

from datagen.counts import bytes_text
from datagen.errors import BadInput
from datagen.files.atomic import NO_SPACE
from datagen.files.places import is_writable


class NoTemporaryRoom(BadInput):
    """The folder of temporary files has no room for a file, or none can be made there: the next one fares no better."""


def no_temporary_file(problem: Exception, needed: float, allowed: str) -> BadInput:
    """The error of a file of about `needed` bytes that could not be laid out among the temporary ones for this
    `problem`: NoTemporaryRoom where the folder is to blame, and not the file.

    `allowed` says in words for what there must be room.
    """
    try:
        folder = gettempdir()
        free = float(shutil.disk_usage(folder).free)
    except OSError:  # there is none
        return NoTemporaryRoom(_said("", problem), field="TMPDIR", allowed=allowed)
    full = free < needed or getattr(problem, "errno", None) in NO_SPACE or not is_writable(folder)
    kind = NoTemporaryRoom if full else BadInput
    return kind(_said(f", in which {bytes_text(free)} are free", problem), file=folder, field="TMPDIR", allowed=allowed)


def _said(free: str, problem: Exception) -> str:
    return f"a file cannot be laid out in this folder of temporary files{free} ({problem})"
