"""How far a response is from the reference: in acceleration, and in what people use."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from datagen.charts.response import Response
from labels.envelope import band_envelope, default_band, squared_envelope_spectrum
from labels.spectrum import line_amplitude
from labels.truth import PassTable, ball_passes
from physics.angular_speed import in_hertz
from physics.arrays import Array
from physics.rms import relative_error
from physics.scene import Scene
from physics.statics.stiffness import stiffness_at
from physics.trace import ContactChanges

SCORED_FROM = 0.1
FEWEST_PASSES = 3.0


@dataclass(frozen=True)
class ResponseErrors:
    """Errors against the reference from 0.1 s on; NaN where something does not apply or is not given.

    `acceleration` RMS error over RMS; `envelope_db` of the defect's line in the squared envelope spectrum, whose lines
    count as powers here (10 lg of their ratio; the chapters of datagen/paper take them as amplitudes); `release_us` and
    `regain_us`, the median error of these times, `worst_event_us` the largest, `events_missed` how many of the
    reference's have no counterpart; `stiffness` RMS error of kyy over its RMS. Entry and exit times follow from the
    cage's path and have no error.
    """

    acceleration: float
    envelope_db: float
    release_us: float
    regain_us: float
    worst_event_us: float
    events_missed: int
    stiffness: float


def response_errors(scene: Scene, rate: float, response: Response, reference: Response) -> ResponseErrors:
    """Errors of `response`, which may be shorter than the `reference`."""
    samples = response.acceleration.shape[0]
    scored = slice(round(SCORED_FROM * rate), samples)
    exact = reference.acceleration[scored]
    acceleration = _error(response.acceleration[scored], exact)
    release, regain, missed = _event_errors(scene, response.changes, reference.changes, samples / rate)
    events = np.concatenate([release, regain])
    return ResponseErrors(
        acceleration=acceleration,
        envelope_db=_envelope_error(scene, rate, response.acceleration[scored], exact),
        release_us=_median(release),
        regain_us=_median(regain),
        worst_event_us=float(events.max()) if events.size else math.nan,
        events_missed=missed,
        stiffness=_stiffness_error(scene, rate, response, reference, scored),
    )


def _error(found: Array, exact: Array) -> float:
    """Relative RMS error: infinite where `found` is not finite, NaN beside silence."""
    if not np.all(np.isfinite(found)):
        return math.inf
    return relative_error(found, exact) if exact.any() else math.nan


def _envelope_error(scene: Scene, rate: float, found: Array, exact: Array) -> float:
    """Level of the defect's line over the reference's, dB; NaN for a healthy scene or too short a record."""
    race = scene.defective_race
    bearing = scene.rig.bearing
    line = in_hertz((bearing.bpfi if race == "inner" else bearing.bpfo) * scene.operation.shaft_speed)
    duration = exact.shape[0] / rate
    if race == "none" or duration * line < FEWEST_PASSES or not np.all(np.isfinite(found)):
        return math.nan
    band = default_band(scene.rig, rate)
    levels = []
    for signal in (found[:, 1], exact[:, 1]):
        spectrum = squared_envelope_spectrum(band_envelope(signal, rate, band), rate)
        levels.append(line_amplitude(*spectrum, line, 1.5 / duration))
    return 10.0 * math.log10(levels[0] / levels[1]) if min(levels) > 0.0 else math.nan


def _event_errors(
    scene: Scene, found: ContactChanges | None, exact: ContactChanges | None, duration: float
) -> tuple[Array, Array, int]:
    """Errors (µs) of release and regain in the passes that both give, and how many the response lacks."""
    expected = ball_passes(scene, exact, duration)
    kept = (expected.entry_time > SCORED_FROM) & (expected.exit_time < duration)
    if found is None:
        return np.zeros(0), np.zeros(0), 0
    given = ball_passes(scene, found, duration)
    errors = [1e6 * np.abs(column(given) - column(expected))[kept] for column in (_release, _regain)]
    wanted = [np.isfinite(column(expected))[kept] for column in (_release, _regain)]
    missed = sum(int(np.sum(want & ~np.isfinite(error))) for want, error in zip(wanted, errors, strict=True))
    return errors[0][np.isfinite(errors[0])], errors[1][np.isfinite(errors[1])], missed


def _release(table: PassTable) -> Array:
    return table.release_time


def _regain(table: PassTable) -> Array:
    return table.regain_time


def _median(values: Array) -> float:
    return float(np.median(values)) if values.size else math.nan


def _stiffness_error(scene: Scene, rate: float, response: Response, reference: Response, scored: slice) -> float:
    if response.displacement is None or reference.displacement is None:
        return math.nan
    time = np.arange(response.displacement.shape[0])[scored] / rate
    found = stiffness_at(scene, time, response.displacement[scored])[:, 1]
    return _error(found, stiffness_at(scene, time, reference.displacement[scored])[:, 1])
