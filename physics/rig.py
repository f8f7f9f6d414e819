"""Test rigs: a bearing with the masses, supports and resonator around it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from physics.arrays import Array
from physics.bearing import Bearing
from physics.checks import require_not_negative, require_positive


@dataclass(frozen=True)
class Rig:
    """The lumped machine of [P14 Fig. 1] in SI units: inner ring + shaft, outer ring + support, resonator.

    `film_damping` is c_d, the viscous damping of one loaded contact (N s/m) [P14 Eq. 9]. `rated_speed` (rad/s) and
    `rated_load` (N) are the operating point of the source, used as defaults. Masses are in kg, stiffnesses in N/m,
    dampings in N s/m.

    InvalidParameter unless masses, stiffnesses, rated speed and rated load are above 0 and no damping is below it.
    """

    name: str
    bearing: Bearing
    inner_mass: float
    outer_mass: float
    support_stiffness_x: float
    support_stiffness_y: float
    support_damping_x: float
    support_damping_y: float
    resonator_mass: float
    resonator_stiffness: float
    resonator_damping: float
    film_damping: float
    rated_speed: float
    rated_load: float

    def __post_init__(self) -> None:
        for field in ("inner_mass", "outer_mass", "resonator_mass"):
            require_positive(field, getattr(self, field), "kg")
        for field in ("support_stiffness_x", "support_stiffness_y", "resonator_stiffness"):
            require_positive(field, getattr(self, field), "N/m")
        for field in ("support_damping_x", "support_damping_y", "resonator_damping", "film_damping"):
            require_not_negative(field, getattr(self, field), "N s/m")
        require_positive("rated_speed", self.rated_speed, "rad/s")
        require_positive("rated_load", self.rated_load, "N")

    @property
    def free_resonance(self) -> float:
        """Angular frequency of the resonator on the outer ring without support and shaft, rad/s."""
        return math.sqrt(self.resonator_stiffness * (1.0 / self.resonator_mass + 1.0 / self.outer_mass))

    @property
    def radial_film_damping(self) -> float:
        """Damping of the radial force against the radial compression rate, c_d cos² α, N s/m [P14 Eq. 9]."""
        return self.film_damping * math.cos(self.bearing.contact_angle) ** 2

    def mass_matrix(self) -> Array:
        """M of (xi, yi, xo, yo, xr, yr), shape (6, 6), kg [P14 Eq. 13, 14]."""
        return np.diag(np.repeat([self.inner_mass, self.outer_mass, self.resonator_mass], 2))

    def stiffness_matrix(self) -> Array:
        """K without the bearing, shape (6, 6), N/m [P14 Eq. 13, 15]."""
        support = np.diag([self.support_stiffness_x, self.support_stiffness_y])
        return _chain(support, self.resonator_stiffness * np.eye(2))

    def damping_matrix(self) -> Array:
        """C without the bearing, shape (6, 6), N s/m [P14 Eq. 13, 15]."""
        support = np.diag([self.support_damping_x, self.support_damping_y])
        return _chain(support, self.resonator_damping * np.eye(2))


def _chain(support: Array, resonator: Array) -> Array:
    """Matrix (6, 6) of the outer ring held by `support` (2, 2) with the `resonator` (2, 2) on it; the shaft is free."""
    matrix = np.zeros((6, 6))
    matrix[2:4, 2:4] = support + resonator
    matrix[2:4, 4:6] = -resonator
    matrix[4:6, 2:4] = -resonator
    matrix[4:6, 4:6] = resonator
    return matrix
