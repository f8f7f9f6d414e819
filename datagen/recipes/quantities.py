"""Ranges of numbers that recipes share with the SPEC of recordings, and kinds of number, each drawn from a
distribution, that several tables of a recipe share."""

from __future__ import annotations

from typing import Annotated

from datagen.distributions.kinds import Distribution
from datagen.settings.table import Angle, Between

RATES_HZ = Between(100.0, 1e7)
RATIOS_DB = Between(-100.0, 200.0)
EXTENTS_MM = Between(0.0, 1e4, above=True)
# The balls of bearings are not smaller, and a number below this is a length in m.
DIAMETERS_MM = Between(0.1, 1e5)

Degrees = Annotated[Distribution, Angle()]
Frequency = Annotated[Distribution, Between(1e-3, 1e7)]  # Hz
Share = Annotated[Distribution, Between(0.0, 1.0)]
