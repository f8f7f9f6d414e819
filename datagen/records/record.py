"""One record: a scenario simulated, given its background, described by labels and exact truth. Nothing is written."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.records.layers import Layers, background_layers, noise_along_y
from datagen.records.profile_grid import PROFILE_POINTS
from datagen.records.response_warnings import cut_off, lost_in_steps, response_warnings, unset_ratio
from datagen.records.stiffness_axis import interpolation_error, stiffness_axis, stiffness_divisor
from datagen.scenarios.allowed_error import allowed_error
from datagen.scenarios.scenario import Scenario
from datagen.scenarios.scenario_text import scenario_json
from labels.description import label_values
from labels.envelope import stored_envelope
from labels.noise import signal_to_noise
from labels.schema import LABELS, LAYERS
from labels.truth import PassTable, ball_passes
from labels.variables import SIGNALS
from physics.paths.profile import race_depths
from physics.request import Accurate, LeadIn
from physics.response.lead_in import from_start
from physics.rms import rms
from physics.sensor.chain import SensorChain, sensed
from physics.sensor.recorder import recorded
from physics.simulate import simulate
from physics.spall import Spall
from physics.statics.stiffness_series import stiffness_series
from physics.trace import Kept, Trace

Rounded = NDArray[np.float32]
RECORDING_LABELS = tuple(label.name for label in LABELS if label.source == "recording")
OPTIONAL_SIGNALS = tuple(signal.name for signal in SIGNALS if not signal.required(imported=False))


@dataclass(frozen=True)
class Record:
    """The arrays of one record, as they are stored (units and meanings: labels.variables).

    `acceleration` (T, 2), `envelope` (T,), `stiffness` (3, S) at `stiffness_time` (S,); `labels` has every label of
    labels.schema by name; the optional signals are None unless asked for: `acceleration_clean` and
    `acceleration_sensor` (T, 2), `background` (layers, T, 2), `cage_angle` (T,), `profile_depth` (rows, A) and
    `contact_force` (T, rows, balls).
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
    acceleration_sensor: Rounded | None = None
    background: Rounded | None = None
    cage_angle: NDArray[np.float64] | None = None
    profile_depth: Rounded | None = None
    contact_force: Rounded | None = None


def make_record(scenario: Scenario, stored: tuple[str, ...] = ()) -> Record:
    """The record of `scenario` with the optional signals named in `stored`.

    Raises BadInput if there is no such signal, before anything is simulated, and SimulationFailed.
    """
    for name in stored:
        if name not in OPTIONAL_SIGNALS:
            raise BadInput(field="stored", value=name, allowed=", ".join(OPTIONAL_SIGNALS))
    trace = _simulated(scenario, keep_force="contact_force" in stored)
    # The chain settles together with the machine.
    signal, trace = sensed(scenario.chain, trace)[-scenario.samples :], from_start(trace)
    layers = background_layers(scenario, signal)
    measured = sum(layers.values(), signal)
    acceleration, clipped = _recorded(scenario.chain, measured)
    stiffness_time = stiffness_axis(scenario)
    stiffness, solved_error = _stiffness(scenario, stiffness_time)
    labels = sensor_labels(scenario, signal, layers, clipped)
    recorder = scenario.chain.recorder
    of_recorder = [lost_in_steps(recorder, measured, acceleration), cut_off(recorder, clipped)]
    warnings = [*response_warnings(scenario, trace), unset_ratio(scenario, labels), *of_recorder]
    labels |= _labels(scenario, trace, math.hypot(solved_error, interpolation_error(scenario, stiffness)), warnings)
    optional = _optional_signals(scenario, trace, signal, layers)
    return Record(
        index=scenario.record,
        time=trace.time,
        stiffness_time=stiffness_time,
        acceleration=acceleration,
        envelope=stored_envelope(acceleration[:, 1], scenario.rate, scenario.envelope_band),
        stiffness=stiffness.astype(np.float32),
        passes=ball_passes(scenario.scene, trace.changes, scenario.duration),
        spalls=scenario.scene.spalls,
        labels={label.name: labels[label.name] for label in LABELS},
        scenario=scenario_json(scenario),
        **{name: optional[name]() for name in stored},
    )


def _simulated(scenario: Scenario, keep_force: bool) -> Trace:
    accuracy, least_error = allowed_error(scenario)
    return simulate(
        scenario.scene,
        scenario.rate,
        Accurate(accuracy, least_error=least_error),
        keep=Kept(force=keep_force, outer=scenario.chain.needs_outer_ring, fastest_path=scenario.chain.fastest),
        lead_in=LeadIn(scenario.settle, kept=True),
    )


def _optional_signals(
    scenario: Scenario, trace: Trace, signal: NDArray[np.float64], layers: Layers
) -> dict[str, Callable[[], NDArray[Any]]]:
    """What gives each optional signal, by name: only those that are stored are computed."""
    return {
        "acceleration_clean": lambda: trace.acceleration.astype(np.float32),
        "acceleration_sensor": lambda: signal.astype(np.float32),
        "background": lambda: _stacked(layers, signal.shape),
        "cage_angle": lambda: scenario.scene.cage.angle(trace.time),
        "profile_depth": lambda: race_depths(scenario.scene, PROFILE_POINTS).astype(np.float32),
        "contact_force": lambda: np.asarray(trace.contact_force, dtype=np.float32),
    }


def _stiffness(scenario: Scenario, time: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The stiffness (3, S) at its own equally spaced times (S,), and the share of kyy that interpolation misses."""
    step = stiffness_divisor(scenario) / scenario.rate
    series = stiffness_series(scenario.scene, step, time.size)
    return series.stiffness.T, series.error


def _recorded(chain: SensorChain, signal: NDArray[np.float64]) -> tuple[Rounded, float]:
    """What the recorder keeps of `signal` (T, 2), m/s², and the share of samples beyond its range."""
    kept, clipped = (signal, 0.0) if chain.recorder is None else recorded(chain.recorder, signal)
    return kept.astype(np.float32), clipped


def _stacked(layers: Layers, shape: tuple[int, ...]) -> Rounded:
    """All layers (L, T, 2) in the order of the schema, zeros where one is absent."""
    absent = np.zeros(shape)
    return np.stack([layers.get(name, absent) for name in LAYERS]).astype(np.float32)


def _labels(scenario: Scenario, trace: Trace, stiffness_error: float, warnings: list[str]) -> dict[str, Any]:
    """Labels of scene, run and place in the corpus; `validity` tells the `warnings` after those of the scene."""
    values = label_values(scenario.scene)
    return values | {
        "validity": "; ".join(filter(None, [str(values["validity"]), *warnings])),
        "record": scenario.record,
        "part": scenario.part,
        **dict.fromkeys(RECORDING_LABELS, ""),
        "speed_basis": "set",
        "split": scenario.split,
        "bearing_id": scenario.bearing_id,
        "rate_hz": scenario.rate,
        "duration_s": scenario.duration,
        "envelope_band": scenario.envelope_band,
        "model": trace.model,
        "method": trace.method,
        "step": trace.step,
        "error_estimate": trace.error_estimate,
        "tension_share": trace.tension_share,
        "stiffness_error": stiffness_error,
    }


def sensor_labels(scenario: Scenario, signal: NDArray[np.float64], layers: Layers, clipped: float) -> dict[str, Any]:
    """Labels of chain and background of a record with this sensor `signal` (T, 2) and these layers, m/s²."""
    chain = scenario.chain
    along, noise = np.ascontiguousarray(signal[:, 1]), noise_along_y(layers, len(signal))
    ratios = [signal_to_noise(along, noise, scenario.rate, band) for band in (None, scenario.noise_band)]
    levels = {name: rms(layer[:, 1]) for name, layer in layers.items()}
    return {
        "snr_db": ratios[0],
        "snr_band_db": ratios[1],
        "snr_band": scenario.noise_band,
        "background_layers": ", ".join(layers),
        "background_rms": tuple(levels.get(name, 0.0) for name in LAYERS),
        "sensor_modes": len(chain.modes),
        "mounting_cutoff_hz": math.nan if chain.mounting is None else chain.mounting.cutoff,
        "recorder_step": math.nan if chain.recorder is None else chain.recorder.step,
        "clipped_share": clipped,
    }
