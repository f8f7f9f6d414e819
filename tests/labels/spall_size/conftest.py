from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from labels.spall_size.estimation.trees import Trees

RATE = 65536.0

sys.path.insert(0, str(Path(__file__).parent))  # so that tests can import made_passes


@dataclass(frozen=True)
class PulseTrain:
    """Two pulses a pass through a resonator: what was made, times in s."""

    signal: np.ndarray
    entry: np.ndarray
    exit: np.ndarray
    period: float


@pytest.fixture
def pulse_train():
    """A maker of pulse trains of known lag through a resonator of 6 kHz, 2 % damping, with a slipping cage."""

    def make(
        lag: float, period: float, *, slip: float = 0.009, noise: float = 0.0, exit_size: float = 1.0, seed: int = 3,
        duration: float = 1.0,
    ) -> PulseTrain:  # fmt: skip
        generator = np.random.default_rng(seed)
        steps = period * (1.0 + slip * generator.standard_normal(int(1.2 * duration / period)))
        entry = 0.4 * period + np.concatenate([[0.0], np.cumsum(steps)])
        entry = entry[entry < duration - 1.5 * period]
        count = round(duration * RATE)
        excitation = np.zeros(count)
        # Pulses a fraction of a sample wide in time, their place rounded: half a sample at most.
        for times, size in ((entry, 0.7), (entry + lag, exit_size)):
            np.add.at(excitation, np.round(times * RATE).astype(int), size)
        frequency, damping = 2.0 * np.pi * 6000.0 / RATE, 0.02
        pole = np.exp(-damping * frequency) * np.exp(1j * frequency)
        signal = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], excitation)
        signal = signal + noise * signal.std() * generator.standard_normal(count)
        return PulseTrain(signal, entry, entry + lag, period)

    return make


@pytest.fixture(scope="session")
def saying():
    """A maker of trees that say the same of every row."""

    def make(value: float) -> Trees:
        leaf, nowhere = np.full(1, -1, np.int16), np.zeros(1, np.int32)
        nothing = np.zeros(1, np.float32)
        return Trees(leaf, nothing, nowhere, nowhere, nothing, nowhere, value)

    return make
