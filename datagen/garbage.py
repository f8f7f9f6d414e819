"""Looking for garbage less often than Python does by itself."""

from __future__ import annotations

import gc

# Objects more than were freed since the last look at the youngest, and looks after which older ones are looked at too.
# To load the packages of a run makes hundreds of thousands of objects and no garbage: with Python's own 700 a tenth of
# the start goes into finding none.
OBJECTS, LOOKS = 50_000, 20


def collect_seldom() -> None:
    """Let this process look for garbage seldom; what no circle of references holds is freed at once, as ever."""
    gc.set_threshold(OBJECTS, LOOKS, LOOKS)
