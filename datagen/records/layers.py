"""One record's background, layer by layer, each from its own stream."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from datagen.scenarios.optional import if_given
from datagen.scenarios.scenario import Scenario
from labels.noise import signal_to_noise
from physics.arrays import Array
from physics.backgrounds.gear_mesh import gear_mesh
from physics.backgrounds.impulses import impulses
from physics.backgrounds.mains_hum import mains_hum
from physics.backgrounds.pink import pink_noise
from physics.backgrounds.shaft_harmonics import shaft_harmonics
from physics.backgrounds.white import white_noise

Layers = dict[str, Array]


def background_layers(scenario: Scenario, signal: Array) -> Layers:
    """The layers (T, 2) that the record has, m/s², by name; scaled alike if a signal-to-noise ratio is asked for.

    `signal` (T, 2), m/s², is what the sensor gives without them. A layer that leaves nothing in this record is absent,
    such as tones that all lie above half its rate, or knocks of which none fell into it.
    """
    found = {name: draw(scenario) for name, draw in LAYER_OF.items()}
    layers = {name: layer for name, layer in found.items() if layer is not None and layer.any()}
    factor = _scale(scenario, signal, layers)
    return layers if factor == 1.0 else {name: factor * layer for name, layer in layers.items()}


def noise_along_y(layers: Layers, samples: int) -> Array:
    """The sum of all layers along y (T,), m/s²; zeros without any."""
    return sum((layer[:, 1] for layer in layers.values()), np.zeros(samples))


def _scale(scenario: Scenario, signal: Array, layers: Layers) -> float:
    target = scenario.noise_target
    # Without a signal to compare with, the noise keeps the machine's own level.
    if target is None or not layers:
        return 1.0
    band = None if target.whole else scenario.noise_band
    ratio = signal_to_noise(signal[:, 1], noise_along_y(layers, len(signal)), scenario.rate, band)
    return 1.0 if np.isnan(ratio) else float(10.0 ** ((ratio - target.ratio_db) / 20.0))


def _white(scenario: Scenario) -> Array | None:
    rms = scenario.background.white_rms
    return white_noise(scenario.generator("white_noise"), rms, scenario.samples) if rms > 0.0 else None


def _pink(scenario: Scenario) -> Array | None:
    samples, rate, stream = scenario.samples, scenario.rate, scenario.generator
    return if_given(scenario.background.pink, lambda noise: pink_noise(stream("pink_noise"), noise, samples, rate))


def _shaft_harmonics(scenario: Scenario) -> Array | None:
    samples, rate, stream = scenario.samples, scenario.rate, scenario.generator
    speed, layer = scenario.scene.operation.shaft_speed, scenario.background.shaft_harmonics
    return if_given(layer, lambda tones: shaft_harmonics(stream("shaft_harmonics"), tones, speed, samples, rate))


def _gear_mesh(scenario: Scenario) -> Array | None:
    samples, rate, stream = scenario.samples, scenario.rate, scenario.generator
    speed, layer = scenario.scene.operation.shaft_speed, scenario.background.gear_mesh
    return if_given(layer, lambda gears: gear_mesh(stream("gear_mesh"), gears, speed, samples, rate))


def _mains_hum(scenario: Scenario) -> Array | None:
    samples, rate, stream = scenario.samples, scenario.rate, scenario.generator
    return if_given(scenario.background.mains_hum, lambda hum: mains_hum(stream("mains_hum"), hum, samples, rate))


def _impulses(scenario: Scenario) -> Array | None:
    samples, rate, stream = scenario.samples, scenario.rate, scenario.generator
    return if_given(scenario.background.impulses, lambda knocks: impulses(stream("impulses"), knocks, samples, rate))


def _recording(scenario: Scenario) -> Array | None:
    gain = scenario.background.recording_gain
    return if_given(scenario.stretch, lambda stretch: gain * stretch.samples)


# In the order of labels.schema's LAYERS.
LAYER_OF: dict[str, Callable[[Scenario], Array | None]] = {
    "white": _white,
    "pink": _pink,
    "shaft_harmonics": _shaft_harmonics,
    "gear_mesh": _gear_mesh,
    "mains_hum": _mains_hum,
    "impulses": _impulses,
    "recording": _recording,
}
