"""One record: a scenario simulated, given its background, described by labels and exact truth. Nothing is written."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.corpora.format import profile_grid
from datagen.records.stiffness_axis import interpolation_error, stiffness_axis
from datagen.scenarios.scenario import Scenario
from labels.description import label_values
from labels.envelope import band_envelope
from labels.schema import LABELS
from labels.truth import PassTable, ball_passes
from physics.profile import race_depth
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall
from physics.stiffness import stiffness_trace
from physics.trace import Trace

Rounded = NDArray[np.float32]
# Read by linear interpolation this moves the acceleration of every reference scene by less than 1e-3 (measured: 1.7e-3
# with 65 536 points and 5e-4 with 131 072 on the outer race, 2.1e-3 with 131 072 on the inner one, 6e-4 with these).
PROFILE_POINTS = 262_144


@dataclass(frozen=True)
class Record:
    """The arrays of one record, as they are stored (units and meanings: labels.variables).

    `acceleration` (T, 2), `envelope` (T,), `stiffness` (3, S) at `stiffness_time` (S,); `labels` has every label of
    labels.schema by name; the optional signals are None unless asked for: `acceleration_clean` (T, 2), `cage_angle`
    (T,), `profile_depth` (rows, A) and `contact_force` (T, rows, balls).
    """

    index: int
    time: NDArray[np.float64]
    stiffness_time: NDArray[np.float64]
    acceleration: Rounded
    envelope: Rounded
    stiffness: Rounded
    passes: PassTable
    spalls: tuple[Spall, ...]
    labels: dict[str, Any]
    scenario: str
    acceleration_clean: Rounded | None = None
    cage_angle: NDArray[np.float64] | None = None
    profile_depth: Rounded | None = None
    contact_force: Rounded | None = None


def make_record(scenario: Scenario, stored: tuple[str, ...] = ()) -> Record:
    """The record of `scenario` with the optional signals named in `stored`; raises SimulationFailed."""
    scene, rate = scenario.scene, scenario.rate
    trace = simulate(scene, rate, keep_force="contact_force" in stored)
    noise = background_noise(scenario, trace.acceleration[:, 1])
    acceleration = (trace.acceleration + noise).astype(np.float32)
    stiffness_time = stiffness_axis(scenario)
    stiffness = stiffness_trace(scene, stiffness_time).T
    optional: dict[str, Callable[[], NDArray[Any]]] = {
        "acceleration_clean": lambda: trace.acceleration.astype(np.float32),
        "cage_angle": lambda: scene.cage.angle(trace.time),
        "profile_depth": lambda: _profile_depth(scene),
        "contact_force": lambda: np.asarray(trace.contact_force, dtype=np.float32),
    }
    return Record(
        index=scenario.record,
        time=trace.time,
        stiffness_time=stiffness_time,
        acceleration=acceleration,
        envelope=band_envelope(acceleration[:, 1].astype(np.float64), rate, scenario.envelope_band).astype(np.float32),
        stiffness=stiffness.astype(np.float32),
        passes=ball_passes(scene, trace.changes, scenario.duration),
        spalls=scene.spalls,
        labels=_labels(scenario, trace, noise, interpolation_error(scenario, stiffness)),
        scenario=scenario.to_json(),
        **{name: optional[name]() for name in stored},
    )


def background_noise(scenario: Scenario, signal: NDArray[np.float64]) -> NDArray[np.float64]:
    """The record's own draw of white noise (T, 2), m/s²: its machine's, or relative to its clean `signal` (T,)."""
    shape, floor = (scenario.samples, 2), scenario.background
    drawn = scenario.generator("white_noise").standard_normal(shape)
    if floor.white_snr_db is None:
        return floor.white_rms * drawn
    return float(signal.std() / drawn[:, 1].std()) * 10.0 ** (-floor.white_snr_db / 20.0) * drawn


def signal_to_noise(signal: NDArray[np.float64], noise: NDArray[np.float64]) -> float:
    """Power of `signal` (T,) over that of `noise` (T,), each without its mean, in dB; NaN if there is no noise."""
    if not noise.any():
        return math.nan
    tiny = np.finfo(np.float64).tiny
    return 10.0 * math.log10(max(float(signal.var()), tiny) / float(noise.var()))


def _profile_depth(scene: Scene) -> Rounded:
    grid = profile_grid(PROFILE_POINTS)
    return np.stack([race_depth(scene, row + 1, grid) for row in range(scene.rig.bearing.rows)]).astype(np.float32)


def _labels(scenario: Scenario, trace: Trace, noise: NDArray[np.float64], stiffness_error: float) -> dict[str, Any]:
    """Every label of the record, in the order of the schema."""
    known: dict[str, Any] = label_values(scenario.scene) | {
        "record": scenario.record,
        "part": scenario.part,
        "split": scenario.split,
        "bearing_id": scenario.bearing_id,
        "rate_hz": scenario.rate,
        "duration_s": scenario.duration,
        "snr_db": signal_to_noise(trace.acceleration[:, 1], noise[:, 1]),
        "envelope_band": scenario.envelope_band,
        "model": trace.model,
        "method": trace.method,
        "step": trace.step,
        "error_estimate": trace.error_estimate,
        "tension_share": trace.tension_share,
        "stiffness_error": stiffness_error,
    }
    return {label.name: known[label.name] for label in LABELS}
