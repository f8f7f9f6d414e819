"""What is known of a bearing in operation before its signal is looked at: orders of its parts and its speed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from physics.bearing import RACES
from physics.checks import require_one_of
from physics.orders import ball_spin_order, cage_order, diameter_ratio_of, inner_pass_order, outer_pass_order

# Shares by which the cage's slip moves a family at most, and usually.
SLIP_TOLERANCE, SLIP_PRIOR = 0.025, 0.012
# Standard deviation of the cage's speed about the one of pure rolling, as a share: slip and unknown contact angle.
SLIP_SPREAD = 0.007
# Shares by which a shaft may turn faster or slower than a speed that was measured or told, and than a nominal one: the
# rotor of a motor lags behind the field, the more so the smaller the motor and the larger its load.
MEASURED_WITHIN, NOMINAL_WITHIN = 0.022, 0.05
NARROWEST_BAND = 3.5  # in BPFI


@dataclass(frozen=True)
class Kinematics:
    """Ball pass orders of a bearing and the speed of its shaft.

    `balls` in a row, `diameter_ratio` = Db cos α / Dp, `ball_spin` the spin of a ball in orders of the shaft,
    `shaft_hz` the shaft's speed in Hz, which may be off by the share `speed_within`. ValueError unless there are 3
    balls or more, the ratio and that share lie between 0 and 1, and spin and speed are above 0.
    """

    balls: int
    diameter_ratio: float
    ball_spin: float
    shaft_hz: float
    speed_within: float = MEASURED_WITHIN

    def __post_init__(self) -> None:
        allowed = (
            ("balls", self.balls, self.balls >= 3, "3 or more"),
            ("diameter_ratio", self.diameter_ratio, 0.0 < self.diameter_ratio < 1.0, "between 0 and 1"),
            ("ball_spin", self.ball_spin, self.ball_spin > 0.0, "above 0"),
            ("shaft_hz", self.shaft_hz, 0.0 < self.shaft_hz < math.inf, "above 0"),
            ("speed_within", self.speed_within, 0.0 < self.speed_within < 1.0, "between 0 and 1"),
        )
        for name, value, fits, range_ in allowed:
            if not fits:
                raise ValueError(f"{name} = {value}; allowed: {range_}")

    @property
    def ftf(self) -> float:
        """Order of the cage."""
        return cage_order(self.diameter_ratio)

    @property
    def bpfo(self) -> float:
        """Order at which balls pass a point of the outer race."""
        return outer_pass_order(self.balls, self.diameter_ratio)

    @property
    def bpfi(self) -> float:
        """Order at which balls pass a point of the inner race."""
        return inner_pass_order(self.balls, self.diameter_ratio)

    @property
    def narrowest_band_hz(self) -> float:
        """Width (Hz) of the narrowest band worth searching, which holds three harmonics of either race's family."""
        return NARROWEST_BAND * self.bpfi * self.shaft_hz

    def pass_order(self, race: str) -> float:
        """Order at which balls pass a point of the race "outer" or "inner"; InvalidParameter for another."""
        require_one_of("race", race, RACES)
        return self.bpfo if race == "outer" else self.bpfi

    def at(self, shaft_hz: float) -> Kinematics:
        """The same bearing at another speed."""
        return replace(self, shaft_hz=shaft_hz)


def bearing_kinematics(
    balls: int, pitch_diameter: float, ball_diameter: float, contact_angle: float, shaft_hz: float
) -> Kinematics:
    """Kinematics of a bearing from its geometry (m, m, rad) and speed (Hz); ValueError if a number is impossible."""
    if balls % 1 != 0:
        raise ValueError(f"balls = {balls}; allowed: whole numbers")
    if not 0.0 < ball_diameter < pitch_diameter:
        raise ValueError(f"ball_diameter = {ball_diameter} m; allowed: above 0 and below pitch_diameter")
    ratio = diameter_ratio_of(pitch_diameter, ball_diameter, contact_angle)
    spin = ball_spin_order(pitch_diameter / ball_diameter, ratio)
    return Kinematics(int(balls), ratio, spin, shaft_hz)
