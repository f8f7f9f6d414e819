"""Add measurement chain and background to a replayed record, from its scenario text alone, with numpy and scipy only.

Nothing of the generating packages is imported: this is an independent reading of the rules under `chain` and
`background`. Resonances are solved as masses that the moving outer ring carries, not as filters of its acceleration.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray
from replay import lowered, march, recorded
from scipy.signal import butter, lfilter, lsim

Array = NDArray[np.float64]
Data = dict[str, Any]

FINER = 4


def sensor_signal(scenario: Data, substeps: int = 16) -> Array:
    """What the sensor gives (T, 2) before background and recorder, m/s²; the modes are solved on finer instants yet."""
    chain, rate, factor = scenario["chain"], scenario["sampling"]["rate_hz"], scenario["sampling"]["oversampling"]
    run = march(scenario, FINER * factor, max(1, substeps // (FINER * factor)))
    place, speed = run["state"][:, 2:4], run["state"][:, 8:10]
    total = chain["resonator_gain"] * run["acceleration"]
    for mode in chain["modes"]:
        total += mode["gain"] * carried_mass(mode, run["time"] - run["time"][0], place, speed)
    total = lowered(total[::FINER], scenario)
    mounting = chain["mounting"]
    if mounting:
        numerator, denominator = butter(mounting["order"], mounting["cutoff_hz"] / (rate / 2.0))
        total = lfilter(numerator, denominator, total, axis=0)
    return recorded(np.asarray(total), scenario)


def carried_mass(mode: Data, time: Array, place: Array, speed: Array) -> Array:
    """Acceleration (T, 2) of a mass on a spring and damper whose foot moves with `place` (m) and `speed` (m/s)."""
    omega = 2.0 * np.pi * mode["frequency_hz"]
    pull, drag = omega**2, 2.0 * mode["damping"] * omega
    system = ([[0.0, 1.0], [-pull, -drag]], [[0.0, 0.0], [pull, drag]], [[-pull, -drag]], [[pull, drag]])
    moved = place - place[0]
    return np.stack([lsim(system, np.column_stack([moved[:, k], speed[:, k]]), time)[1] for k in range(2)], axis=1)


def layers(scenario: Data) -> dict[str, Array]:
    """Every layer of the background (T, 2), m/s², before any noise_target."""
    stated = scenario["background"]["layers"]
    return {name: MAKERS[name](scenario, values) for name, values in stated.items()}


def recorder(scenario: Data, given: Array) -> Array:
    """What the recorder keeps of sensor signal plus background."""
    settings = scenario["chain"]["recorder"]
    if settings is None:
        return given
    step, top = 2.0 * settings["range_m_s2"] / 2.0 ** settings["bits"], 2.0 ** (settings["bits"] - 1)
    return np.asarray(step * np.clip(np.rint(given / step), -top, top - 1.0))


def scaled(scenario: Data, sensor: Array, found: dict[str, Array]) -> dict[str, Array]:
    """The layers after the noise_target, if there is one."""
    target, rate = scenario["background"]["noise_target"], scenario["sampling"]["rate_hz"]
    if target is None:
        return found
    band = scenario["background"]["snr_band_hz"] or scenario["sampling"]["envelope_band_hz"]
    low, high = (0.0, rate / 2.0) if target["whole"] else band

    def power(signal: Array) -> float:
        lines = np.fft.fft(signal - signal.mean())
        frequency = np.abs(np.fft.fftfreq(signal.size, 1.0 / rate))
        return float((np.abs(lines[(frequency >= low) & (frequency <= high)]) ** 2).sum())

    ratio = power(sensor[:, 1]) / power(np.sum(list(found.values()), axis=0)[:, 1])
    factor = np.sqrt(ratio / 10.0 ** (target["ratio_db"] / 10.0))
    return {name: factor * layer for name, layer in found.items()}


def stream(scenario: Data, purpose: str) -> np.random.Generator:
    """The record's stream of one purpose."""
    seeds = scenario["seeds"]
    key = (
        seeds["scopes"].index("record"),
        seeds["record"],
        seeds["purposes"].index(purpose),
        seeds["record_attempt"],
        0,
    )
    return np.random.default_rng(np.random.SeedSequence(seeds["recipe"], spawn_key=key))


def instants(scenario: Data) -> Array:
    """Times of the samples (T, 1), s."""
    return np.arange(scenario["sampling"]["samples"])[:, None] / scenario["sampling"]["rate_hz"]


def white(scenario: Data, values: Data) -> Array:
    size = (scenario["sampling"]["samples"], 2)
    return np.asarray(values["rms_m_s2"] * stream(scenario, "white_noise").standard_normal(size))


def pink(scenario: Data, values: Data) -> Array:
    samples, rate = scenario["sampling"]["samples"], scenario["sampling"]["rate_hz"]
    low, high, slope = values["lowest_hz"], rate / 2.0, values["slope"]
    fine = np.geomspace(low, high, 100_001)
    area = np.trapezoid(fine**-slope, fine)
    frequency = np.arange(samples // 2 + 1) * rate / samples
    density = np.zeros(frequency.size)
    density[frequency >= low] = values["rms_m_s2"] ** 2 / area * frequency[frequency >= low] ** -slope
    lines = np.fft.rfft(stream(scenario, "pink_noise").standard_normal((samples, 2)), axis=0)
    return np.asarray(np.fft.irfft(lines * np.sqrt(density * rate / 2.0)[:, None], samples, axis=0))


def shaft_harmonics(scenario: Data, values: Data) -> Array:
    turn = scenario["parameters"]["omega_s"] * instants(scenario)
    amplitudes = values["amplitudes_m_s2"]
    phase = 2.0 * np.pi * stream(scenario, "shaft_harmonics").random((len(amplitudes), 2))
    lines = enumerate(zip(amplitudes, phase, strict=True), start=values["first_order"])
    return np.sum([a * np.cos(k * turn + p) for k, (a, p) in lines], axis=0)


def gear_mesh(scenario: Data, values: Data) -> Array:
    turn, generator = scenario["parameters"]["omega_s"] * instants(scenario), stream(scenario, "gear_mesh")
    phase = 2.0 * np.pi * generator.random((len(values["amplitudes_m_s2"]), 2))
    own, other = (2.0 * np.pi * generator.random((values["sidebands"], 2)) for _ in range(2))
    modulation = 1.0
    for k in range(1, values["sidebands"] + 1):
        modulation = modulation + values["modulation"] ** k * np.cos(k * turn + own[k - 1])
        ratio = values["teeth"] / values["other_teeth"]
        modulation = modulation + values["other_modulation"] ** k * np.cos(k * ratio * turn + other[k - 1])
    carrier = sum(
        a * np.cos(h * values["teeth"] * turn + p)
        for h, (a, p) in enumerate(zip(values["amplitudes_m_s2"], phase, strict=True), start=1)
    )
    return np.asarray(modulation * carrier)


def mains_hum(scenario: Data, values: Data) -> Array:
    turn, amplitudes = 2.0 * np.pi * values["frequency_hz"] * instants(scenario), values["amplitudes_m_s2"]
    phase = 2.0 * np.pi * stream(scenario, "mains_hum").random((len(amplitudes), 2))
    lines = enumerate(zip(amplitudes, phase, strict=True), start=1)
    return np.sum([a * np.cos(k * turn + p) for k, (a, p) in lines], axis=0)


def impulses(scenario: Data, values: Data) -> Array:
    time, generator = instants(scenario)[:, 0], stream(scenario, "impulses")
    duration = time.size / scenario["sampling"]["rate_hz"]
    count = generator.poisson(values["per_second"] * duration)
    start = duration * generator.random(count)
    height = values["amplitude_m_s2"] * np.exp(values["spread"] * generator.standard_normal(count))
    direction = 2.0 * np.pi * generator.random(count)
    share = generator.random((count, len(values["resonances"])))
    total = np.zeros((time.size, 2))
    for k in range(count):
        since = time[time >= start[k]] - start[k]
        for one, part in zip(values["resonances"], share[k] / share[k].sum(), strict=True):
            turn = 2.0 * np.pi * one["frequency_hz"] * since
            ring = height[k] * part * np.exp(-one["damping"] * turn) * np.sin(turn)
            total[time >= start[k]] += np.outer(ring, [np.cos(direction[k]), np.sin(direction[k])])
    return total


def recording(scenario: Data, values: Data) -> Array:
    content = zlib.decompress(base64.b64decode(values["content"]))
    return np.asarray(values["gain_m_s2"] * np.frombuffer(content, "<f4").reshape(-1, 2).astype(np.float64))


MAKERS = {
    "white": white,
    "pink": pink,
    "shaft_harmonics": shaft_harmonics,
    "gear_mesh": gear_mesh,
    "mains_hum": mains_hum,
    "impulses": impulses,
    "recording": recording,
}
