"""What a recipe says of the background: layers whose levels belong to the virtual machine, in absolute units."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field, model_validator

from datagen.distributions.kinds import Distribution, Fixed, Uniform
from datagen.recipes.quantities import RATIOS_DB, Frequency, Share
from datagen.recipes.recording_settings import RecordedLayerSettings
from datagen.settings.table import Between, Table, Whole, at_most_one, refuse, rising
from physics.backgrounds.gear_mesh import MOST_SIDEBANDS, MOST_TEETH
from physics.backgrounds.impulses import LARGEST_SPREAD, MOST_PER_SECOND
from physics.backgrounds.pink import STEEPEST
from physics.backgrounds.shaft_harmonics import HIGHEST_ORDER
from physics.checks import HIGHEST_DAMPING

# Up to a hundred thousand times gravity: more than any accelerometer takes. Far more would not fit what is stored.
Acceleration = Annotated[Distribution, Between(0.0, 1e6)]
Decay = Annotated[Distribution, Between(-4.0, 8.0)]
Order = Annotated[int, Field(ge=1, le=HIGHEST_ORDER)]
Lines = Annotated[int, Field(ge=1, le=200)]


class PinkSettings(Table):
    """Noise that falls with frequency."""

    rms_m_s2: Acceleration
    """Standard deviation on each axis from lowest_hz to half the sampling rate, m/s²."""
    lowest_hz: Frequency = Fixed(1.0)
    """Frequency below which there is none, Hz."""
    slope: Annotated[Distribution, Between(0.0, STEEPEST)] = Fixed(1.0)
    """Power density falls as frequency to minus this."""


class ShaftSettings(Table):
    """Tones at whole multiples of the shaft's frequency."""

    orders: Annotated[tuple[Order, Order], AfterValidator(rising)] = Field(default=(1, 4), strict=False)
    """First and last multiple."""
    amplitude_m_s2: Acceleration
    """Amplitude of the first order on each axis, m/s²; drawn anew for each order."""
    decay: Decay = Fixed(1.0)
    """The amplitude of order k is multiplied by (first order / k) to this power."""


class GearSettings(Table):
    """Gear mesh with sidebands of both gears' shafts."""

    teeth: Annotated[Distribution, Whole(1, MOST_TEETH)]
    """Teeth of the gear on the bearing's shaft."""
    other_teeth: Annotated[Distribution, Whole(0, MOST_TEETH)] = Fixed(0)
    """Teeth of the other gear, which sets its shaft's speed; 0: it makes no sidebands."""
    amplitude_m_s2: Acceleration
    """Amplitude of the mesh frequency on each axis, m/s²; drawn anew for each harmonic."""
    harmonics: Lines = 3
    """Harmonics of the mesh frequency."""
    decay: Decay = Fixed(1.0)
    """The amplitude of harmonic h is multiplied by h to minus this power."""
    sidebands: Annotated[Distribution, Whole(0, MOST_SIDEBANDS)] = Fixed(2)
    """Sidebands of each shaft on each side of each harmonic."""
    modulation: Share = Fixed(0.3)
    """Depth of the modulation by the bearing's shaft; half of its k-th power is what sideband k has of its harmonic."""
    other_modulation: Share = Fixed(0.3)
    """The same by the other shaft."""


class HumSettings(Table):
    """Tones at whole multiples of the mains frequency."""

    frequency_hz: Frequency = Fixed(50.0)
    """Mains frequency, Hz."""
    amplitude_m_s2: Acceleration
    """Amplitude of the mains frequency on each axis, m/s²; drawn anew for each harmonic."""
    harmonics: Lines = 4
    """Harmonics, the mains frequency itself counted."""
    decay: Decay = Fixed(1.0)
    """The amplitude of harmonic h is multiplied by h to minus this power."""


class ImpulseSettings(Table):
    """Knocks at random instants that ring resonances of the machine."""

    per_second: Annotated[Distribution, Between(0.0, MOST_PER_SECOND)]
    """Knocks a second on average."""
    amplitude_m_s2: Acceleration
    """Median height of a knock, m/s²: what it would rise to if it did not decay, the sum over its resonances."""
    spread: Annotated[Distribution, Between(0.0, LARGEST_SPREAD)] = Fixed(0.5)
    """Standard deviation of the natural logarithm of the height."""
    resonances: Annotated[Distribution, Whole(1, 20)] = Fixed(2)
    """Number of resonances."""
    frequency_hz: Frequency
    """Frequency at which each rings, Hz, below half the sampling rate."""
    damping: Annotated[Distribution, Between(0.0, HIGHEST_DAMPING, above=True)] = Uniform(0.01, 0.05)
    """Damping of each: it decays as exp(−2π · damping · frequency · time)."""


class BackgroundSettings(Table):
    """Layers that belong to the virtual machine, the same in all its records, in absolute units. A ratio, if asked for,
    is drawn for each record."""

    white_rms_m_s2: Acceleration = Fixed(0.0)
    """Standard deviation of white noise on each axis, from 0 to half the sampling rate, m/s²."""
    pink: PinkSettings | None = None
    """Noise that falls with frequency."""
    shaft_harmonics: ShaftSettings | None = None
    """Tones of the shaft."""
    gear_mesh: GearSettings | None = None
    """Tones of a pair of gears."""
    mains_hum: HumSettings | None = None
    """Tones of the mains."""
    impulses: ImpulseSettings | None = None
    """Random knocks."""
    recording: RecordedLayerSettings | None = None
    """Stretches of a recording of a healthy machine."""
    snr_band_hz: tuple[float, float] | None = Field(default=None, strict=False)
    """Band of the label snr_band_db, Hz; by default that of the envelope."""
    snr_db: Annotated[Distribution, RATIOS_DB] | None = None
    """Scales the whole background of each record to this ratio up to half the sampling rate, dB; signal and background
    count without their means, so a tone of less than a period a record hardly counts. Where either has no power, the
    level stays as it is, and the label validity says so."""
    snr_band_db: Annotated[Distribution, RATIOS_DB] | None = None
    """The same over snr_band_hz, dB."""

    @property
    def has_layers(self) -> bool:
        """True if any layer can have a level above zero."""
        tables = (self.pink, self.shaft_harmonics, self.gear_mesh, self.mains_hum, self.impulses, self.recording)
        return any(table is not None for table in tables) or max(self.white_rms_m_s2.stated()) > 0.0

    @model_validator(mode="after")
    def _consistent(self) -> BackgroundSettings:
        at_most_one(self, "snr_db", "snr_band_db")
        target = next((name for name in ("snr_db", "snr_band_db") if getattr(self, name) is not None), None)
        if target is not None and not self.has_layers:
            raise refuse("there is no layer to scale", target, "a layer beside it, such as white_rms_m_s2 = 1")
        if self.snr_band_hz is not None and not 0.0 <= self.snr_band_hz[0] < self.snr_band_hz[1]:
            raise refuse("the band is empty", "snr_band_hz", "0 <= low < high <= half the sampling rate")
        return self
