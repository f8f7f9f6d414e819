"""Numbers of bytes, of things and of other units as people read them."""

from __future__ import annotations

import math
from collections.abc import Mapping

from labels.interval import Interval


def bytes_text(count: float) -> str:
    """A number of bytes in MB or GB, whichever suits it, with one decimal."""
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{count / 1e6:.1f} MB"


def counted(count: int, what: str, ending: str = "s") -> str:
    """A number of things, as "1 record" or "2 records"; `ending` makes more than one of `what`."""
    return f"{count} {what}" if count == 1 else f"{count} {what}{ending}"


def by_value(counts: Mapping[str, int]) -> str:
    """How often each value occurs, as "outer 3, (none) 2", where (none) is an empty text."""
    return ", ".join(f"{value or '(none)'} {count}" for value, count in counts.items())


def bracketed(interval: Interval) -> str:
    """The ends of an interval in brackets, after a space; nothing where it has none."""
    return f" [{interval.low:.3f}, {interval.high:.3f}]" if math.isfinite(interval.low) else ""


def digits(value: float, count: int) -> str:
    """A value with so many digits, or with all before the point where these are more: no power of ten for what is large
    and finite."""
    return f"{value:.0f}" if abs(value) >= 10**count - 0.5 else f"{value:.{count}g}"
