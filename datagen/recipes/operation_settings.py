"""What a recipe says of how a machine is run; drawn for each record."""

from __future__ import annotations

from typing import Annotated

from pydantic import model_validator

from datagen.distributions.kinds import Distribution, Fixed, Uniform
from datagen.recipes.quantities import Degrees
from datagen.settings.table import Between, Table, at_most_one
from physics.cage import LARGEST_MEAN_SLIP
from physics.operation import HEAVIEST_LOAD, LARGEST_FLUCTUATION

# Below it a record holds nothing but rest; above it no bearing survives.
SLOWEST_RPM, FASTEST_RPM = 1e-3, 1e6
MOST_SLIP_DEVIATION = 0.1
ANY_ANGLE = Uniform(0.0, 360.0)


class OperationSettings(Table):
    """Speed, load, the cage's start and slip, and loads that turn with the shaft."""

    speed_rpm: Annotated[Distribution, Between(SLOWEST_RPM, FASTEST_RPM)] | None = None
    """Shaft speed, rpm; the rig's rated speed if neither this nor speed_of_rated is given."""
    speed_of_rated: Annotated[Distribution, Between(1e-6, 1e3)] | None = None
    """Shaft speed as a multiple of the rig's rated speed; a speed of 0.001 to 1e6 rpm must come of it."""
    load_n: Annotated[Distribution, Between(0.0, HEAVIEST_LOAD)] | None = None
    """Static radial load, N; the rig's rated load if neither this nor load_of_rated is given."""
    load_of_rated: Annotated[Distribution, Between(0.0, 1e3)] | None = None
    """Static radial load as a multiple of the rig's rated load."""
    cage_angle_deg: Degrees = ANY_ANGLE
    """Angle of ball 1 of row 1 at the start, degrees; anywhere if not given."""
    second_cage_angle_deg: Degrees = ANY_ANGLE
    """The same of row 2, before its stagger, where the rows have separate cages, degrees."""
    mean_slip: Annotated[Distribution, Between(-LARGEST_MEAN_SLIP, LARGEST_MEAN_SLIP)] = Fixed(0.0)
    """Mean slip of the cage, as a share of its speed."""
    slip_deviation: Annotated[Distribution, Between(0.0, MOST_SLIP_DEVIATION)] = Fixed(0.01)
    """Standard deviation of the cage's slip, as a share of its speed."""
    slip_correlation_passes: Annotated[Distribution, Between(0.1, 1e4)] = Fixed(1.0)
    """Correlation time of the slip, in nominal ball passes of the outer race."""
    unbalance_n: Annotated[Distribution, Between(0.0, HEAVIEST_LOAD)] | None = None
    """Load that turns with the shaft, N; none if neither this nor unbalance_grade_mm_per_s is given."""
    unbalance_grade_mm_per_s: Annotated[Distribution, Between(0.0, 1e4)] | None = None
    """Balance quality grade G of ISO 21940, mm/s: the load is G times mass of inner ring and shaft times speed."""
    unbalance_phase_deg: Degrees = ANY_ANGLE
    """Its angle at the start, degrees; anywhere if not given."""
    load_fluctuation: Annotated[Distribution, Between(0.0, LARGEST_FLUCTUATION)] = Fixed(0.0)
    """Amplitude of a fluctuation of the static load once a turn, as a share of it."""
    fluctuation_phase_deg: Degrees = ANY_ANGLE
    """Its phase at the start, degrees; anywhere if not given."""

    @model_validator(mode="after")
    def _one_of_each(self) -> OperationSettings:
        at_most_one(self, "speed_rpm", "speed_of_rated")
        at_most_one(self, "load_n", "load_of_rated")
        at_most_one(self, "unbalance_n", "unbalance_grade_mm_per_s")
        return self
