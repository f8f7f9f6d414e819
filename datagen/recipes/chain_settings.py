"""What a recipe says of the measurement chain: resonant paths to the sensor, its mounting, the recorder."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from datagen.distributions.kinds import Distribution, Fixed
from datagen.recipes.quantities import Frequency
from datagen.settings.table import Between, Table, Whole
from physics.checks import HIGHEST_DAMPING
from physics.sensor.mounting import HIGHEST_ORDER
from physics.sensor.recorder import FEWEST_BITS, MOST_BITS

MOST_MODES = 50
Gain = Annotated[Distribution, Between(0.0, 1e6)]


class ModeSettings(Table):
    """Resonances between the outer ring and the sensor, drawn alike and independently."""

    count: Annotated[Distribution, Whole(0, MOST_MODES)] = Fixed(1)
    """Number of resonances."""
    frequency_hz: Frequency
    """Natural frequency of each, Hz, below half the sampling rate."""
    damping: Annotated[Distribution, Between(0.0, HIGHEST_DAMPING, above=True)]
    """Damping of each, as a share of the critical."""
    gain: Gain = Fixed(1.0)
    """Gain of each: 1 measures the mass that the outer ring shakes."""


class ChainSettings(Table):
    """The measurement chain, drawn once for each virtual machine; the paper's resonator alone if nothing is said."""

    resonator_gain: Gain = Fixed(1.0)
    """Factor of the resonator's acceleration."""
    mounting_cutoff_hz: Frequency | None = None
    """Frequency at which the mounting passes half the power, Hz; no low-pass if not given. The filter is digital, so
    near half the sampling rate its phase depends on that."""
    mounting_order: Annotated[Distribution, Whole(1, HIGHEST_ORDER)] = Fixed(6)
    """Order of the mounting's Butterworth low-pass; no effect without mounting_cutoff_hz."""
    recorder_range_m_s2: Annotated[Distribution, Between(1e-6, 1e9)] | None = None
    """Largest acceleration that the recorder holds, m/s²; no rounding and no clipping if not given."""
    recorder_bits: Annotated[Distribution, Whole(FEWEST_BITS, MOST_BITS)] = Fixed(16)
    """Bits of the recorder over its range on both sides of zero; no effect without recorder_range_m_s2."""
    modes: tuple[ModeSettings, ...] = Field(default=(), strict=False)
    """Resonances driven by the outer ring, added to the resonator's acceleration."""
