"""What a recipe says of the imperfections of a virtual machine's bearing."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

from datagen.distributions.kinds import Distribution, Fixed, Uniform
from datagen.recipes.quantities import Degrees
from datagen.settings.table import Between, OneOf, Table, rising
from physics.bearing import RACES
from physics.imperfections import HIGHEST_ORDER, LARGEST_DEVIATION

Scale = Annotated[Distribution, Between(0.0, 1e3)]
Order = Annotated[int, Field(ge=1, le=HIGHEST_ORDER)]
LARGEST_DEVIATION_UM = LARGEST_DEVIATION * 1e6


class WavinessSettings(Table):
    """Harmonics of one race: order by order a drawn amplitude, which falls with the order."""

    race: Annotated[Distribution, OneOf(RACES)]
    """The wavy race."""
    orders: Annotated[tuple[Order, Order], AfterValidator(rising)] = Field(strict=False)
    """First and last order (waves round the race)."""
    amplitude_um: Annotated[Distribution, Between(0.0, 1e3)]
    """Amplitude of the first order, µm; drawn anew for each order. With decay and waviness_scale none may come to more
    than 10 mm, beyond which a race is no circle."""
    decay: Annotated[Distribution, Between(-4.0, 4.0)] = Fixed(1.0)
    """The amplitude of order k is multiplied by (first order / k) to this power."""
    phase_deg: Degrees = Uniform(0.0, 360.0)
    """Phase of each order, degrees."""


class ImperfectionSettings(Table):
    """What a perfect bearing lacks; drawn once for each virtual machine."""

    waviness: tuple[WavinessSettings, ...] = Field(default=(), strict=False)
    """Waviness of the races."""
    ball_deviation_um: Annotated[Distribution, Between(-LARGEST_DEVIATION_UM, LARGEST_DEVIATION_UM)] = Fixed(0.0)
    """Diameter of each ball minus the nominal one, µm; drawn for each ball."""
    waviness_scale: Scale = Fixed(1.0)
    """Factor on every amplitude of a machine's waviness."""
    ball_deviation_scale: Scale = Fixed(1.0)
    """Factor on every ball deviation of a machine; none may come to more than 1 mm."""
