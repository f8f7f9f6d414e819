"""What is odd about a record that is imported all the same: levels and speeds that few machines have, few turns."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.formats.wav_file import WaveArrays
from datagen.recordings.settings import UNITS
from datagen.recordings.source import Source, longest_run

# RMS above which a level is doubted, m/s²: 100 g.
LOUDEST_RMS = 100.0 * UNITS["g"]
# Largest mean over the RMS around it that is not doubted.
LARGEST_OFFSET = 10.0
# Share of the samples at the largest or smallest value of a signal that may follow another such sample, and the number
# of different values below which many of them are no surprise.
MOST_AT_LIMIT = 1e-3
FEWEST_VALUES = 16
# Share of a record, and the number of samples, above which a stretch of one value is doubted: those of recordings that
# are whole have up to 4 samples. So many samples at the beginning do not come again by chance either.
LONGEST_STRETCH, FEWEST_STRETCHED = 0.01, 100
# Turns of the shaft below which a speed is doubted: a spectrum then hardly separates the orders of a bearing.
FEWEST_TURNS = 10.0
# Speed, rpm, below which a stated one may be meant in Hz: few shafts turn faster than 300 times a second.
SLOWEST_RPM = 300.0
# Speed, rpm, below which one is doubted however many turns there are: few machines whose bearings are recorded run so
# slowly, and many sets tell speeds from 10 to 100 Hz.
SLOWEST_LIKELY_RPM = 100.0
# Speed, rpm, above which a stated one may be meant in another unit: few shafts turn faster than 1000 times a second.
FASTEST_LIKELY_RPM = 60_000.0
# Pitch diameter, mm, below which a stated one may be meant in inches: those of dental drills have more.
SMALLEST_PITCH_MM = 4.0
# Balls, by orders that are stated alone, above which these may be frequencies in Hz: few bearings have more.
MOST_LIKELY_BALLS = 60.0
# Extent, mm, below which a stated one may be meant in inches or m: nobody measures shorter spalls.
SHORTEST_LIKELY_MM = 0.02
LOUD = "louder than machines are, as if `scale` or `unit` were wrong"
OFFSET = f"with a mean above {LARGEST_OFFSET:g} times the vibration around it, as of gravity or a sensor's bias"
CLIPPED = "with peaks cut off, as if the recorder's range were too small"
HELD = "with a stretch of one value, as if padded or the signal lost; from_s and to_s take what is beside it"
RISING = "with samples that only rise or only fall, as times or an angle do and no vibration"
AGAIN = "whose beginning comes again exactly, as of a buffer written twice; its period looks like that of a fault"
STANDING = "with a speed that is 0 in places, taken as a shaft that stands there and not as one nobody measured"
OF_LEVEL = (LOUD, OFFSET, CLIPPED, HELD, RISING, AGAIN)
FULL_SCALE = "in whole numbers of .wav without `scale`, taken as ±1 {unit} at full scale"


def level_doubts(acceleration: NDArray[np.float32], axes: Iterable[str], dead: Iterable[str]) -> dict[str, str]:
    """What is odd about the level of the `acceleration` (T, axes), m/s², each doubt with its figures; axes that are
    `dead` are not looked at."""
    signals = {axis: signal for axis, signal in zip(axes, acceleration.T, strict=True) if axis not in dead}
    found: dict[str, list[str]] = {doubt: [] for doubt in OF_LEVEL}
    for axis, signal in signals.items():
        for doubt, figures in _doubts_of(signal):
            found[doubt].append(f"{axis} {figures}".strip())
    return {doubt: ", ".join(figures) for doubt, figures in found.items() if figures}


def _doubts_of(signal: NDArray[np.float32]) -> Iterator[tuple[str, str]]:
    """What is odd about a `signal` (T,), m/s², with its figures, if any."""
    mean, rms = _level(signal)
    if (whole := math.hypot(mean, rms)) > LOUDEST_RMS:
        yield LOUD, f"{_g(whole)} RMS"
    if abs(mean) > LARGEST_OFFSET * rms:
        yield OFFSET, f"{_g(mean)} beside {_g(rms)} RMS"
    if (cut_off := _share_cut_off(signal)) > MOST_AT_LIMIT:
        yield CLIPPED, f"{cut_off:.2g} of its samples"
    if (stretch := _longest_stretch(signal)) > max(LONGEST_STRETCH * signal.size, FEWEST_STRETCHED):
        yield HELD, f"{stretch} of {signal.size} samples"
    if _only_rises(signal) or _only_rises(-signal):
        yield RISING, ""
    if period := _period(signal):
        yield AGAIN, f"after {period} samples"


def _share_cut_off(signal: NDArray[np.float32]) -> float:
    """Share of the samples of a `signal` (T,) that are at its largest or smallest value and follow another such sample;
    0 for a signal of few different values."""
    limits = (signal == signal.max(), signal == signal.min())
    count = sum(int(np.count_nonzero(at[1:] & at[:-1])) for at in limits)
    if count <= MOST_AT_LIMIT * signal.size or np.unique(signal).size < FEWEST_VALUES:
        return 0.0
    return count / signal.size


def _longest_stretch(signal: NDArray[np.float32]) -> int:
    """Most samples in a row of a `signal` (T,) that have one value; 0 for a signal of few different values."""
    held = np.flatnonzero(signal[1:] == signal[:-1])
    longest = 1 + longest_run(held) if held.size else 1
    return longest if longest <= FEWEST_STRETCHED or np.unique(signal).size >= FEWEST_VALUES else 0


def _period(signal: NDArray[np.float32]) -> int:
    """After how many samples the first ones of a `signal` (T,) come again exactly; 0 if they do not, or have few
    different values."""
    head = signal[:FEWEST_STRETCHED]
    if np.unique(head).size < FEWEST_VALUES:
        return 0
    places = np.arange(1, signal.size - head.size + 1)
    for place, value in enumerate(head):
        places = places[signal[places + place] == value]
        if not places.size:
            return 0
    return int(places[0])


def _only_rises(signal: NDArray[np.float32]) -> bool:
    """Whether no sample of a `signal` (T,) is below the one before, as float32 makes equal ones of times."""
    return bool((signal[1:] >= signal[:-1]).all())


def _level(signal: NDArray[np.float32]) -> tuple[float, float]:
    """Mean of a signal (T,) and its RMS around that, m/s²."""
    return float(signal.mean(dtype=np.float64)), float(signal.std(dtype=np.float64))


def _g(acceleration: float) -> str:
    return f"{acceleration / UNITS['g']:.3g} g"


def scale_doubts(source: Source) -> dict[str, str]:
    """Says so if the samples are shares of a full scale that nobody stated; empty if not."""
    if source.setting("scale") is not None or not (isinstance(source.arrays, WaveArrays) and source.arrays.shares):
        return {}
    return {FULL_SCALE.format(unit=source.setting("unit")): ""}


def speed_doubts(labels: Mapping[str, Any], turns: float, settings: Container[str]) -> dict[str, str]:
    """Says so, with the figure, if the shaft turns faster than machines do, or makes many `turns` at a stated speed
    that is probably one in Hz; empty if not.

    `labels` are those of the record, `settings` the names of those that the SPEC has. Of few turns `turns_doubt` tells.
    """
    rpm, stated = labels["speed_rpm"], _stated(labels)
    if rpm > FASTEST_LIKELY_RPM:
        hint = ", as if `speed_hz` were in rpm" if "speed_hz" in settings else ""
        return {f"with a shaft faster than {FASTEST_LIKELY_RPM:g} rpm{hint}": f"{rpm:g} rpm"}
    if 0.0 < rpm < SLOWEST_LIKELY_RPM and turns >= FEWEST_TURNS and stated in settings:
        return {f"with a shaft slower than {SLOWEST_LIKELY_RPM:g} rpm, as if `{stated}` were in Hz": f"{rpm:g} rpm"}
    return {}


def geometry_doubts(labels: Mapping[str, Any]) -> dict[str, str]:
    """Says so, with the figure, if the bearing of the record with these `labels` is smaller than bearings are, or by
    its orders alone has more balls; empty if not, or if nothing is known of it."""
    pitch_mm = 1e3 * labels.get("pitch_diameter", math.nan)
    outer, inner = (labels.get(name, math.nan) for name in ("bpfo", "bpfi"))
    # Of one order alone, NaN standing for the other, the fewest: balls are more than twice BPFO, and more than BPFI.
    told = [math.nan] if "balls" in labels else [outer + inner, 2.0 * outer, inner]
    balls = next((fewest for fewest in told if not math.isnan(fewest)), math.nan)
    if pitch_mm < SMALLEST_PITCH_MM:
        small = f"with a bearing of less than {SMALLEST_PITCH_MM:g} mm pitch diameter, as if in inches"
        return {small: f"{pitch_mm:.4g} mm"}
    if balls > MOST_LIKELY_BALLS:
        full = f"with a bearing of more than {MOST_LIKELY_BALLS:g} balls, as if `bpfo` and `bpfi` were in Hz"
        return {full: f"{balls:.4g} balls"}
    return {}


def defect_doubts(labels: Mapping[str, Any]) -> dict[str, str]:
    """Says so, with the figure, if the defect of the record with these `labels` is shorter than anybody measures; empty
    if not, if there is none, or if its size is unknown."""
    extent_mm = labels.get("extent_mm", math.nan)
    if not 0.0 < extent_mm < SHORTEST_LIKELY_MM:
        return {}
    short = f"with a defect shorter than {SHORTEST_LIKELY_MM:g} mm, as if `extent_mm` were in inches or m"
    return {short: f"{extent_mm:.4g} mm"}


def _stated(labels: Mapping[str, Any]) -> str:
    """The setting in rpm that gives the speed, if not another in Hz does; "" for a tach."""
    return {"nominal": "nominal_speed_rpm", "measured": "speed_rpm"}.get(labels["speed_basis"], "")


def standing_doubt(course: NDArray[np.float64] | None) -> dict[str, str]:
    """Says so if the speed recorded along with the vibration, `course` (N,), is 0 in places, and in how many; empty if
    not."""
    if course is None or course.all():
        return {}
    return {STANDING: f"{course.size - np.count_nonzero(course)} of {course.size} places"}


def turns_doubt(turns: float, labels: Mapping[str, Any], settings: Container[str]) -> str:
    """A sentence on how few `turns` the shaft makes in the shortest record; empty if they are enough.

    `labels` are those of that record, `settings` the names of those that the SPEC has.
    """
    if not turns < FEWEST_TURNS:
        return ""
    stated = _stated(labels)
    slow = stated in settings and labels["speed_rpm"] < SLOWEST_RPM
    hint = f": is {stated} in Hz?" if slow else ""
    return f"the shortest record, {labels['recording']}, holds {turns:.2g} turns of the shaft{hint}"
