"""Impulse trains at known orders, made without any code of the package."""

import numpy as np
import pytest


@pytest.fixture(scope="session")
def impulse_train():
    """Function (order, rate, duration, shaft_hz, snr_db, seed, modulation) → signal (T,): decaying tones in noise."""

    def make(order, rate=20_000.0, duration=1.0, shaft_hz=25.0, snr_db=0.0, seed=0, modulation=0.0, tone=0.11):
        generator = np.random.default_rng(seed)
        size = int(rate * duration)
        times = np.arange(0.0, duration, 1.0 / (order * shaft_hz))
        force = np.zeros(size)
        height = 1.0 + modulation * np.cos(2.0 * np.pi * shaft_hz * times)
        force[np.minimum((times * rate).astype(int), size - 1)] = height
        time = np.arange(int(0.01 * rate)) / rate
        # The tone is a share of the lowest rate used, so that it is in every record.
        ringing = np.exp(-900.0 * time) * np.sin(2.0 * np.pi * tone * 20_000.0 * time)
        signal = np.convolve(force, ringing)[:size]
        return signal / signal.std() * 10.0 ** (snr_db / 20.0) + generator.standard_normal(size)

    return make
