"""The word somebody probably meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The known word closest to `word`, or None if nothing comes near."""
    found = difflib.get_close_matches(word, list(known), n=1, cutoff=0.5)
    return found[0] if found else None


def suggestion(word: str, known: Iterable[str]) -> str:
    """A closing remark such as `; did you mean "depth_um"?`, empty if nothing comes near."""
    match = nearest(word, known)
    return f'; did you mean "{match}"?' if match else ""
