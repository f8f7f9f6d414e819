"""What a SPEC can say of a recording, alike on every level: defaults, recording, label table, override."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import FORMATS
from datagen.recipes.quantities import DIAMETERS_MM
from datagen.recordings.values import RANGES, FromVariable, finite_notes, number, word
from datagen.settings.table import Table, at_most_one, refuse
from labels.schema import CONDITIONS, LABEL, LOCATIONS, SPLITS, UNKNOWN
from physics.bearing import (
    FEWEST_BALLS,
    LARGEST_CONTACT_ANGLE_DEG,
    LARGEST_EXPONENT,
    MOST_BALLS,
    MOST_ROWS,
    SMALLEST_EXPONENT,
)

UNITS = {"m/s2": 1.0, "g": 9.80665}
# Units that a scale makes of these.
SCALED_UNITS = {"mm/s2": ("m/s2", 1e-3), "cm/s2": ("m/s2", 1e-2), "mg": ("g", 1e-3)}
VELOCITIES = ("m/s", "cm/s", "mm/s", "um/s", "in/s", "ips")
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
# Longer than any recording, s.
LONGEST_S = 1e9
Diameter = Annotated[float, Field(ge=DIAMETERS_MM.low, le=DIAMETERS_MM.high)]
VOLTS = 'volts of a sensor need a scale: unit = "g" and scale = 10 for 100 mV/g, 0.01 for mV'
IN_WORDS = "none means healthy, unknown that nobody said"
FOLLOWS = "it follows from location and extent and can be left out: location says what is damaged"
Name = Annotated[str, Field(min_length=1, max_length=120)]


def _of_acceleration(unit: object) -> object:
    """The unit; raises PydanticCustomError for that of a velocity, and says how one is written that a scale makes of
    another."""
    name = unit.casefold() if isinstance(unit, str) else ""
    if name in SCALED_UNITS:
        whole, scale = SCALED_UNITS[name]
        raise refuse("is written with a scale", allowed=f'unit = "{whole}" and scale = {scale:g}')
    if name in VELOCITIES:
        raise refuse("is that of a velocity", allowed=f"acceleration in {' or '.join(UNITS)}: differentiate it before")
    return unit


class Channel(Table):
    """One sensor: each of its records holds the axes that are given."""

    name: str = ""
    """Name of the channel, stored with its records."""
    x: str | None = None
    """Variable of the axis across the load."""
    y: str | None = None
    """Variable of the axis along the load, against it; also that of a sensor with one axis only."""

    @model_validator(mode="after")
    def _has_an_axis(self) -> Channel:
        if self.x is None and self.y is None:
            raise refuse("the channel has no variable", "y", "the name of a variable")
        return self


class Tach(Table):
    """Pulses of the shaft from which its mean speed is computed: a channel, or the times of them."""

    variable: str
    """Variable of the pulses."""
    pulses_per_rev: Annotated[float, Field(ge=1e-3, le=1e6)] = 1.0
    """Pulses per revolution of the shaft."""
    threshold: Annotated[float, Field(allow_inf_nan=False)] | None = None
    """Level that a pulse rises through, in the channel's own unit; half-way between its extremes if not given."""
    rate_hz: Annotated[float, Field(ge=RANGES["rate_hz"].low, le=RANGES["rate_hz"].high)] | None = None
    """Sampling rate of the pulses, if not that of the vibration."""
    times: bool = False
    """True for a variable that holds the times of the pulses, s. They are counted from the first sample of the
    vibration or, where `rate_hz` is read from the times of its samples, by the same clock."""
    factor: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] = 1.0
    """What such times are multiplied by to be seconds."""

    @model_validator(mode="after")
    def _sampled_or_listed(self) -> Tach:
        if self.times and (self.rate_hz is not None or self.threshold is not None):
            raise refuse("times of pulses have neither a sampling rate nor a threshold", "times", "false")
        if self.factor != 1.0 and not self.times:
            raise refuse("it brings times to s, and this is a channel", "factor", "1, or times = true")
        return self


class BearingNumbers(Table):
    """The geometry of a bearing that the catalogue does not have."""

    name: Name = UNKNOWN
    """Designation."""
    balls: Annotated[int, Field(ge=FEWEST_BALLS, le=MOST_BALLS)]
    """Rolling elements in one row."""
    rows: Annotated[int, Field(ge=1, le=MOST_ROWS)] = 1
    """Rows of rolling elements."""
    pitch_diameter_mm: Diameter
    """Diameter of the circle through the balls' centres, mm."""
    ball_diameter_mm: Diameter
    """Diameter of a rolling element, mm."""
    contact_angle_deg: Annotated[float, Field(ge=0.0, le=LARGEST_CONTACT_ANGLE_DEG)] = 0.0
    """Contact angle, degrees."""
    load_deflection_n_per_m_to_n: Positive | None = None
    """K of F = K δⁿ for one rolling element between both races, which tells sizes better where the load is known."""
    exponent: Annotated[float, Field(ge=SMALLEST_EXPONENT, le=LARGEST_EXPONENT)] | None = None
    """n of that law, 10/9 for rollers; 3/2, that of balls, if not given."""


class RecordingSettings(Table):
    """All that can be said of one recording; what is not said is unknown."""

    format: Annotated[str, word(*FORMATS)] | None = None
    """File format; by default that of the file's ending."""
    csv: CsvLayout | None = None
    """Layout of text tables."""
    channel: tuple[Channel, ...] | None = Field(default=None, strict=False, min_length=1)
    """Channels, each of which becomes a record of its own."""
    x: str | None = None
    """Variable of the axis across the load, where there is one channel."""
    y: str | None = None
    """Variable of the axis along the load, where there is one channel."""
    channel_name: str | None = None
    """Name of that one channel."""
    rate_hz: Annotated[float | FromVariable, number("rate_hz")] | None = None
    """Sampling rate, Hz; a .wav file says it itself."""
    unit: Annotated[str, BeforeValidator(_of_acceleration), word(*UNITS, remark=VOLTS)] | None = None
    """Unit of the samples times `scale`."""
    scale: Annotated[float | FromVariable, number("scale")] | None = None
    """What the stored numbers are multiplied by; 1 if not given."""
    speed_rpm: Annotated[float | FromVariable, number("speed_rpm")] | None = None
    """Speed of the shaft, revolutions per minute."""
    speed_hz: Annotated[float | FromVariable, number("speed_hz")] | None = None
    """Speed of the shaft, revolutions per second."""
    tach: Tach | None = None
    """Pulses that give the speed."""
    nominal_speed_rpm: Annotated[float | FromVariable, number("nominal_speed_rpm")] | None = None
    """Speed to assume where the variable of `speed_rpm` or `speed_hz` is absent, where `tach` is absent or shows no
    pulse, or where none of these is given. A tach must agree with it within 20 %."""
    missing_samples: Annotated[str, word("refuse", "fill")] | None = None
    """Samples that are no finite numbers: refused, or filled in gaps of 10 at most, 1 % of all."""
    bearing: str | BearingNumbers | None = None
    """Name of a bearing in the catalogue, or its geometry."""
    from_s: Annotated[float, Field(ge=0.0, le=LONGEST_S)] | None = None
    """Where the part that is taken begins, s from the first sample; there if not given."""
    to_s: Annotated[float, Field(gt=0.0, le=LONGEST_S)] | None = None
    """Where that part ends, s from the first sample; with the last one if not given."""
    cut_s: Annotated[float, Field(gt=0.0, le=LONGEST_S)] | None = None
    """Length of the pieces that this part is cut into, s; whole if not given. A shorter rest is left out."""
    envelope_band_hz: tuple[float, float] | None = Field(default=None, strict=False)
    """Band of the stored envelope, Hz; by default the most impulsive band of the y axis."""
    recording: Name | None = None
    """Name of the record, which may hold {stem}, {number}, {folder}, {path} and {channel}; by default the file's name
    without its ending, and the channel's."""
    bearing_id: Name | None = None
    """The individual bearing, named likewise: records of one must stay in one split."""
    rig: Name | None = None
    """Name of the machine, which may hold the same."""
    split: Annotated[str, word(*SPLITS, UNKNOWN)] | None = None
    """Split that the record belongs to."""
    condition: Annotated[str, word(*CONDITIONS, UNKNOWN, remark=FOLLOWS)] | None = None
    """State of the bearing; by default what location and extent say."""
    location: Annotated[str, word(*LOCATIONS, *LABEL["location"].imported, remark=IN_WORDS)] | None = None
    """What is defective."""
    spalls: Annotated[int, Field(ge=0, le=10_000)] | None = None
    """Number of defects."""
    extent_mm: Annotated[float | FromVariable, number("extent_mm")] | None = None
    """Length of the defect along its raceway, mm."""
    extent_deg: Annotated[float | FromVariable, number("extent_deg")] | None = None
    """Arc covered by the defect, degrees."""
    depth_um: Annotated[float | FromVariable, number("depth_um")] | None = None
    """Depth of the defect, µm."""
    load_n: Annotated[float | FromVariable, number("load_n")] | None = None
    """Radial load on the shaft, N."""
    snr_db: Annotated[float | FromVariable, number("snr_db")] | None = None
    """Signal-to-noise ratio, dB."""
    bpfo: Annotated[float | FromVariable, number("bpfo")] | None = None
    """Ball-pass order of the outer race, where the geometry is unknown."""
    bpfi: Annotated[float | FromVariable, number("bpfi")] | None = None
    """Ball-pass order of the inner race, where the geometry is unknown."""
    bsf: Annotated[float | FromVariable, number("bsf")] | None = None
    """Spin order of a ball, where the geometry is unknown."""
    ftf: Annotated[float | FromVariable, number("ftf")] | None = None
    """Order of the cage, below 1, where the geometry is unknown."""
    notes: Annotated[dict[str, str | float | int | bool], AfterValidator(finite_notes)] | None = None
    """Anything else worth keeping; stored as it is."""

    @model_validator(mode="after")
    def _says_nothing_twice(self) -> RecordingSettings:
        for group in ALTERNATIVES:
            at_most_one(self, *(name for name in group if name in type(self).model_fields))
        if self.channel is not None and (self.x is not None or self.y is not None):
            raise refuse("x and y are those of the one channel; a list of channels has its own", "channel")
        return self

    @model_validator(mode="after")
    def _exponent_of_a_factor(self) -> RecordingSettings:
        said = self.bearing
        if isinstance(said, BearingNumbers) and said.exponent and not said.load_deflection_n_per_m_to_n:
            raise refuse("an exponent needs its factor K", "bearing.load_deflection_n_per_m_to_n", "a number above 0")
        return self

    def given(self) -> dict[str, Any]:
        """The settings that are given, by name, in the order in which they are declared: `provenance` keeps it."""
        values = {name: getattr(self, name) for name in type(self).model_fields if name in self.model_fields_set}
        return {name: value for name, value in values.items() if value is not None}


ALTERNATIVES = (("speed_rpm", "speed_hz", "tach"), ("extent_mm", "extent_deg"))
REPLACED_BY = {name: group for group in ALTERNATIVES for name in group} | {
    "x": ("channel",),
    "y": ("channel",),
    "channel": ("x", "y", "channel_name"),
}


def merged(lower: dict[str, Any], upper: dict[str, Any]) -> dict[str, Any]:
    """Settings in which `upper` goes before `lower`; notes are joined, and alternatives replace each other."""
    replaced = {name for given in upper for name in REPLACED_BY.get(given, ())}
    kept = {name: value for name, value in lower.items() if name not in replaced}
    notes = {**lower.get("notes", {}), **upper.get("notes", {})}
    return kept | upper | ({"notes": notes} if notes else {})
