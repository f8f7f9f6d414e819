"""What a recipe says of how exactly its records are simulated."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from datagen.settings.table import Table
from physics.response.part import LARGEST_ACCURACY, SMALLEST_ACCURACY


class AccuracySettings(Table):
    """The error that records may have; the cheapest steps that keep it are taken."""

    relative: Annotated[float, Field(ge=SMALLEST_ACCURACY, le=LARGEST_ACCURACY)] = 1e-3
    """RMS error of the clean acceleration over its RMS."""
    below_noise_db: Annotated[float, Field(ge=0.0, le=200.0)] | None = None
    """How far below the record's own white noise, or a background of given signal-to-noise ratio over the whole band,
    an error may always be, dB; nothing more is allowed if not given."""
