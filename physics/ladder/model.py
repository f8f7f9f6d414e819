"""What every simpler model states of itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from physics.scene import Scene
from physics.trace import Kept, Trace


@dataclass(frozen=True)
class Model:
    """One model of the ladder: `respond(scene, rate, keep)` gives its Trace.

    `computes` says what its response holds, `holds_where` in which scenes that is near the nonlinear model's, and
    `leaves_out` what it cannot show; `rings` if its response has the modes, which take a rate that holds them;
    `keeps`: which fields of Kept its Trace can have.
    """

    name: str
    computes: str
    holds_where: str
    leaves_out: str
    rings: bool
    keeps: tuple[str, ...]
    respond: Callable[[Scene, float, Kept], Trace]
