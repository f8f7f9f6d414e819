"""Everything the physics needs to know of one recording, every number fixed."""

from __future__ import annotations

from dataclasses import dataclass, field

from physics.bearing import RACES
from physics.cage import CagePath
from physics.checks import require, require_count, require_one_of, settle_tuples
from physics.imperfections import Imperfections
from physics.operation import Operation
from physics.rig import Rig
from physics.spall import Spall, require_apart
from physics.words import CONTACT_LAWS

# m along the race. The shorter the surface, the longer it takes to find the path of a ball: points lie closer, and the
# ball is as large as ever. One of a micrometre takes seconds.
SHORTEST_ROLLED = 1e-6


@dataclass(frozen=True)
class Scene:
    """One machine in one state of health, run in one way for `duration` seconds from its quasi-static position.

    `contact_law` is "paper" (F = K δⁿ + c_d δ̇ while δ > 0, may pull) or "no_tension" (the same, never below zero).
    `second_cage` is the path of row 2 if the rows have separate cages; None means one staggered cage.
    All spalls lie on one race.

    The balls turn as the cage says and the inner race as `operation` says. Nothing makes the two agree: a cage may be
    braked, or dragged along, for a study, so whoever changes the shaft's speed gives a new `cage` as well. `validity`
    says where a cage's nominal speed is not that of pure rolling; its slip is a label. Only over a spall of the inner
    race may a cage not be faster than the shaft, not even for a moment: balls would come from behind, through the edge
    that is called the exit. A cage that turns with the shaft all the time is allowed; no ball passes then.

    Raises InvalidParameter, which names the field, the value and what is allowed.
    """

    rig: Rig
    operation: Operation
    cage: CagePath
    spalls: tuple[Spall, ...] = ()
    imperfections: Imperfections = field(default_factory=Imperfections)
    contact_law: str = "paper"
    second_cage: CagePath | None = None

    def __post_init__(self) -> None:
        settle_tuples(self, "spalls")
        bearing = self.rig.bearing
        require_one_of("contact_law", self.contact_law, CONTACT_LAWS)
        one_race = len({spall.race for spall in self.spalls}) <= 1
        require(one_race, "spalls on both races; all spalls of a scene must be on one race", "race")
        for spall in self.spalls:
            self._check_spall(spall)
        require_apart(self.spalls)
        self._check_second_cage()
        self._check_direction()
        deviation = self.imperfections.ball_deviation
        require(
            not deviation or [len(row) for row in deviation] == [bearing.balls] * bearing.rows,
            f"ball_deviation must hold {bearing.rows} row(s) of {bearing.balls} values",
            "ball_deviation",
        )

    @property
    def no_tension(self) -> bool:
        """True if no contact force ever pulls."""
        return self.contact_law == "no_tension"

    def _check_spall(self, spall: Spall) -> None:
        bearing = self.rig.bearing
        require(
            spall.row <= bearing.rows,
            f"spall on row {spall.row}, but bearing {bearing.name} has {bearing.rows} row(s)",
            "row",
        )
        length = spall.rolled_arc * bearing.raceway_radius(spall.race)
        require(
            length == 0.0 or length >= SHORTEST_ROLLED,
            f"a ball is to be rolled over a surface {length:.3g} m long; allowed: from {SHORTEST_ROLLED:g} m",
            "extent",
        )
        wall = -min(spall.table_depth[0], spall.table_depth[-1]) if spall.profile == "table" else 0.0
        require(
            wall < bearing.ball_radius,
            f"the table begins or ends {wall:.3g} m above the race, in a wall that no ball of "
            f"{bearing.ball_radius:.3g} m radius rolls over; allowed: below that",
            "table_depth",
        )

    def _check_second_cage(self) -> None:
        if self.second_cage is None:
            return
        bearing = self.rig.bearing
        require(bearing.rows == 2, f"a second cage needs 2 rows; bearing {bearing.name} has 1", "second_cage")
        require(
            self.second_cage.duration == self.cage.duration,
            f"the cages last {self.cage.duration:g} s and {self.second_cage.duration:g} s; they must last equally long",
            "second_cage",
        )

    def _check_direction(self) -> None:
        """Balls meet the entry edge of an inner spall first only while the shaft overtakes them."""
        shaft = self.operation.shaft_speed
        for row in sorted({spall.row for spall in self.spalls if spall.race == "inner"}):
            cage, name = self.cage_of(row), "cage" if row == 1 or self.second_cage is None else "second_cage"
            fastest = max(cage.fastest, cage.mean_speed)
            steady = fastest == shaft and not cage.knot_values
            require(
                fastest < shaft or steady,
                f"{name} = {fastest:.6g} rad/s at its fastest; allowed over an inner spall: below the shaft's "
                f"{shaft:.6g} rad/s, or that speed without slip",
                name,
            )

    @property
    def duration(self) -> float:
        """Simulated time, s."""
        return self.cage.duration

    @property
    def cages(self) -> tuple[CagePath, ...]:
        """The path of the one cage, or of those of row 1 and row 2."""
        return (self.cage,) if self.second_cage is None else (self.cage, self.second_cage)

    def cage_of(self, row: int) -> CagePath:
        """The path of the cage that holds the balls of `row`; raises InvalidParameter for a row that there is not."""
        require_count("row", row, 1, self.rig.bearing.rows)
        return self.cages[min(row, len(self.cages)) - 1]

    def samples(self, rate: float) -> int:
        """Samples at `rate` (Hz) in the simulated time."""
        return round(self.duration * rate)

    def crossing_speed(self, spall: Spall) -> float:
        """Mean angular speed (rad/s, 0 or above) at which the balls of its row pass a spall."""
        return abs(self.cage_of(spall.row).mean_speed - self.race_speed(spall.race))

    def race_speed(self, race: str) -> float:
        """Angular speed of a race, rad/s: the shaft's for the inner race, zero for the outer one.

        Raises InvalidParameter for a `race` that is neither.
        """
        require_one_of("race", race, RACES)
        return self.operation.shaft_speed if race == "inner" else 0.0

    @property
    def turns_with_the_shaft(self) -> bool:
        """Whether something turns with the shaft that the balls feel: a load, a spall or waves of the inner race."""
        run, waves = self.operation, self.imperfections.waviness
        loads = run.unbalance_force > 0.0 or run.load_fluctuation > 0.0
        return loads or self.defective_race == "inner" or any(wave.race == "inner" for wave in waves)

    @property
    def balls_are_alike(self) -> bool:
        """Whether all balls of a row have the same diameter."""
        return all(len(set(row)) == 1 for row in self.imperfections.ball_deviation)

    @property
    def defective_race(self) -> str:
        """The race that holds the spalls: "none", "outer" or "inner"."""
        return self.spalls[0].race if self.spalls else "none"
