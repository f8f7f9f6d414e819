"""How records are sampled: rate, length and the band of the envelope."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from datagen.distributions.kinds import Distribution, Fixed
from datagen.recipes.quantities import RATES_HZ
from datagen.settings.table import Between, Table, refuse
from labels.band import holds_a_line

FEWEST_STORED_SAMPLES = 16


class Signal(Table):
    """How every record is sampled; drawn once for each virtual machine if not fixed."""

    rate_hz: Annotated[Distribution, RATES_HZ]
    """Sampling rate, Hz. A machine takes a sixteenth of the frequency of its fastest mode or more: about 660 Hz for the
    gearbox rig, 619 Hz for the fan rig. With the default envelope_band_hz it takes more than 2.1 times its resonance,
    so that the band is recorded."""
    duration_s: Annotated[Distribution, Between(0.001, 3600.0)]
    """Length of a record, s, rounded to whole samples."""
    settle_s: Annotated[float, Field(ge=0.0, le=60.0)] = 0.0
    """Time that a machine runs before each of its records, s, rounded to whole samples; otherwise it starts at rest."""
    envelope_band_hz: tuple[float, float] | None = Field(default=None, strict=False)
    """Band of the stored envelope, Hz; by default the resonator's coupled mode ± 5 %."""

    @model_validator(mode="after")
    def _long_enough(self) -> Signal:
        rate, duration = self.rate_hz.lowest, self.duration_s.lowest
        if rate * duration < FEWEST_STORED_SAMPLES:
            shortest = f"at least {FEWEST_STORED_SAMPLES / rate:g} at {rate:g} Hz"
            raise refuse(f"a record would hold fewer than {FEWEST_STORED_SAMPLES} samples", "duration_s", shortest)
        return self

    @model_validator(mode="after")
    def _band_below_nyquist(self) -> Signal:
        if self.envelope_band_hz is not None:
            low, high = self.envelope_band_hz
            nyquist = self.rate_hz.lowest / 2.0
            if not 0.0 <= low < high <= nyquist:
                above = "the band is not below half the sampling rate"
                problem = "the band is empty" if low >= high else "the band begins below 0 Hz" if low < 0.0 else above
                raise refuse(problem, "envelope_band_hz", f"0 <= low < high <= {nyquist:g}")
            narrow = self.too_narrow(self.envelope_band_hz)
            if narrow is not None:
                raise refuse(narrow[0], "envelope_band_hz", narrow[1])
        return self

    def too_narrow(self, band: tuple[float, float]) -> tuple[str, str] | None:
        """Problem and what is allowed of a band (Hz) that holds no line of a record's spectrum; None if all hold one.

        Where rate or duration are drawn the band must be as wide as the lines of the shortest record lie apart.
        """
        rate, seconds = self.rate_hz.lowest, self.duration_s.lowest
        spacing = rate / round(rate * seconds)
        drawn = not (isinstance(self.rate_hz, Fixed) and isinstance(self.duration_s, Fixed))
        wide = band[1] - band[0] >= spacing if drawn else holds_a_line(band, round(rate * seconds), rate)
        problem = (
            f"the band may hold none of the lines in the spectrum of {seconds:g} s, which lie {spacing:g} Hz apart"
        )
        return None if wide else (problem, f"a band at least {spacing:g} wide")
