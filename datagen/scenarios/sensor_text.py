"""Measurement chain and background in the JSON text of a scenario, each with the rule that makes it."""

from __future__ import annotations

import base64
import zlib
from typing import Any

from datagen.scenarios.background import Background, NoiseTarget, Stretch
from datagen.scenarios.optional import if_given
from datagen.scenarios.scenario import Scenario
from physics.backgrounds.gear_mesh import GearMesh
from physics.backgrounds.impulses import Impulses, Resonance
from physics.backgrounds.mains_hum import MainsHum
from physics.backgrounds.pink import PinkNoise
from physics.backgrounds.shaft_harmonics import ShaftHarmonics
from physics.sensor.chain import SensorChain
from physics.sensor.mode import SensorMode
from physics.sensor.mounting import Mounting
from physics.sensor.recorder import Recorder

Data = dict[str, Any]
CHAIN_RULES = {
    "sum": "the sensor signal is resonator_gain times the resonator's acceleration plus every mode's, both lowered to "
    "rate_hz as sampling says, after the mounting",
    "modes": "on each axis z'' + 2 damping w z' + w^2 z = -a, a being the outer ring's acceleration, w = 2 pi "
    "frequency_hz, at rest where the simulated instants begin (t = 0, or -settle_s if sampling has it); the mode adds "
    "-gain (2 damping w z' + w^2 z)",
    "mounting": "a causal digital Butterworth low-pass at rate_hz: bilinear transform, exact at cutoff_hz, at rest "
    "where the simulated instants begin, as the modes are, so that what came before t = 0 has run through it too",
    "recorder": "step = 2 range_m_s2 / 2^bits; the record is step * clip(round(x / step), -2^(bits-1), 2^(bits-1) - 1) "
    "with halves to even, x being sensor signal plus background",
}
TONES = (
    "cos(2 pi f t + phase) for each line; phase = 2 pi * generator.random((lines, 2)), one a line and axis; lines with "
    "|f| >= rate_hz / 2 are left out"
)
LAYER_RULES = {
    "white": "rms_m_s2 * generator.standard_normal((samples, 2)), stream white_noise",
    "pink": "irfft(sqrt(S(f) rate_hz / 2) * rfft(generator.standard_normal((samples, 2)))) with S(f) proportional to "
    "f^-slope from lowest_hz to rate_hz / 2, zero below, its integral rms_m_s2^2; stream pink_noise",
    "shaft_harmonics": f"amplitudes_m_s2 times {TONES}; f = k omega_s / (2 pi), k from first_order; stream "
    "shaft_harmonics",
    "gear_mesh": f"amplitudes_m_s2[h - 1] times {TONES}; f = h teeth omega_s / (2 pi); then psi and psi' drawn like "
    "phase, one row for each sideband k; each harmonic is multiplied by 1 + sum over k of modulation^k "
    "cos(k omega_s t + psi_k) + other_modulation^k cos(k omega_s t teeth / other_teeth + psi'_k); stream gear_mesh",
    "mains_hum": f"amplitudes_m_s2 times {TONES}; f = k frequency_hz, k from 1; stream mains_hum",
    "impulses": "n = poisson(per_second * samples / rate_hz), start = duration * random(n), height = amplitude_m_s2 * "
    "exp(spread * standard_normal(n)), direction = 2 pi random(n), share = random((n, resonances)) over its row sums, "
    "in this order; each adds height * share * (cos, sin)(direction) * exp(-2 pi damping f s) sin(2 pi f s), s >= 0 "
    "being the time since its start and f = frequency_hz; stream impulses",
    "recording": "gain_m_s2 times content: base64 of zlib of little-endian float32, shape (samples, 2)",
}
SUM_RULE = (
    "the record before the recorder is the sensor signal plus all layers; with a noise_target all layers are "
    "multiplied by the one factor that makes the y axis's power ratio, each part without its mean, ratio_db over 0 to "
    "rate_hz / 2 (whole) or over snr_band_hz, edges included (null: the envelope_band_hz of sampling)"
)


def chain_data(chain: SensorChain) -> Data:
    """The measurement chain as plain data."""
    mounting, recorder = chain.mounting, chain.recorder
    modes = [{"frequency_hz": mode.frequency, "damping": mode.damping, "gain": mode.gain} for mode in chain.modes]
    return {
        "resonator_gain": chain.resonator_gain,
        "modes": modes,
        "mounting": if_given(mounting, lambda given: {"cutoff_hz": given.cutoff, "order": given.order}),
        "recorder": if_given(recorder, lambda given: {"range_m_s2": given.full_scale, "bits": given.bits}),
        "rules": CHAIN_RULES,
    }


def chain_of(data: Data) -> SensorChain:
    """The measurement chain of `chain_data`."""
    mounting, recorder = data["mounting"], data["recorder"]
    return SensorChain(
        modes=tuple(SensorMode(mode["frequency_hz"], mode["damping"], mode["gain"]) for mode in data["modes"]),
        resonator_gain=data["resonator_gain"],
        mounting=if_given(mounting, lambda given: Mounting(given["cutoff_hz"], given["order"])),
        recorder=if_given(recorder, lambda given: Recorder(given["range_m_s2"], given["bits"])),
    )


def background_data(scenario: Scenario) -> Data:
    """The background as plain data: the layers that are there, each with its rule."""
    layers = _layers(scenario.background, scenario.stretch)
    target = scenario.noise_target
    return {
        "layers": {name: values | {"rule": LAYER_RULES[name]} for name, values in layers.items()},
        "noise_target": if_given(target, vars),
        "snr_band_hz": if_given(scenario.snr_band, list),
        "rule": SUM_RULE,
    }


def background_of(data: Data) -> Data:
    """The fields of a Scenario that hold the background of `background_data`."""
    return {
        "background": _background(data["layers"]),
        "stretch": if_given(data["layers"].get("recording"), _stretch),
        "noise_target": if_given(data["noise_target"], lambda target: NoiseTarget(**target)),
        "snr_band": if_given(data["snr_band_hz"], lambda band: (band[0], band[1])),
    }


def _layers(background: Background, stretch: Stretch | None) -> dict[str, Data]:
    found: dict[str, Data | None] = {
        "white": {"rms_m_s2": background.white_rms} if background.white_rms else None,
        "pink": if_given(background.pink, _pink),
        "shaft_harmonics": if_given(background.shaft_harmonics, _shaft),
        "gear_mesh": if_given(background.gear_mesh, _gears),
        "mains_hum": if_given(background.mains_hum, _hum),
        "impulses": if_given(background.impulses, _impulses),
        "recording": if_given(stretch, lambda taken: _recording(taken, background.recording_gain)),
    }
    return {name: values for name, values in found.items() if values is not None}


def _pink(noise: PinkNoise) -> Data:
    return {"rms_m_s2": noise.rms, "lowest_hz": noise.lowest, "slope": noise.slope}


def _shaft(layer: ShaftHarmonics) -> Data:
    return {"amplitudes_m_s2": list(layer.amplitudes), "first_order": layer.first_order}


def _gears(layer: GearMesh) -> Data:
    return {
        "teeth": layer.teeth,
        "amplitudes_m_s2": list(layer.amplitudes),
        "other_teeth": layer.other_teeth,
        "modulation": layer.modulation,
        "other_modulation": layer.other_modulation,
        "sidebands": layer.sidebands,
    }


def _hum(layer: MainsHum) -> Data:
    return {"frequency_hz": layer.frequency, "amplitudes_m_s2": list(layer.amplitudes)}


def _impulses(layer: Impulses) -> Data:
    resonances = [{"frequency_hz": resonance.frequency, "damping": resonance.damping} for resonance in layer.resonances]
    return {
        "per_second": layer.per_second,
        "amplitude_m_s2": layer.amplitude,
        "spread": layer.spread,
        "resonances": resonances,
    }


def _recording(stretch: Stretch, gain: float) -> Data:
    named = {key: value for key, value in vars(stretch).items() if key != "content"}
    content = base64.b64encode(zlib.compress(stretch.content, 1)).decode("ascii")
    return named | {"starts": list(stretch.starts), "gain_m_s2": gain, "content": content}


def _background(layers: dict[str, Data]) -> Background:
    return Background(
        white_rms=layers["white"]["rms_m_s2"] if "white" in layers else 0.0,
        pink=if_given(layers.get("pink"), _pink_of),
        shaft_harmonics=if_given(layers.get("shaft_harmonics"), _shaft_of),
        gear_mesh=if_given(layers.get("gear_mesh"), _gears_of),
        mains_hum=if_given(layers.get("mains_hum"), _hum_of),
        impulses=if_given(layers.get("impulses"), _impulses_of),
        recording_gain=layers["recording"]["gain_m_s2"] if "recording" in layers else 0.0,
    )


def _pink_of(data: Data) -> PinkNoise:
    return PinkNoise(data["rms_m_s2"], data["lowest_hz"], data["slope"])


def _shaft_of(data: Data) -> ShaftHarmonics:
    return ShaftHarmonics(tuple(data["amplitudes_m_s2"]), data["first_order"])


def _hum_of(data: Data) -> MainsHum:
    return MainsHum(data["frequency_hz"], tuple(data["amplitudes_m_s2"]))


def _gears_of(data: Data) -> GearMesh:
    numbers = ("teeth", "other_teeth", "modulation", "other_modulation", "sidebands")
    return GearMesh(amplitudes=tuple(data["amplitudes_m_s2"]), **{name: data[name] for name in numbers})


def _impulses_of(data: Data) -> Impulses:
    resonances = tuple(Resonance(resonance["frequency_hz"], resonance["damping"]) for resonance in data["resonances"])
    return Impulses(data["per_second"], data["amplitude_m_s2"], data["spread"], resonances)


def _stretch(data: Data) -> Stretch:
    content = zlib.decompress(base64.b64decode(data["content"]))
    return Stretch(data["file"], data["sha256"], (data["starts"][0], data["starts"][1]), content)
