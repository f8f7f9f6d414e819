"""What is asked of a response to a stated accuracy."""

from __future__ import annotations

from dataclasses import dataclass

from physics.scene import Scene
from physics.statics.load_distribution import Equilibrium


@dataclass(frozen=True)
class Asked:
    """A response of `scene` at k / `rate` (Hz), so many `samples`, from the first of its positions at `rest`,
    to the relative RMS `accuracy` or to `least_error` (m/s², RMS), which is always allowed; over paths with a
    `fineness` times as many cells as usual."""

    scene: Scene
    rest: Equilibrium
    rate: float
    samples: int
    accuracy: float
    least_error: float = 0.0
    fineness: int = 1
