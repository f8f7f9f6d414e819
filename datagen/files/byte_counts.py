"""Numbers of bytes as people read them."""

from __future__ import annotations


def bytes_text(count: float) -> str:
    """A number of bytes in MB or GB, whichever suits it, with one decimal."""
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{count / 1e6:.1f} MB"
