"""A generator without contact physics, to compare with: impulses at ball pass orders that ring random resonances.

What published synthetic sets do. It has bearings, speeds, slip, modulation and noise like those of a drawn machine, so
what it lacks is the contact model alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import fftconvolve

from datagen.benchmark.log_uniform import log_uniform
from labels.features.kinematics import Kinematics
from labels.schema import LOCATIONS
from physics.angular_speed import RPM_PER_HZ
from physics.arrays import Array
from physics.orders import ball_spin_order

# Lengths (s) and their shares, as in the transfer recipe.
DURATIONS, SHARES = (0.4, 0.8, 2.0, 10.0), (4 / 12, 4 / 12, 3 / 12, 1 / 12)
PURPOSES = ("duration", "bearing", "paths", "floor", "noise", "background", "impulses")


@dataclass(frozen=True)
class Ingredients:
    """What a drawn machine has, each of which can be left out for an ablation."""

    shaft_modulation: bool = True
    machine_floor: bool = True
    sensor_paths: bool = True
    backgrounds: bool = True


@dataclass(frozen=True)
class Train:
    """One record: `signal` (T,) at `rate` (Hz), what is known of it, its location and its machine."""

    signal: Array
    rate: float
    kinematics: Kinematics
    location: str
    machine: int


@dataclass(frozen=True)
class Streams:
    """Random numbers of a record: every purpose has a stream of its own, so that what is left out changes no other."""

    seed: int
    machine: int
    record: int

    def of_machine(self, purpose: str) -> np.random.Generator:
        """The stream that all records of the machine share."""
        return self._stream(0, purpose)

    def of_record(self, purpose: str) -> np.random.Generator:
        """The record's own stream."""
        return self._stream(self.record + 1, purpose)

    def _stream(self, scope: int, purpose: str) -> np.random.Generator:
        key = (self.machine, scope, PURPOSES.index(purpose))
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=key))


def draw_train(seed: int, machine: int, record: int, ingredients: Ingredients) -> Train:
    """The record with that number of a virtual machine; the same numbers always give the same record."""
    streams = Streams(seed, machine, record)
    of_machine, of_record = streams.of_machine, streams.of_record
    rate, duration = 25_600.0, float(of_record("duration").choice(DURATIONS, p=SHARES))
    kinematics = _bearing(of_machine("bearing"), of_record("bearing"))
    location = LOCATIONS[record % len(LOCATIONS)]
    # Without paths of their own all machines ring with the same single resonance.
    paths_from = of_machine("paths") if ingredients.sensor_paths else np.random.default_rng(seed)
    paths = _paths(paths_from, several=ingredients.sensor_paths)
    floor = log_uniform((of_machine if ingredients.machine_floor else of_record)("floor"), 0.03, 6.0)
    size = int(rate * duration)
    signal = floor * of_record("noise").standard_normal(size)
    if ingredients.backgrounds:
        signal += _background(streams, size, rate, kinematics)
    if location != "none":
        force = impulses(streams, size, rate, kinematics, location, ingredients.shaft_modulation)
        signal += fftconvolve(force, _ringing(paths, rate))[:size]
    return Train(signal, rate, kinematics, location, machine)


def _bearing(of_machine: np.random.Generator, of_record: np.random.Generator) -> Kinematics:
    ratio = of_machine.uniform(0.12, 0.27)
    most = np.pi / np.arcsin(ratio)
    balls = max(5, int(of_machine.uniform(0.6, 0.95) * most))
    ratio *= np.cos(np.radians(min(abs(of_machine.normal(0.0, 8.0)), 25.0)))
    speed = log_uniform(of_machine, 500.0, 3600.0) / RPM_PER_HZ * of_record.uniform(0.75, 1.25)
    return Kinematics(balls, float(ratio), float(ball_spin_order(1.0 / ratio, ratio)), float(speed))


def _paths(generator: np.random.Generator, several: bool) -> list[tuple[float, float, float]]:
    """Frequency (Hz), damping and gain of each resonance: of up to six, or of one."""
    count = int(generator.integers(1, 7)) if several else 1
    return [
        (
            log_uniform(generator, 800.0, 11_000.0),
            float(generator.uniform(0.01, 0.08)),
            float(generator.uniform(0.1, 1.0)),
        )
        for _ in range(count)
    ]


def _ringing(paths: list[tuple[float, float, float]], rate: float) -> Array:
    time = np.arange(int(0.02 * rate)) / rate
    total = np.zeros(time.size)
    for frequency, damping, gain in paths:
        omega = 2.0 * np.pi * frequency
        total += gain * np.exp(-damping * omega * time) * np.sin(omega * time)
    return np.asarray(total)


def impulses(streams: Streams, size: int, rate: float, kinematics: Kinematics, location: str, modulated: bool) -> Array:
    """Impulses (size,) of balls that hit a defect on the race `location`, at a `rate` (Hz).

    Times and heights are random. On an inner race the heights follow its load; on an outer one they vary with the turn
    of the shaft if `modulated`.
    """
    own = streams.of_record("impulses")
    times = _pass_times(own, kinematics, location, size / rate)
    turn = 2.0 * np.pi * kinematics.shaft_hz * times + own.uniform(0.0, 2.0 * np.pi)
    heights = _heights(streams.of_machine("impulses"), own, turn, location, modulated)
    force = np.zeros(size)
    inside = (times >= 0.0) & (times * rate < size - 1)
    np.add.at(force, (times[inside] * rate).astype(np.int64), heights[inside])
    return force


def _pass_times(of_record: np.random.Generator, kinematics: Kinematics, location: str, duration: float) -> Array:
    """Times (s) at which balls hit a defect, with random slip and jitter, from before the start of a
    `duration` (s) to about its end; jitter may leave out the last one or two."""
    slip = of_record.uniform(0.0, 0.02)
    cage = kinematics.ftf * (1.0 - slip)
    order = kinematics.balls * (cage if location == "outer" else 1.0 - cage)
    period = 1.0 / (order * kinematics.shaft_hz)
    count = int(duration / period) + 2
    jitter = of_record.uniform(0.002, 0.02)
    steps = period * (1.0 + jitter * of_record.standard_normal(count))
    return np.asarray(np.cumsum(steps) - period * of_record.uniform())


def _heights(
    of_machine: np.random.Generator, of_record: np.random.Generator, turn: Array, location: str, modulated: bool
) -> Array:
    """Heights of impulses at such angles (rad) of the shaft's `turn`."""
    if location == "inner":
        load = np.maximum(np.cos(turn) + of_machine.uniform(-0.2, 0.8), 0.05)
    else:
        depth = of_record.uniform(0.0, 0.6)  # drawn for all, so that what is drawn below is the same either way
        load = 1.0 + (depth if modulated else 0.0) * np.cos(turn)
    height = log_uniform(of_record, 0.3, 20.0) * load
    return np.asarray(height * np.exp(0.2 * of_record.standard_normal(turn.size)))


def _background(streams: Streams, size: int, rate: float, kinematics: Kinematics) -> Array:
    """Shaft and mains tones, a gear mesh with sidebands, and random knocks; levels are the machine's."""
    of_machine, of_record = streams.of_machine("background"), streams.of_record("background")
    time = np.arange(size) / rate
    total = np.zeros(size)
    for frequency, amplitude in tones(of_machine, kinematics.shaft_hz):
        if frequency < rate / 2.0:
            total += amplitude * np.cos(2.0 * np.pi * frequency * time + of_record.uniform(0.0, 2.0 * np.pi))
    knocks = np.zeros(size)
    count = int(of_record.poisson(log_uniform(of_machine, 0.3, 30.0) * size / rate))
    knocks[of_record.integers(0, size, count)] = log_uniform(of_machine, 0.01, 20.0) * np.exp(
        0.5 * of_record.standard_normal(count)
    )
    return total + fftconvolve(knocks, _ringing(_paths(of_machine, several=True), rate))[:size]


def tones(of_machine: np.random.Generator, shaft_hz: float) -> list[tuple[float, float]]:
    """Frequency (Hz) and amplitude of ten tones of the shaft, four of the mains and five of the gear mesh."""
    found = [(order * shaft_hz, log_uniform(of_machine, 0.01, 3.0) / order) for order in range(1, 11)]
    mains = float(of_machine.choice([50.0, 60.0]))
    found += [(order * mains, log_uniform(of_machine, 0.003, 0.6) / order) for order in range(1, 5)]
    teeth, mesh = int(of_machine.integers(17, 42)), log_uniform(of_machine, 0.001, 5.0)
    return found + [((teeth + side) * shaft_hz, mesh * 0.3 ** abs(side)) for side in (-2, -1, 0, 1, 2)]
