"""What a perfect bearing lacks: waviness of the races and balls of unequal diameter."""

from __future__ import annotations

from dataclasses import dataclass

from physics.bearing import RACES
from physics.checks import (
    require_angle,
    require_between,
    require_count,
    require_one_of,
    require_up_to,
    settle_tuples,
)

# m, far beyond a race that is still one.
HIGHEST_WAVE = 1e-2
HIGHEST_ORDER = 2000
LARGEST_DEVIATION = 1e-3  # m, of a ball's diameter, of either sign


@dataclass(frozen=True)
class Waviness:
    """One harmonic of a race: depth(ψ) = amplitude · cos(order · ψ + phase), ψ the angle on that race at t = 0.

    Positive depth is material missing (it relieves the ball), like the depth of a spall. Applies to every row.
    InvalidParameter unless `race` is "outer" or "inner", `order` a whole number from 1 to 2000 and the amplitude above
    0, 10 mm at most.
    """

    race: str
    order: int
    amplitude: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        require_one_of("race", self.race, RACES)
        require_count("order", self.order, 1, HIGHEST_ORDER)
        require_up_to("amplitude", self.amplitude, HIGHEST_WAVE, "m", f"amplitude of order {self.order}")
        require_angle("phase", self.phase)


@dataclass(frozen=True)
class Imperfections:
    """Departures from a perfect healthy bearing; all absent by default.

    `ball_deviation[r][j]` is the diameter of ball j + 1 on row r + 1 minus the nominal one (m), which adds to the
    compression along the contact normal; empty means equal balls. InvalidParameter if a deviation is beyond ±1 mm.
    """

    waviness: tuple[Waviness, ...] = ()
    ball_deviation: tuple[tuple[float, ...], ...] = ()

    def __post_init__(self) -> None:
        settle_tuples(self, "waviness", "ball_deviation")
        for row in self.ball_deviation:
            for deviation in row:
                require_between("ball_deviation", deviation, -LARGEST_DEVIATION, LARGEST_DEVIATION, "m")
