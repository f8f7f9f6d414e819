"""Rolling bearings: geometry, load-deflection law and characteristic frequencies."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from physics.checks import require, require_between, require_count, require_finite, require_one_of, require_positive
from physics.orders import ball_spin_order, cage_order, diameter_ratio_of, inner_pass_order, outer_pass_order

if TYPE_CHECKING:
    from physics.arrays import Array

Force = TypeVar("Force", float, "Array")

RACES = ("outer", "inner")
FEWEST_BALLS, MOST_BALLS = 3, 200
MOST_ROWS = 2
DEFAULT_CONFORMITY = 0.52
SMALLEST_CONFORMITY, LARGEST_CONFORMITY = 0.501, 1e3
SMALLEST_EXPONENT, LARGEST_EXPONENT = 1.0, 2.0
LARGEST_CONTACT_ANGLE_DEG = 60.0
LARGEST_CONTACT_ANGLE = math.radians(LARGEST_CONTACT_ANGLE_DEG)
LARGEST_CLEARANCE = 1e-3  # m, of either sign
# Balls may be larger than their chord by this share: those that just touch are so by rounding.
ROUNDING = 1e-12


def raceway_radius(race: str, pitch_diameter: float, ball_diameter: float, contact_angle: float) -> float:
    """Radius of the raceway at the contact, m: `race` is "outer" or "inner". InvalidParameter for another."""
    require_one_of("race", race, RACES)
    shift = ball_diameter * math.cos(contact_angle)
    return (pitch_diameter + shift) / 2.0 if race == "outer" else (pitch_diameter - shift) / 2.0


@dataclass(frozen=True)
class Bearing:
    """A radially loaded bearing with one row of rolling elements, or two staggered rows (SI units).

    `load_deflection` is K of F = K δⁿ for one rolling element between both races (N/mⁿ, δ along the contact normal),
    `exponent` is n: 3/2 for balls, 10/9 for rollers [P14 Eq. 6]. `clearance` is radial: half the diametral play.
    `row_offset` is the stagger of neighbouring rows (rad); None means half a ball spacing [P14 Eq. 2]. A conformity is
    groove radius over ball diameter; it sets the width of the contacts, never K. That of an outer raceway that is a
    sphere is raceway radius over ball diameter.

    InvalidParameter unless there are 3 to 200 balls that fit on the pitch circle, in 1 or 2 rows. Diameters and K are
    above 0, the exponent is from 1 to 2, the contact angle from 0 to 60 degrees, the clearance within ±1 mm, and
    conformities are from 0.501 to 1000.
    """

    name: str
    balls: int
    rows: int
    pitch_diameter: float
    ball_diameter: float
    load_deflection: float
    exponent: float = 1.5
    contact_angle: float = 0.0
    clearance: float = 0.0
    row_offset: float | None = None
    inner_conformity: float = DEFAULT_CONFORMITY
    outer_conformity: float = DEFAULT_CONFORMITY

    def __post_init__(self) -> None:
        require_count("balls", self.balls, FEWEST_BALLS, MOST_BALLS)
        require_count("rows", self.rows, 1, MOST_ROWS)
        require_positive("pitch_diameter", self.pitch_diameter, "m")
        require_positive("ball_diameter", self.ball_diameter, "m")
        require_positive("load_deflection", self.load_deflection, "N/m^n")
        require_between("exponent", self.exponent, SMALLEST_EXPONENT, LARGEST_EXPONENT)
        require_between("contact_angle", self.contact_angle, 0.0, LARGEST_CONTACT_ANGLE, "rad")
        require_between("clearance", self.clearance, -LARGEST_CLEARANCE, LARGEST_CLEARANCE, "m")
        require_finite("row_offset", self.stagger, "rad")
        require_between("inner_conformity", self.inner_conformity, SMALLEST_CONFORMITY, LARGEST_CONFORMITY)
        require_between("outer_conformity", self.outer_conformity, SMALLEST_CONFORMITY, LARGEST_CONFORMITY)
        chord = self.pitch_diameter * math.sin(math.pi / self.balls)
        require(
            chord >= self.ball_diameter * (1.0 - ROUNDING),
            f"{self.balls} balls of {self.ball_diameter * 1e3:.3f} mm do not fit on a pitch circle of "
            f"{self.pitch_diameter * 1e3:.3f} mm: neighbours are {chord * 1e3:.3f} mm apart",
            "ball_diameter",
        )

    @property
    def spacing(self) -> float:
        """Angle between neighbouring balls of one row, rad."""
        return 2.0 * math.pi / self.balls

    @property
    def stagger(self) -> float:
        """Angle by which each row is ahead of the one before, rad."""
        return math.pi / self.balls if self.row_offset is None else self.row_offset

    @property
    def ball_radius(self) -> float:
        """Radius of a ball, m."""
        return self.ball_diameter / 2.0

    def raceway_radius(self, race: str) -> float:
        """Radius of the raceway at the contact, m: `race` is "outer" or "inner". InvalidParameter for another."""
        return raceway_radius(race, self.pitch_diameter, self.ball_diameter, self.contact_angle)

    @property
    def diameter_ratio(self) -> float:
        """Db cos α / Dp, dimensionless."""
        return diameter_ratio_of(self.pitch_diameter, self.ball_diameter, self.contact_angle)

    @property
    def radial_load_deflection(self) -> float:
        """K of the radial force against the radial compression, K cosⁿ⁺¹ α, N/mⁿ [P14 Eq. 6]."""
        return self.load_deflection * math.cos(self.contact_angle) ** (self.exponent + 1.0)

    def cage_speed(self, shaft_speed: float) -> float:
        """Nominal cage speed in rad/s for a shaft speed in rad/s [P14 Eq. 1]."""
        return shaft_speed * self.ftf

    @property
    def ftf(self) -> float:
        """Fundamental train (cage) frequency in orders of the shaft."""
        return cage_order(self.diameter_ratio)

    @property
    def bpfo(self) -> float:
        """Ball-pass frequency of the outer race in orders of the shaft."""
        return outer_pass_order(self.balls, self.diameter_ratio)

    @property
    def bpfi(self) -> float:
        """Ball-pass frequency of the inner race in orders of the shaft."""
        return inner_pass_order(self.balls, self.diameter_ratio)

    @property
    def bsf(self) -> float:
        """Ball spin frequency in orders of the shaft."""
        return ball_spin_order(self.pitch_diameter / self.ball_diameter, self.diameter_ratio)

    def conformity(self, race: str) -> float:
        """Groove radius over ball diameter, dimensionless: `race` is "outer" or "inner".

        InvalidParameter for another.
        """
        require_one_of("race", race, RACES)
        return self.outer_conformity if race == "outer" else self.inner_conformity

    def compression(self, force: Force) -> Force:
        """Compression (m) of a contact that presses with the `force` (N): (F / K)^(1/n) [P14 Eq. 6]."""
        return (force / self.load_deflection) ** (1.0 / self.exponent)

    @property
    def stribeck_factor(self) -> float:
        """Load of the most loaded ball at zero clearance over the radial load divided by the number of balls, without
        contact angle: 4.37 for balls, 4.08 for rollers."""
        n = self.exponent
        return 2.0 * math.sqrt(math.pi) * math.gamma((n + 3.0) / 2.0) / math.gamma((n + 2.0) / 2.0)

    def stribeck_peak_load(self, load: float) -> float:
        """Load of the most loaded ball at zero clearance under the radial `load`, N [P14 Eq. 24]."""
        return self.stribeck_factor * load / (self.rows * self.balls * math.cos(self.contact_angle))
