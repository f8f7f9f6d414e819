"""Kinds of number that several tables of a recipe share, each drawn from a distribution."""

from __future__ import annotations

from typing import Annotated

from datagen.distributions.kinds import Distribution
from datagen.settings.table import Angle, Between

Degrees = Annotated[Distribution, Angle()]
Frequency = Annotated[Distribution, Between(1e-3, 1e7)]  # Hz
Share = Annotated[Distribution, Between(0.0, 1.0)]
