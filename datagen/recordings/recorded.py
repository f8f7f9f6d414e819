"""One request turned into records: samples in m/s², labels, and where every number came from."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.formats.placeholders import without_ending
from datagen.formats.reading import file_format
from datagen.formats.wav_file import RATE_NAME
from datagen.recipes.signal_settings import FEWEST_STORED_SAMPLES
from datagen.recordings.description import contact_numbers, recording_labels
from datagen.recordings.doubts import (
    defect_doubts,
    geometry_doubts,
    level_doubts,
    scale_doubts,
    speed_doubts,
    standing_doubt,
)
from datagen.recordings.listing import Request
from datagen.recordings.opened_files import open_source, source_hash
from datagen.recordings.settings import UNITS
from datagen.recordings.shaft_speed import shaft_speeds, told_course
from datagen.recordings.source import FILL, Source, span_of
from datagen.recordings.stated_rate import rate_doubts
from datagen.recordings.values import RANGES, FromVariable, in_range
from labels.band import holds_a_line
from labels.dead_sensor import is_dead
from labels.filling import foretold
from labels.kurtogram import most_impulsive_band
from labels.variables import AXES
from physics.angular_speed import RPM_PER_HZ
from physics.arrays import Array

LARGEST_ACCELERATION = 1e9
Key = tuple[float, int, tuple[str, ...], tuple[str, ...], bool]


@dataclass(frozen=True)
class Recorded:
    """One record before it has an index: `acceleration` (T, axes) m/s² at `rate` (Hz), `labels` as far as known.

    `content` is a hash, the same for the same samples at the same rate; `shaft_angle` (T,), rad, is given if the speed
    changes, else None. `dead` are the axes without a signal, as if the sensor were not connected; `doubts` says what
    else is odd, with figures.
    """

    acceleration: NDArray[np.float32]
    axes: tuple[str, ...]
    rate: float
    labels: dict[str, Any]
    provenance: str
    content: str
    shaft_angle: NDArray[np.float64] | None
    dead: tuple[str, ...]
    doubts: dict[str, str]

    @property
    def key(self) -> Key:
        """What the records of one shard have in common: rate, length, axes, which labels are known at all, and whether
        the angle of the shaft is."""
        names = tuple(sorted(self.labels))
        return (self.rate, self.acceleration.shape[0], self.axes, names, self.shaft_angle is not None)

    @property
    def turns(self) -> float:
        """Turns of the shaft in it; infinite if the speed is unknown or 0."""
        turns = _turns(self.labels)
        return turns if turns > 0.0 else math.inf

    @property
    def bytes(self) -> int:
        """How much memory its signals take."""
        return self.acceleration.nbytes + (0 if self.shaft_angle is None else self.shaft_angle.nbytes)


def _turns(labels: Mapping[str, Any]) -> float:
    """Turns of the shaft in the record with these labels; NaN if its speed is unknown."""
    return float(labels["speed_rpm"]) / RPM_PER_HZ * float(labels["duration_s"])


def read_recording(request: Request, known_band: tuple[float, float] | None = None) -> Iterator[Recorded]:
    """The record of a request, or its pieces in order if it is to be cut; raises BadInput.

    `known_band` (Hz): the band of its envelope, where an earlier reading has found it.
    """
    source = open_source(request)
    axes = tuple(axis for axis in AXES if getattr(request.channel, axis) is not None)
    rate = _rate(source)
    counts = _samples(source, axes)
    filled = _filled(source, axes)
    factor = _scale(source)
    part = _part(source, rate, counts.shape[0])
    pieces = _pieces(source, rate, part)
    shortest = min(stop - start for start, stop in pieces)
    along = counts[slice(*part), axes.index("y")] if "y" in axes else None
    band = _band(source, rate, shortest, along) if known_band is None else known_band
    labels = recording_labels(source) | {"rate_hz": rate, "envelope_band": band}
    stated = geometry_doubts(labels) | defect_doubts(labels)
    of_file = scale_doubts(source) | rate_doubts(source, rate, counts.shape[0]) | stated
    speeds = shaft_speeds(source, rate, counts.shape[0], part, pieces)
    for piece, ((start, stop), speed) in enumerate(zip(pieces, speeds, strict=True)):
        samples = counts[start:stop]
        of_piece = {
            "recording": _name(source) + (f"#{piece}" if request.settings.get("cut_s") else ""),
            "speed_rpm": speed.rpm,
            "speed_basis": speed.basis,
            "duration_s": samples.shape[0] / rate,
        }
        acceleration = _accelerations(samples, factor, source)
        dead = tuple(axis for axis, signal in zip(axes, acceleration.T, strict=True) if is_dead(signal))
        yield Recorded(
            acceleration=acceleration,
            axes=axes,
            rate=rate,
            labels=labels | of_piece,
            provenance=_provenance(source, factor, start, stop, {"pulses": speed.mended, "samples": filled}, dead),
            content=_samples_hash(rate, *samples.T),
            shaft_angle=speed.angle,
            dead=dead,
            doubts=of_file
            | level_doubts(acceleration, axes, dead)
            | speed_doubts(of_piece, _turns(of_piece), request.settings)
            | standing_doubt(told_course(source, span_of(start, stop, counts.shape[0]))),
        )


def _name(source: Source) -> str:
    parts = (without_ending(source.path), source.request.channel.name)
    return source.text("recording", " ".join(part for part in parts if part))


def _rate(source: Source) -> float:
    stated = source.number("rate_hz")
    if file_format(source.path, source.setting("format")) == "wav":
        held = float(source.arrays[RATE_NAME])
        if stated not in (None, held):
            raise source.refusal("the file states another rate", "rate_hz", stated, f"{held:g}")
        if not in_range("rate_hz", held):
            raise source.refusal("the file's own", "rate_hz", held, RANGES["rate_hz"].allowed())
        return held
    if stated is None:
        raise BadInput(
            "the sampling rate is not given", file=source.request.place, field="rate_hz",
            allowed=f'{RANGES["rate_hz"].allowed()}, or {{variable = "NAME"}}',
        )  # fmt: skip
    return stated


def _samples(source: Source, axes: tuple[str, ...]) -> NDArray[np.float64]:
    """The stored numbers (T, axes)."""
    columns = [source.array(getattr(source.request.channel, axis), axis, foretold) for axis in axes]
    if len({column.size for column in columns}) > 1:
        sizes = " and ".join(str(column.size) for column in columns)
        raise BadInput(f"the axes differ in length: {sizes} samples", file=str(source.path), field="x, y")
    return np.stack(columns, axis=1)


def _filled(source: Source, axes: tuple[str, ...]) -> int:
    """How many missing samples of all axes are filled; 0 unless that is asked for, as they are then refused when
    read."""
    if source.setting("missing_samples") != FILL:
        return 0
    return sum(source.missing(getattr(source.request.channel, axis), axis).size for axis in axes)


def _scale(source: Source) -> float:
    unit = source.setting("unit")
    if unit is None:
        raise BadInput(
            "the unit of the samples is not given", file=source.request.place, field="unit", allowed=", ".join(UNITS)
        )
    scale = source.number("scale")
    if scale == 0.0:
        told_by = str(source.path) if isinstance(source.setting("scale"), FromVariable) else source.request.place
        raise BadInput(file=told_by, field="scale", value=0.0, allowed="any number but 0")
    return UNITS[unit] * (1.0 if scale is None else scale)


def _accelerations(counts: NDArray[np.float64], factor: float, source: Source) -> NDArray[np.float32]:
    """Stored numbers (T, axes) in m/s²."""
    with np.errstate(over="ignore"):
        scaled = counts * factor
    largest = float(np.abs(scaled).max())
    if not largest <= LARGEST_ACCELERATION:
        raise source.refusal(
            f"the largest sample would be {largest:.3g} m/s²",
            "scale",
            source.number("scale") or 1.0,
            f"samples up to {LARGEST_ACCELERATION:g} m/s²",
        )
    return scaled.astype(np.float32)


def _band(source: Source, rate: float, samples: int, signal: NDArray[np.float64] | None) -> tuple[float, float]:
    """Band (Hz) of the envelope of the y axis, whose `signal` (T,) is cut into pieces of at least `samples`; NaN
    without one."""
    if signal is None:
        return math.nan, math.nan
    stated = source.setting("envelope_band_hz")
    if stated is None:
        return most_impulsive_band(signal, rate, samples)
    low, high = stated
    if not 0.0 <= low < high <= rate / 2.0:
        allowed = f"0 <= low < high <= {rate / 2.0:g} (half the rate)"
        raise BadInput(file=source.request.place, field="envelope_band_hz", value=list(stated), allowed=allowed)
    if not holds_a_line(stated, samples, rate):
        apart = rate / samples
        raise BadInput(
            f"contains no line ({apart:g} Hz apart) of the spectrum of {source.path.name} ({samples} samples)",
            file=source.request.place,
            field="envelope_band_hz",
            value=list(stated),
            allowed=f"a band at least {apart:g} Hz wide",
        )
    return low, high


def _part(source: Source, rate: float, size: int) -> tuple[int, int]:
    """The first of the `size` samples that is taken, and the one after the last."""
    start_s, stop_s = source.setting("from_s"), source.setting("to_s")
    start = 0 if start_s is None else round(start_s * rate)
    stop = size if stop_s is None else round(stop_s * rate)
    if stop > size or stop - start < FEWEST_STORED_SAMPLES:
        field, value = ("from_s", start_s) if stop_s is None else ("to_s", stop_s)
        fewest, length = FEWEST_STORED_SAMPLES / rate, f"{size / rate:g} s, the length of {source.path.name}"
        allowed = f"at least {fewest:g} s between from_s and to_s, both within {length}"
        raise BadInput(file=source.request.place, field=field, value=value, allowed=allowed)
    return start, stop


def _pieces(source: Source, rate: float, part: tuple[int, int]) -> list[tuple[int, int]]:
    start, stop = part
    cut = source.setting("cut_s")
    if cut is None:
        return [part]
    length, size = round(cut * rate), stop - start
    if not FEWEST_STORED_SAMPLES <= length <= size:
        is_part = {"from_s", "to_s"} & source.request.settings.keys()
        of_what = "the part from from_s to to_s" if is_part else "the length"
        allowed = f"{FEWEST_STORED_SAMPLES / rate:g} to {size / rate:g} s, {of_what} of {source.path.name}"
        raise BadInput(file=source.request.place, field="cut_s", value=cut, allowed=allowed)
    return [(start + k * length, start + (k + 1) * length) for k in range(size // length)]


def _provenance(
    source: Source, factor: float, start: int, stop: int, mended: dict[str, int], dead: tuple[str, ...]
) -> str:
    request = source.request
    wishes = {axis: wish for axis in AXES if (wish := getattr(request.channel, axis)) is not None}
    wishes |= {name: said.variable for name, said in request.settings.items() if isinstance(said, FromVariable)}
    return json.dumps(
        {
            "file": request.name,
            "sha256": source_hash(request.path),
            "variables": {field: name for field, wish in wishes.items() if (name := source.variable(wish, field))},
            "first_sample": start,
            "samples": stop - start,
            "m_s2_per_number": factor,
            "parameters": contact_numbers(source),
            "notes": request.settings.get("notes", {}),
        }
        | {f"mended_{what}": count for what, count in mended.items() if count}
        | ({"no_signal": dead} if dead else {}),
        allow_nan=False,
    )


def _samples_hash(rate: float, *axes: Array) -> str:
    """Hash by which two recordings with the same samples are known."""
    digest = hashlib.sha256(repr(rate).encode())
    for axis in axes:
        digest.update(np.ascontiguousarray(axis).tobytes())
    return digest.hexdigest()
