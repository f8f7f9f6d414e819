"""What a recipe says of a virtual machine: its rig and bearing, from the catalogue, altered, or drawn."""

from __future__ import annotations

from typing import Annotated

from pydantic import model_validator

from datagen.distributions.kinds import Distribution, Fixed
from datagen.recipes.operation_settings import FASTEST_RPM, SLOWEST_RPM
from datagen.recipes.quantities import DIAMETERS_MM, Degrees, Frequency
from datagen.settings.table import Between, OneOf, Table, Whole, at_most_one, possible_words, refuse
from physics.bearing import (
    FEWEST_BALLS,
    LARGEST_CLEARANCE,
    LARGEST_CONFORMITY,
    LARGEST_CONTACT_ANGLE_DEG,
    LARGEST_EXPONENT,
    MOST_BALLS,
    MOST_ROWS,
    SMALLEST_CONFORMITY,
    SMALLEST_EXPONENT,
)
from physics.catalog import BEARINGS, RIGS
from physics.operation import HEAVIEST_LOAD

DRAWN = "drawn"
# Ranges far beyond all machines, within which numbers of physics neither overflow nor vanish.
Stiffness = Annotated[Distribution, Between(1.0, 1e13)]
Damping = Annotated[Distribution, Between(0.0, 1e9)]
LoadDeflection = Annotated[Distribution, Between(1e3, 1e13)]
DiameterMm = Annotated[Distribution, DIAMETERS_MM]
LARGEST_CLEARANCE_UM = LARGEST_CLEARANCE * 1e6
Mass = Annotated[Distribution, Between(1e-6, 1e7)]
Factor = Annotated[Distribution, Between(1e-6, 1e6)]
NotNegativeFactor = Annotated[Distribution, Between(0.0, 1e6)]
Conformity = Annotated[Distribution, Between(SMALLEST_CONFORMITY, LARGEST_CONFORMITY)]
DampingRatio = Annotated[Distribution, Between(0.0, 2.0)]
# Of each group at most one may be given, and a drawn bearing or rig needs one.
BEARING_GROUPS = (
    ("balls", "fill"),
    ("rows",),
    ("pitch_diameter_mm",),
    ("ball_diameter_mm", "ball_diameter_of_pitch"),
)
RIG_GROUPS = (
    ("bearing",),
    ("inner_mass_kg",),
    ("outer_mass_kg",),
    ("resonator_mass_kg",),
    ("support_stiffness_x_n_per_m", "support_frequency_hz"),
    ("support_stiffness_y_n_per_m", "support_frequency_hz"),
    ("support_damping_x_n_s_per_m", "support_damping_ratio"),
    ("support_damping_y_n_s_per_m", "support_damping_ratio"),
    ("resonator_stiffness_n_per_m", "resonator_frequency_hz"),
    ("resonator_damping_n_s_per_m", "resonator_damping_ratio"),
    ("film_damping_n_s_per_m", "film_damping_us"),
    ("rated_speed_rpm",),
    ("rated_load_n", "rated_load_of_static_rating"),
)
OTHER_GROUPS = (("exponent", "elements"),)


class FactorSettings(Table):
    """Deviations: each number is multiplied by a drawn factor; 1 if not given."""

    pitch_diameter: Factor | None = None
    """Factor on the pitch diameter."""
    ball_diameter: Factor | None = None
    """Factor on the diameter of a rolling element."""
    load_deflection: Factor | None = None
    """Factor on K, after K has followed the geometry."""
    clearance: NotNegativeFactor | None = None
    """Factor on the radial clearance."""
    inner_mass: Factor | None = None
    """Factor on the mass of inner ring and shaft."""
    outer_mass: Factor | None = None
    """Factor on the mass of outer ring and support."""
    resonator_mass: Factor | None = None
    """Factor on the mass of the resonator."""
    support_stiffness: Factor | None = None
    """Factor on the stiffness of the support along x and y."""
    support_damping: NotNegativeFactor | None = None
    """Factor on the damping of the support along x and y."""
    resonator_stiffness: Factor | None = None
    """Factor on the stiffness of the resonator."""
    resonator_damping: NotNegativeFactor | None = None
    """Factor on the damping of the resonator."""
    film_damping: NotNegativeFactor | None = None
    """Factor on the damping of one loaded contact."""


class MachineSettings(Table):
    """A rig of the catalogue and what differs from it, or a drawn one; drawn once for each virtual machine.

    `rig = "drawn"` and `bearing = "drawn"` take every number from these settings. Numbers given here replace those of
    the catalogue.
    """

    rig: Annotated[Distribution, OneOf((*RIGS, DRAWN))]
    """Name of a rig in the catalogue, or "drawn"."""
    bearing: Annotated[Distribution, OneOf((*BEARINGS, DRAWN))] | None = None
    """Name of another bearing of the catalogue to mount in the rig, or "drawn"."""
    balls: Annotated[Distribution, Whole(FEWEST_BALLS, MOST_BALLS)] | None = None
    """Rolling elements in each row."""
    rows: Annotated[Distribution, Whole(1, MOST_ROWS)] | None = None
    """Rows of rolling elements."""
    pitch_diameter_mm: DiameterMm | None = None
    """Diameter of the circle through the balls' centres, mm."""
    ball_diameter_mm: DiameterMm | None = None
    """Diameter of a rolling element, mm."""
    contact_angle_deg: Annotated[Distribution, Between(0.0, LARGEST_CONTACT_ANGLE_DEG)] | None = None
    """Contact angle, degrees."""
    row_offset_deg: Degrees | None = None
    """Angle by which row 2 is ahead of row 1, degrees; half a ball spacing if not given."""
    load_deflection_n_per_m_to_n: LoadDeflection | None = None
    """Factor K of F = K δⁿ for one rolling element between both races, N/mⁿ; if not given, the catalogue's, scaled as
    Hertz's factor of the geometry, or Hertz's own for a drawn bearing."""
    exponent: Annotated[Distribution, Between(SMALLEST_EXPONENT, LARGEST_EXPONENT)] | None = None
    """Exponent n of the load-deflection law: 1.5 for balls, 1.1111 for rollers."""
    clearance_um: Annotated[Distribution, Between(-LARGEST_CLEARANCE_UM, LARGEST_CLEARANCE_UM)] | None = None
    """Radial clearance (half the diametral play), µm; negative: preload."""
    inner_mass_kg: Mass | None = None
    """Mass of inner ring and shaft, kg."""
    outer_mass_kg: Mass | None = None
    """Mass of outer ring and support, kg."""
    resonator_mass_kg: Mass | None = None
    """Mass of the high-frequency resonator, kg."""
    support_stiffness_x_n_per_m: Stiffness | None = None
    """Stiffness of the outer ring's support along x, N/m."""
    support_stiffness_y_n_per_m: Stiffness | None = None
    """Stiffness of the outer ring's support along y, N/m."""
    resonator_stiffness_n_per_m: Stiffness | None = None
    """Stiffness of the high-frequency resonator, N/m."""
    support_damping_x_n_s_per_m: Damping | None = None
    """Damping of the outer ring's support along x, N s/m."""
    support_damping_y_n_s_per_m: Damping | None = None
    """Damping of the outer ring's support along y, N s/m."""
    resonator_damping_n_s_per_m: Damping | None = None
    """Damping of the high-frequency resonator, N s/m."""
    film_damping_n_s_per_m: Damping | None = None
    """Viscous damping of one loaded contact, N s/m."""
    separate_cages: Annotated[Distribution, OneOf((False, True))] = Fixed(False)
    """True gives each row of a two-row bearing its own cage, with its own slip; no effect on one row."""
    inner_conformity: Conformity | None = None
    """Groove radius of the inner race over ball diameter."""
    outer_conformity: Conformity | None = None
    """Groove radius of the outer race over ball diameter."""
    elements: Annotated[Distribution, OneOf(("balls", "rollers"))] | None = None
    """Kind of rolling element, which sets the exponent to 3/2 or 10/9 and K to the law of that contact."""
    ball_diameter_of_pitch: Annotated[Distribution, Between(0.01, 0.9)] | None = None
    """Diameter of a rolling element as a share of the pitch diameter."""
    fill: Annotated[Distribution, Between(0.0, 1.0, above=True)] | None = None
    """Rolling elements in each row: this share of the circle that they would fill, in whole ones, rounded down."""
    roller_length_of_diameter: Annotated[Distribution, Between(0.1, 20.0)] = Fixed(1.0)
    """Effective length of a roller over its diameter, where `elements` says rollers."""
    support_frequency_hz: Frequency | None = None
    """Natural frequency of the outer ring's mass alone on its support along y, Hz: gives the stiffness for the mass."""
    support_stiffness_x_over_y: Factor = Fixed(1.0)
    """Stiffness of the support along x over that along y, where support_frequency_hz is given."""
    support_damping_ratio: DampingRatio | None = None
    """Damping of the outer ring's mass alone on its support over the critical one, along x and y."""
    resonator_frequency_hz: Frequency | None = None
    """Natural frequency of the resonator alone, Hz: gives the stiffness for the mass."""
    resonator_damping_ratio: DampingRatio | None = None
    """Damping of the resonator alone over the critical one."""
    film_damping_us: Annotated[Distribution, Between(0.0, 1e6)] | None = None
    """Damping of the healthy bearing along y over its stiffness at the rated load, µs: gives that of one contact."""
    rated_speed_rpm: Annotated[Distribution, Between(SLOWEST_RPM, FASTEST_RPM)] | None = None
    """Rated speed of the machine, rpm."""
    rated_load_n: Annotated[Distribution, Between(1e-6, HEAVIEST_LOAD)] | None = None
    """Rated radial load of the machine, N."""
    rated_load_of_static_rating: Annotated[Distribution, Between(0.0, 1.0, above=True)] | None = None
    """Rated load as a share of the bearing's static load rating (ISO 76)."""
    factors: FactorSettings = FactorSettings()
    """Deviations from the numbers above or those of the catalogue."""

    @model_validator(mode="after")
    def _one_of_each(self) -> MachineSettings:
        for group in (*BEARING_GROUPS, *RIG_GROUPS, *OTHER_GROUPS):
            at_most_one(self, *group)
        return self

    @model_validator(mode="after")
    def _drawn_ones_are_complete(self) -> MachineSettings:
        if DRAWN in possible_words(self.rig):
            self._require("a drawn rig", RIG_GROUPS)
        if self.bearing is not None and DRAWN in possible_words(self.bearing):
            self._require("a drawn bearing", BEARING_GROUPS)
            if self.exponent is not None and self.load_deflection_n_per_m_to_n is None:
                raise refuse(
                    "a drawn bearing with an exponent of its own needs its factor K", "load_deflection_n_per_m_to_n"
                )
        return self

    @property
    def most_rows(self) -> int:
        """Rows of rolling elements of the bearing with most of them that can be drawn."""
        return max(possible_words(self.rows) if self.rows is not None else self._of_catalogue("rows"))

    @property
    def ball_counts(self) -> tuple[int, ...]:
        """Numbers of rolling elements in a row that can be drawn; none if they follow from how many fit."""
        if self.fill is not None:
            return ()
        return possible_words(self.balls) if self.balls is not None else self._of_catalogue("balls")

    def _of_catalogue(self, number: str) -> tuple[int, ...]:
        """A number of every bearing that can be drawn; it must be stated where a bearing is drawn number by number."""
        rigs = possible_words(self.rig)
        names = possible_words(self.bearing) if self.bearing is not None else [RIGS[rig].bearing for rig in rigs]
        return tuple(int(getattr(BEARINGS[name], number).value) for name in names)

    def _require(self, what: str, groups: tuple[tuple[str, ...], ...]) -> None:
        for group in groups:
            if all(getattr(self, name) is None for name in group):
                raise refuse(f"{what} needs this setting", group[-1], f"one of {', '.join(group)}" if group[1:] else "")
