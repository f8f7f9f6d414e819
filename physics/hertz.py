"""Elastic contact of rolling elements with their races: load-deflection factors and contact widths from geometry."""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

from physics.bearing import (
    DEFAULT_CONFORMITY,
    LARGEST_CONFORMITY,
    LARGEST_CONTACT_ANGLE,
    RACES,
    SMALLEST_CONFORMITY,
    Bearing,
    raceway_radius,
)
from physics.checks import require, require_between, require_one_of, require_positive

# E/(1 − ν²) of bearing steel, Pa, with E = 206 GPa and ν = 0.3.
STEEL_MODULUS = 206e9 / (1.0 - 0.3**2)
BALL_EXPONENT = 1.5
ROLLER_EXPONENT = 10.0 / 9.0
PALMGREN_FACTOR = 8.06e4  # N/mm^2: load of one steel line contact is 8.06e4 l^(8/9) δ^(10/9), l and δ in mm
MILLIMETRES = 1e3


@dataclass(frozen=True)
class PointContact:
    """Two steel bodies touching at a point, by the sums of their curvatures (1/m) along and across the rolling
    direction.

    A concave body counts as negative. InvalidParameter unless both sums are above 0.
    """

    along: float
    across: float

    def __post_init__(self) -> None:
        require_positive("along", self.along, "1/m")
        require_positive("across", self.across, "1/m")

    @property
    def curvature_sum(self) -> float:
        """Σρ, 1/m."""
        return self.along + self.across

    @property
    def curvature_difference(self) -> float:
        """F(ρ), 0 for a circular contact to 1 for a line, dimensionless."""
        return abs(self.along - self.across) / self.curvature_sum

    def semi_axes(self, load: float) -> tuple[float, float]:
        """Half the size of the contact along and across the rolling direction under `load` (N), m."""
        scale = (3.0 * load / (self.curvature_sum * STEEL_MODULUS)) ** (1.0 / 3.0)
        major, minor, _ = contact_parameters(self.curvature_difference)
        return (minor * scale, major * scale) if self.along >= self.across else (major * scale, minor * scale)

    def approach(self, load: float) -> float:
        """Distance by which `load` (N) brings the bodies together, m."""
        scale = (3.0 * load / (self.curvature_sum * STEEL_MODULUS)) ** (2.0 / 3.0)
        return contact_parameters(self.curvature_difference)[2] * scale * self.curvature_sum / 2.0

    @property
    def load_deflection(self) -> float:
        """K of F = K δ^(3/2) for this contact alone, N/m^1.5."""
        return float(self.approach(1.0) ** -BALL_EXPONENT)


def contact_parameters(curvature_difference: float) -> tuple[float, float, float]:
    """Hertz's dimensionless semi-axes a*, b* and approach δ* for F(ρ), 0 ≤ F(ρ) < 1.

    With κ = a/b and complete elliptic integrals K, E of modulus² 1 − 1/κ²: F(ρ) = ((κ² + 1) E − 2 K) / ((κ² − 1) E),
    a* = (2κ²E/π)^(1/3), b* = a*/κ, δ* = (2K/π) (π/(2κ²E))^(1/3) (Harris, Rolling Bearing Analysis, chapter 6).
    InvalidParameter for another F(ρ), or one within 1e-9 of 1.
    """
    inverse_square = _inverse_ellipticity_squared(curvature_difference)
    first, second = float(ellipkm1(inverse_square)), float(ellipe(1.0 - inverse_square))
    major = (2.0 * second / (math.pi * inverse_square)) ** (1.0 / 3.0)
    return major, major * math.sqrt(inverse_square), 2.0 * first / (math.pi * major)


def _inverse_ellipticity_squared(curvature_difference: float) -> float:
    """1/κ² of the contact ellipse."""
    require_between("curvature_difference", curvature_difference, 0.0, 1.0 - 1e-9)
    if curvature_difference < 1e-4:
        # F(ρ) = 3m/8 + O(m²) with m = 1 − 1/κ²; the formula itself cancels to nothing here.
        return 1.0 - 8.0 * curvature_difference / 3.0

    def excess(log_ellipticity: float) -> float:
        p = math.exp(-2.0 * log_ellipticity)
        second = ellipe(1.0 - p)
        return float(((1.0 + p) * second - 2.0 * p * ellipkm1(p)) / ((1.0 - p) * second)) - curvature_difference

    return math.exp(-2.0 * brentq(excess, 1e-5, 15.0, xtol=1e-14))


def race_contact(
    race: str,
    pitch_diameter: float,
    ball_diameter: float,
    contact_angle: float = 0.0,
    conformity: float = DEFAULT_CONFORMITY,
) -> PointContact:
    """The contact of a steel ball (m, m, rad) with the groove of one race; `conformity` is groove radius over ball
    diameter.

    InvalidParameter for another race than "outer" and "inner", diameters that are not above 0 or a ball as large as its
    pitch circle, a contact angle outside 0 to 60 degrees, or a conformity outside 0.501 to 1000.
    """
    require_one_of("race", race, RACES)
    require_positive("pitch_diameter", pitch_diameter, "m")
    require_positive("ball_diameter", ball_diameter, "m")
    problem = f"ball_diameter = {ball_diameter} m; it must be below the pitch diameter of {pitch_diameter} m"
    require(ball_diameter < pitch_diameter, problem, "ball_diameter")
    require_between("contact_angle", contact_angle, 0.0, LARGEST_CONTACT_ANGLE, "rad")
    require_between("conformity", conformity, SMALLEST_CONFORMITY, LARGEST_CONFORMITY)
    towards = math.cos(contact_angle)
    race_radius = raceway_radius(race, pitch_diameter, ball_diameter, contact_angle)
    bend = (-1.0 if race == "outer" else 1.0) * towards / race_radius
    return PointContact(
        along=2.0 / ball_diameter + bend,
        across=2.0 / ball_diameter - 1.0 / (conformity * ball_diameter),
    )


def in_series(first: float, second: float, exponent: float) -> float:
    """Load-deflection factor of two contacts that carry the same load: K^(-1/n) = K1^(-1/n) + K2^(-1/n)."""
    return float((first ** (-1.0 / exponent) + second ** (-1.0 / exponent)) ** -exponent)


def load_deflection_factor(
    pitch_diameter: float,
    ball_diameter: float,
    contact_angle: float = 0.0,
    inner_conformity: float = DEFAULT_CONFORMITY,
    outer_conformity: float = DEFAULT_CONFORMITY,
) -> float:
    """K of F = K δ^(3/2) for a ball between both races, N/m^1.5; lengths m, angle rad [P14 Eq. 6].

    InvalidParameter as for `race_contact`.
    """
    inner, outer = (
        race_contact(race, pitch_diameter, ball_diameter, contact_angle, conformity)
        for race, conformity in (("inner", inner_conformity), ("outer", outer_conformity))
    )
    return in_series(inner.load_deflection, outer.load_deflection, BALL_EXPONENT)


def hertz_load_deflection(bearing: Bearing) -> float:
    """K of F = K δ^(3/2) that the geometry and conformities of a ball `bearing` give, N/m^1.5."""
    return load_deflection_factor(
        bearing.pitch_diameter,
        bearing.ball_diameter,
        bearing.contact_angle,
        bearing.inner_conformity,
        bearing.outer_conformity,
    )


def roller_load_deflection_factor(length: float) -> float:
    """K of F = K δ^(10/9) for a steel roller of effective `length` (m) between both races, N/m^(10/9).

    Palmgren's line contact, once at each race: the roller's deflection is shared between two such contacts.
    InvalidParameter unless the length is above 0.
    """
    require_positive("length", length, "m")
    one = PALMGREN_FACTOR * (length * MILLIMETRES) ** (8.0 / 9.0) * MILLIMETRES**ROLLER_EXPONENT
    return in_series(one, one, ROLLER_EXPONENT)


def roller_length(load_deflection: float) -> float:
    """Effective length (m) of the steel roller whose factor between both races is `load_deflection`, N/m^(10/9).

    InvalidParameter unless it is above 0.
    """
    require_positive("load_deflection", load_deflection, "N/m^(10/9)")
    return float((load_deflection / roller_load_deflection_factor(1.0)) ** (9.0 / 8.0))


def is_roller(bearing: Bearing) -> bool:
    """True if the elements are rollers: the exponent is nearer to 10/9 than to 3/2.

    Contact width, mass and static rating know these two alone. Of another exponent below their mean, K is read as if it
    were in N/m^(10/9), and the length that follows may be wrong ten times over.
    """
    return bearing.exponent < (BALL_EXPONENT + ROLLER_EXPONENT) / 2.0


def contact_width(bearing: Bearing, race: str, load: float) -> float:
    """Width along the rolling direction of the contact with `race` ("outer", "inner") under a normal `load` (N), m.

    Balls: the ellipse of the bearing's conformity. Rollers: the line contact of the length l that K stands for, Hertz's
    2 √(8 F / (π l Σρ E/(1 − ν²))) of two bodies of one steel.

    InvalidParameter unless the load is above 0, or for another race.
    """
    require_positive("load", load, "N")
    contact = race_contact(
        race,
        bearing.pitch_diameter,
        bearing.ball_diameter,
        bearing.contact_angle,
        bearing.conformity(race),
    )
    if not is_roller(bearing):
        return 2.0 * contact.semi_axes(load)[0]
    length = roller_length(bearing.load_deflection)
    return 2.0 * math.sqrt(8.0 * load / (math.pi * length * contact.along * STEEL_MODULUS))
