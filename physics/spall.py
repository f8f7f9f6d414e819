"""Raceway spalls: where they are, how long, how deep and how their edges look."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

from physics.bearing import MOST_ROWS, RACES, Bearing
from physics.checks import (
    require,
    require_angle,
    require_between,
    require_count,
    require_not_negative,
    require_one_of,
    require_up_to,
    settle_tuples,
)

PROFILES = ("tukey", "ball_path", "table")
# Of a surface, m: no spall is deeper, and no measured surface higher.
DEEPEST = 1e-2
# The first and the last are 0; fewer than two between them cannot go up and down.
FEWEST_ROUGHNESS_VALUES = 4
# Shares of an arc that count as rounding. By the first, tapers may exceed a spall and neighbouring spalls overlap; by
# the second, where degrees were written down, a table may reach beyond its spall and an extended one fall short of the
# ball spacing.
ARC_ROUNDING, STATED_ROUNDING = 1e-12, 1e-9
# Ball spacings from which a spall is extended.
EXTENDED_FROM = 1.0 - STATED_ROUNDING


@dataclass(frozen=True)
class Spall:
    """One spall on one row of one race (SI units).

    `angle` φf is the centre at t = 0 (an inner spall turns with the shaft), `extent` Δφ the arc it covers.
    `entry_taper` is the arc of the taper a ball meets first, `exit_taper` of the one it meets last (rad).
    `profile` says how the path of the ball's centre follows from these [P14 Eq. 17]:
      tukey      the path itself is a tapered window of height `depth`, plus low-passed roughness;
      ball_path  `depth`, tapers and roughness describe the surface, over which the ball is rolled;
      table      `table_angle` (rad, rising, relative to the centre, in the direction of increasing φ) and `table_depth`
                 (m) are a measured surface, over which the ball is rolled.
    `roughness` is the standard deviation (m) of the surface inside the spall, `roughness_values` its samples at equal
    steps from entry edge to exit edge (m, drawn once by whoever draws the scene; empty: smooth).

    A taper of zero is a step without slope. The film, whose force is c_d times the rate of compression, gives no
    impulse there, but c_d cos²α `depth` over any taper however short. So under tukey the response to ever shorter
    tapers does not tend to that without one; a taper of 0.001 degrees has their limit. Beside tapers the path follows
    `roughness_values` to 1e-10 m, unless they jump by many times what drawn ones do from step to step.

    InvalidParameter unless `race`, `row` and `profile` are as above, the extent is above 0 and π at most, depths are
    within 10 mm and the tapers fit into the extent. Roughness values (4 or more, 0 at both ends) have to be within
    10 mm too; a table (2 points or more, within the extent) has to be finite and in order.
    """

    race: str
    row: int
    angle: float
    extent: float
    depth: float
    entry_taper: float = 0.0
    exit_taper: float = 0.0
    profile: str = "tukey"
    roughness: float = 0.0
    roughness_values: tuple[float, ...] = ()
    table_angle: tuple[float, ...] = ()
    table_depth: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        settle_tuples(self, "roughness_values", "table_angle", "table_depth")
        require_one_of("race", self.race, RACES)
        require_count("row", self.row, 1, MOST_ROWS)
        require_one_of("profile", self.profile, PROFILES)
        require_angle("angle", self.angle)
        require_up_to("extent", self.extent, math.pi, "rad")
        require_between("depth", self.depth, 0.0, DEEPEST, "m")
        require_not_negative("roughness", self.roughness, "m")
        for field in ("entry_taper", "exit_taper"):
            require_between(field, getattr(self, field), 0.0, self.extent, "rad")
        require(
            self.entry_taper + self.exit_taper <= self.extent * (1.0 + ARC_ROUNDING),
            f"entry_taper + exit_taper = {self.entry_taper + self.exit_taper:.6g} rad is longer than the spall "
            f"(extent = {self.extent:.6g} rad)",
            "entry_taper",
        )
        self._check_roughness()
        self._check_table()

    @property
    def rolled_arc(self) -> float:
        """The arc (rad) of the surface over which a ball is rolled to find its path; 0 where the path is a formula."""
        if self.profile == "table":
            return self.table_angle[-1] - self.table_angle[0]
        shaped = self.entry_taper > 0.0 or self.exit_taper > 0.0 or bool(self.roughness_values)
        return self.extent if self.profile == "ball_path" and shaped else 0.0

    @property
    def floor_depth(self) -> float:
        """Depth of the floor below the raceway, m: the largest value of a measured table, else `depth`."""
        return max(self.table_depth) if self.profile == "table" else self.depth

    def _check_roughness(self) -> None:
        values = self.roughness_values
        if not values:
            return
        require(
            len(values) >= FEWEST_ROUGHNESS_VALUES,
            f"roughness_values must be at least {FEWEST_ROUGHNESS_VALUES} numbers (m); there are {len(values)}",
            "roughness_values",
        )
        for place, value in enumerate(values, start=1):
            if not -DEEPEST <= value <= DEEPEST:  # there may be thousands of them: words are made for a wrong one alone
                what = f"number {place} of {len(values)} roughness_values"
                require_between("roughness_values", value, -DEEPEST, DEEPEST, "m", what)
        require(
            values[0] == 0.0 and values[-1] == 0.0,
            f"roughness_values begin with {values[0]} and end with {values[-1]} m; they must begin and end with 0",
            "roughness_values",
        )

    def _check_table(self) -> None:
        angle, depth = self.table_angle, self.table_depth
        require(
            len(angle) == len(depth),
            f"table_angle has {len(angle)} values and table_depth {len(depth)}; they must match",
            "table_depth",
        )
        if self.profile == "table":
            require(
                len(angle) >= 2,
                f'profile = "table" needs at least 2 table points; there are {len(angle)}',
                "table_angle",
            )
            require(
                not self.roughness_values,
                f"the measured surface has its roughness; {len(self.roughness_values)} roughness_values are given",
                "roughness_values",
            )
        require(
            all(math.isfinite(value) for value in angle) and all(a < b for a, b in pairwise(angle)),
            "table_angle must be finite and rise from one value to the next",
            "table_angle",
        )
        for value in depth:
            require_between("table_depth", value, -DEEPEST, DEEPEST, "m")
        # Beyond its ends the table would be cut off by a wall.
        half = 0.5 * self.extent * (1.0 + STATED_ROUNDING)
        for value in angle:
            require_between("table_angle", value, -half, half, "rad")

    @property
    def travel_sign(self) -> int:
        """+1 if balls cross the spall towards larger φ − φf (outer race), −1 if towards smaller (inner race)."""
        return 1 if self.race == "outer" else -1

    def length(self, bearing: Bearing) -> float:
        """Length along the raceway, m: L = Δφ · raceway radius."""
        return self.extent * bearing.raceway_radius(self.race)


def is_extended(extent: float, bearing: Bearing) -> bool:
    """True if the arc `extent` (rad) always holds at least one ball of its row: Δφ ≥ 2π/Nb."""
    return extent / bearing.spacing >= EXTENDED_FROM


def require_apart(spalls: Sequence[Spall]) -> None:
    """Raise InvalidParameter if two `spalls` of a row overlap; they may touch."""
    for one, other in combinations(spalls, 2):
        apart = abs(math.remainder(one.angle - other.angle, math.tau))
        least = (one.extent + other.extent) / 2.0
        require(
            one.row != other.row or apart >= least * (1.0 - ARC_ROUNDING),
            f"two spalls on row {one.row} overlap: {math.degrees(apart):.4g} degrees apart, and their extents need "
            f"{math.degrees(least):.4g}",
            "angle",
        )
