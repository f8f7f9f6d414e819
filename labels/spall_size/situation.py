"""What the person who asks for a size knows of the machine."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from physics.bearing import RACES, Bearing
from physics.checks import require_not_negative, require_one_of, require_positive
from physics.hertz import BALL_EXPONENT

# Hertz factor of the bearing where none is known, N/mⁿ: it only has to be above 0.
PLACEHOLDER_FACTOR = 1e10


@dataclass(frozen=True)
class Situation:
    """Geometry and shaft speed (rad/s, to about ±2 %) of a recorded bearing, SI units.

    `load` (N) and `load_deflection` (N/mⁿ, the Hertz factor) make the size more accurate, `race` ("outer", "inner")
    spares finding it out; each is None if unknown. `polarity_known` is False if a push upwards may show as a negative
    acceleration. Raises InvalidParameter for a shaft speed or a Hertz factor that is not above 0, a negative load,
    another race or a bearing that cannot be.
    """

    balls: int
    rows: int
    pitch_diameter: float
    ball_diameter: float
    shaft_speed: float
    contact_angle: float = 0.0
    load: float | None = None
    load_deflection: float | None = None
    exponent: float = BALL_EXPONENT
    race: str | None = None
    polarity_known: bool = True

    def __post_init__(self) -> None:
        require_positive("shaft_speed", self.shaft_speed, "rad/s")
        if self.load is not None:
            require_not_negative("load", self.load, "N")
        if self.race is not None:
            require_one_of("race", self.race, RACES)
        self.bearing()

    def bearing(self) -> Bearing:
        """The bearing; without a Hertz factor its stiffness means nothing."""
        return Bearing(
            name="recorded",
            balls=self.balls,
            rows=self.rows,
            pitch_diameter=self.pitch_diameter,
            ball_diameter=self.ball_diameter,
            load_deflection=PLACEHOLDER_FACTOR if self.load_deflection is None else self.load_deflection,
            exponent=self.exponent,
            contact_angle=self.contact_angle,
        )

    @property
    def load_known(self) -> bool:
        """True if the release arc can be computed."""
        return self.load is not None and self.load > 0.0 and self.load_deflection is not None

    def without_load(self) -> Situation:
        """What is left of it for whoever knows neither load nor Hertz factor."""
        return replace(self, load=None, load_deflection=None, exponent=BALL_EXPONENT)

    def pass_periods(self) -> dict[str, float]:
        """Nominal time between two ball passes for each race that comes into question, s."""
        bearing = self.bearing()
        orders = {"outer": bearing.bpfo, "inner": bearing.bpfi}
        chosen = orders if self.race is None else {self.race: orders[self.race]}
        return {race: 2.0 * math.pi / (order * self.shaft_speed) for race, order in chosen.items()}
