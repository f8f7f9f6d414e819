"""How a machine is run: speed, static load, and loads that turn with the shaft."""

from __future__ import annotations

from dataclasses import dataclass

from physics.checks import require_angle, require_between, require_not_negative, require_positive

# N, far beyond all bearings.
HEAVIEST_LOAD = 1e7
LARGEST_FLUCTUATION = 10.0


@dataclass(frozen=True)
class Operation:
    """Constant shaft speed (rad/s) and static load W along −y (N), with optional loads of shaft order.

    `unbalance_force` (N) turns with the shaft at angle ωs t + `unbalance_phase`; `load_fluctuation` (share of W) scales
    the static load by 1 + share · cos(ωs t + `fluctuation_phase`). InvalidParameter unless the speed is above 0, the
    load within ±1e7 N, the unbalance force not below 0 and the fluctuation from 0 to 10.
    """

    shaft_speed: float
    load: float
    unbalance_force: float = 0.0
    unbalance_phase: float = 0.0
    load_fluctuation: float = 0.0
    fluctuation_phase: float = 0.0

    def __post_init__(self) -> None:
        require_positive("shaft_speed", self.shaft_speed, "rad/s")
        require_between("load", self.load, -HEAVIEST_LOAD, HEAVIEST_LOAD, "N")
        require_not_negative("unbalance_force", self.unbalance_force, "N")
        require_angle("unbalance_phase", self.unbalance_phase)
        require_between("load_fluctuation", self.load_fluctuation, 0.0, LARGEST_FLUCTUATION)
        require_angle("fluctuation_phase", self.fluctuation_phase)

    @property
    def load_bound(self) -> float:
        """A force (N) that static load, fluctuation and unbalance together never exceed."""
        return abs(self.load) * (1.0 + self.load_fluctuation) + self.unbalance_force
