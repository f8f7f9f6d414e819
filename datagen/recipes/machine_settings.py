"""What a recipe says of a virtual machine: its rig, its bearing's imperfections and its noise floor."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from datagen.recipes.distributions import Distribution, Fixed, Uniform
from datagen.recipes.settings import Between, OneOf, Table, Whole, refuse
from physics.catalog import BEARINGS, RIGS

Positive = Annotated[Distribution, Between(0.0, above=True)]
NotNegative = Annotated[Distribution, Between(0.0)]
Order = Annotated[int, Field(ge=1, le=2000)]
Degrees = Annotated[Distribution, Between()]
CLEAN = "clean"


class MachineSettings(Table):
    """A rig of the catalogue and what differs from it; drawn once for each virtual machine."""

    rig: Annotated[Distribution, OneOf(tuple(RIGS))]
    """Name of a rig in the catalogue."""
    bearing: Annotated[Distribution, OneOf(tuple(BEARINGS))] | None = None
    """Name of another bearing of the catalogue to mount in the rig."""
    balls: Annotated[Distribution, Whole(3, 200)] | None = None
    """Rolling elements in each row."""
    rows: Annotated[Distribution, Whole(1, 2)] | None = None
    """Rows of rolling elements."""
    pitch_diameter_mm: Positive | None = None
    """Diameter of the circle through the balls' centres, mm."""
    ball_diameter_mm: Positive | None = None
    """Diameter of a rolling element, mm."""
    contact_angle_deg: Annotated[Distribution, Between(0.0, 60.0)] | None = None
    """Contact angle, degrees."""
    row_offset_deg: Degrees | None = None
    """Angle by which row 2 is ahead of row 1, degrees; half a ball spacing if not given."""
    load_deflection: Positive | None = None
    """Factor K of F = K δⁿ for one rolling element between both races, N/mⁿ."""
    exponent: Annotated[Distribution, Between(1.0, 2.0)] | None = None
    """Exponent n of the load-deflection law: 1.5 for balls, 1.1111 for rollers."""
    clearance_um: Annotated[Distribution, Between(-1000.0, 1000.0)] | None = None
    """Radial clearance (half the diametral play), µm; negative: preload."""
    inner_mass_kg: Positive | None = None
    """Mass of inner ring and shaft, kg."""
    outer_mass_kg: Positive | None = None
    """Mass of outer ring and support, kg."""
    resonator_mass_kg: Positive | None = None
    """Mass of the high-frequency resonator, kg."""
    support_stiffness_x_n_per_m: Positive | None = None
    """Stiffness of the outer ring's support along x, N/m."""
    support_stiffness_y_n_per_m: Positive | None = None
    """Stiffness of the outer ring's support along y, N/m."""
    resonator_stiffness_n_per_m: Positive | None = None
    """Stiffness of the high-frequency resonator, N/m."""
    support_damping_x_n_s_per_m: NotNegative | None = None
    """Damping of the outer ring's support along x, N s/m."""
    support_damping_y_n_s_per_m: NotNegative | None = None
    """Damping of the outer ring's support along y, N s/m."""
    resonator_damping_n_s_per_m: NotNegative | None = None
    """Damping of the high-frequency resonator, N s/m."""
    film_damping_n_s_per_m: NotNegative | None = None
    """Viscous damping of one loaded contact, N s/m."""
    separate_cages: Annotated[Distribution, OneOf((False, True))] = Fixed(False)
    """True gives each row of a two-row bearing its own cage, with its own slip."""


class WavinessSettings(Table):
    """Harmonics of one race: order by order a drawn amplitude, which falls with the order."""

    race: Annotated[Distribution, OneOf(("outer", "inner"))]
    """The wavy race."""
    orders: tuple[Order, Order] = Field(strict=False)
    """First and last order (waves round the race)."""
    amplitude_um: NotNegative
    """Amplitude of the first order, µm; drawn anew for each order."""
    decay: Annotated[Distribution, Between(-4.0, 4.0)] = Fixed(1.0)
    """The amplitude of order k is multiplied by (first order / k) to this power."""
    phase_deg: Degrees = Uniform(0.0, 360.0)
    """Phase of each order, degrees."""

    @model_validator(mode="after")
    def _rising_orders(self) -> WavinessSettings:
        if self.orders[0] > self.orders[1]:
            raise refuse("the first order comes first", "orders", "[first order, last order]")
        return self


class ImperfectionSettings(Table):
    """What a perfect bearing lacks; drawn once for each virtual machine."""

    waviness: tuple[WavinessSettings, ...] = Field(default=(), strict=False)
    """Waviness of the races."""
    ball_deviation_um: Annotated[Distribution, Between(-1000.0, 1000.0)] = Fixed(0.0)
    """Diameter of each ball minus the nominal one, µm; drawn for each ball."""


class _OrClean(Between):
    """A number as `Between`, or the word "clean"."""

    def allowed(self) -> str:
        return f'{super().allowed()}, or "{CLEAN}"'

    def accepts(self, value: Any) -> bool:
        return value == CLEAN or super().accepts(value)

    def value_schema(self) -> dict[str, Any]:
        return {"anyOf": [super().value_schema(), {"const": CLEAN}]}


class BackgroundSettings(Table):
    """Noise that belongs to the virtual machine, the same in all its records, in absolute units."""

    white_rms_m_s2: NotNegative = Fixed(0.0)
    """Standard deviation of white noise on each axis, from 0 to half the sampling rate, m/s²."""
    white_snr_db: Annotated[Distribution, _OrClean(-100.0, 200.0)] | None = None
    """Drawn for each record: power of the clean y axis over that of its white noise, from 0 to half the sampling rate,
    in dB, or "clean" for no noise. It replaces white_rms_m_s2 for size studies; a real machine's floor is absolute."""

    @model_validator(mode="after")
    def _one_level(self) -> BackgroundSettings:
        if self.white_snr_db is not None and self.white_rms_m_s2 != Fixed(0.0):
            raise refuse("the noise has two levels", "white_snr_db", "only one of white_rms_m_s2, white_snr_db")
        return self
