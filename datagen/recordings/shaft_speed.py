"""The speed of the shaft in a recording: stated, measured along with the vibration, from a tach, or nominal.

If a tach or a speed channel shows that it changes, the angle that the shaft has turned is given too.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from datagen.counts import counted
from datagen.errors import BadInput
from datagen.recordings.pulse_times import pulse_times
from datagen.recordings.pulses import MOST_MENDED, mended
from datagen.recordings.settings import Tach
from datagen.recordings.source import WHOLE, Source, Span, span_of
from datagen.recordings.values import RANGES, in_range
from labels.schema import UNKNOWN
from physics.angular_speed import RPM, RPM_PER_HZ

RPM_PER_UNIT = {"speed_rpm": 1.0, "speed_hz": RPM_PER_HZ}
FEWEST_PULSES = 3
# What to look at where a channel, or a list of times, has fewer.
LEVEL = "tach.threshold sets the level at which they are counted, and an angle that only grows shows none"
TIMES_IN_S = "times are taken to be in s: tach.factor = 1e-3 for ms, 1e-6 for us"
# A shaft that stays this near (turns) to one that turns evenly is steady. If balls pass five times a turn, the fourth
# harmonic of that then strays by two periods at most, and its line is hardly wider.
STEADY_WITHIN = 0.1
# Share of the mean speed at which a shaft that stands still is taken to creep, since its stored angle must grow.
CREEP = 1e-6
# Share by which a tach's mean speed may be off the nominal one: more than the slip of a motor, less than a factor.
NOMINAL_WITHIN = 0.2
# Share of the pulses that are missing or double above which those of one gap are what is wrong with a tach.
REST_SHARE = 0.5
TURNING = (
    "a shaft that turns throughout: of the recording the part before or behind that alone (from_s, to_s), or in place "
    "of tach nominal_speed_rpm or the variable of a measured speed"
)


@dataclass(frozen=True)
class ShaftSpeed:
    """The speed in a piece of a recording: its mean (`rpm`, NaN if unknown) and its `basis`, as label `speed_basis`.

    `angle` (T,), rad, is what the shaft has turned since the start of the piece, None unless the speed is known to
    change; `mended` says how many pulses of the whole recording's tach were repaired.
    """

    rpm: float
    basis: str
    angle: NDArray[np.float64] | None
    mended: int = 0


def shaft_speeds(
    source: Source, rate: float, size: int, part: tuple[int, int], pieces: list[tuple[int, int]]
) -> Iterator[ShaftSpeed]:
    """The speed in each of the `pieces` of the `part` that is taken of a vibration of `size` samples at `rate`, Hz.

    The part and each piece are given by their first sample and the one after the last. The nominal speed, if stated,
    stands in for a tach that the file lacks or that shows no pulse; raises BadInput if a tach disagrees with it.
    """
    tach = source.setting("tach")
    times = None if tach is None else pulse_times(source, tach, rate, size)
    if times is None:
        return _stated_speeds(source, rate, size, pieces)
    start, stop = part[0] / rate, part[1] / rate
    times = times[(times >= start) & (times <= stop)]
    whole, wrong = mended(times, tach.pulses_per_rev)
    if wrong > MOST_MENDED * whole.size:
        raise _irregular(source, tach, times, whole.size, wrong)
    times = whole
    _require_nominal(source, tach, times, start, stop)
    return _tach_speeds(source, tach, times, wrong, rate, pieces)


def _irregular(source: Source, tach: Tach, times: NDArray[np.float64], whole: int, wrong: int) -> BadInput:
    """The error for pulses at the `times` (N,), s, of which so many (`wrong` of `whole`) are missing or double that
    they give no speed; usually they are missing where the shaft stands still."""
    intervals = np.diff(times)
    longest = int(np.argmax(intervals))
    lost = intervals[longest] / float(np.median(intervals)) - 1.0
    if lost > REST_SHARE * wrong:
        gap = f"none of its pulses is from {times[longest]:.4g} to {times[longest + 1]:.4g} s"
        problem, allowed = f"{gap}, where {lost:.0f} would be if the shaft did not stand there", TURNING
    else:
        problem = f"{wrong} of the {whole} pulses of its tach are missing or double"
        allowed = f"a signal with the same number of pulses in each turn, of which {MOST_MENDED:.0%} may be wrong"
    return source.refusal(problem, "tach.variable", tach.variable, allowed)


def _require_nominal(source: Source, tach: Tach, times: NDArray[np.float64], start: float, stop: float) -> None:
    """Raise BadInput if the mean speed over the pulses at the `times` (N,) from `start` to `stop`, s, is far from the
    nominal one, if that is known."""
    nominal = source.or_none("nominal_speed_rpm")
    if nominal is None:
        return
    mean = tach_speed(source, tach, times, start, stop)
    if abs(mean - nominal) > NOMINAL_WITHIN * nominal:
        raise source.refusal(
            f"its pulses give {mean:.6g} revolutions per minute, but nominal_speed_rpm = {nominal:g}",
            "tach.pulses_per_rev",
            tach.pulses_per_rev,
            f"a number of pulses per revolution that brings both within {NOMINAL_WITHIN:.0%}, or another nominal speed",
        )


def _tach_speeds(
    source: Source, tach: Tach, times: NDArray[np.float64], wrong: int, rate: float, pieces: list[tuple[int, int]]
) -> Iterator[ShaftSpeed]:
    for start, stop in pieces:
        rpm = tach_speed(source, tach, times, start / rate, stop / rate)
        angle = _unless_steady(shaft_angle(times, tach.pulses_per_rev, np.arange(start, stop) / rate))
        if angle is not None:  # of a changing speed, the mean between pulses is not that of the record
            rpm = float(angle[-1] / (angle.size - 1) * rate / RPM)
        yield ShaftSpeed(rpm, "tach", angle, wrong)


def _stated_speeds(source: Source, rate: float, size: int, pieces: list[tuple[int, int]]) -> Iterator[ShaftSpeed]:
    turned = _turned(source, size / rate)
    for start, stop in pieces:
        rpm, basis = _stated_speed(source, span_of(start, stop, size))
        angle = None
        if turned is not None:
            angle = _unless_steady(np.interp(np.arange(start, stop) / rate, *turned))
        yield ShaftSpeed(rpm, basis, angle)


def shaft_angle(
    times: NDArray[np.float64], pulses_per_rev: float, instants: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Angle (T,), rad, at the `instants` (T,), s, of a shaft that turns evenly between pulses at the `times` (N,), s.

    Before the first and after the last pulse it goes on at the mean speed of the turn nearest to them.
    """
    turns = np.arange(times.size) / pulses_per_rev
    near = min(max(1, round(pulses_per_rev)), times.size - 1)
    found = np.interp(instants, times, turns)
    early, late = instants < times[0], instants > times[-1]
    found[early] -= (times[0] - instants[early]) * (turns[near] / (times[near] - times[0]))
    found[late] += (instants[late] - times[-1]) * (turns[near] / (times[-1] - times[-1 - near]))
    return 2.0 * math.pi * found


def is_steady(angle: NDArray[np.float64]) -> bool:
    """Whether a shaft that turns by `angle` (T,), rad, stays near one that turns evenly."""
    evenly = np.linspace(angle[0], angle[-1], angle.size)
    return bool(np.abs(angle - evenly).max() <= 2.0 * math.pi * STEADY_WITHIN)


def _unless_steady(angle: NDArray[np.float64]) -> NDArray[np.float64] | None:
    return None if is_steady(angle) else angle - angle[0]


def _stated_speed(source: Source, span: Span) -> tuple[float, str]:
    """Mean speed (rpm) in a span and its basis."""
    nominal = source.number("nominal_speed_rpm", span)
    for name, factor in RPM_PER_UNIT.items():
        measured = source.number(name, span) if nominal is None else source.or_none(name, span)
        if measured is not None:
            return measured * factor, "measured"
    return (math.nan, UNKNOWN) if nominal is None else (nominal, "nominal")


def _turned(source: Source, duration: float) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Instants (N + 1,), s, and the angles (N + 1,), rad, turned by then, if a channel holds N speeds, each of an N-th
    of the `duration` (s)."""
    course = told_course(source)
    if course is None:
        return None
    course = np.maximum(course, CREEP * course.mean())
    angle = np.concatenate([[0.0], np.cumsum(course)]) * (duration / course.size * RPM)
    return np.linspace(0.0, duration, course.size + 1), angle


def told_course(source: Source, span: Span = WHOLE) -> NDArray[np.float64] | None:
    """The speeds (N,), rpm, that a channel holds along a span of the recording, 0 where the shaft stands still; None
    without such a channel."""
    courses = ((source.course(name, span), factor) for name, factor in RPM_PER_UNIT.items())
    return next((factor * course for course, factor in courses if course is not None), None)


def tach_speed(source: Source, tach: Tach, times: NDArray[np.float64], start: float, stop: float) -> float:
    """Mean speed, rpm, over the pulses at `times` (N,) from `start` to `stop`, s; raises BadInput if there are fewer
    than 3."""
    inside = times[(times >= start) & (times < stop)]
    if inside.size < FEWEST_PULSES:
        remark = TIMES_IN_S if tach.times else LEVEL
        raise source.refusal(
            f"{counted(inside.size, 'pulse')} from {start:g} to {stop:g} s",
            "tach.variable",
            tach.variable,
            f"at least {FEWEST_PULSES} pulses; {remark}",
        )
    speed = float((inside.size - 1) / (inside[-1] - inside[0]) / tach.pulses_per_rev * RPM_PER_HZ)
    if not in_range("speed_rpm", speed):
        raise source.refusal(
            f"its pulses give {speed:.4g} revolutions per minute",
            "tach.pulses_per_rev",
            tach.pulses_per_rev,
            f"pulses that give {RANGES['speed_rpm'].allowed()}",
        )
    return speed
