"""Mean energy of any stretch of the mean pass."""

from __future__ import annotations

import numpy as np

from labels.spall_size.signal.mean_pass import Channel, MeanPass
from physics.arrays import Array

# Energy added before a logarithm is taken, in medians of the record, so that nothing has a logarithm too.
ENERGY_FLOOR = 1e-9
# Width of a stretch that counts at least, samples.
LEAST_WIDTH = 1e-9


class RunningEnergy:
    """Log mean energies from running sums; offsets wrap round one period."""

    def __init__(self, mean: MeanPass) -> None:
        self.first = float(mean.offset[0])
        self.last = float(mean.offset[-1])
        self.period = mean.period
        summed = np.cumsum(mean.energy, axis=1, dtype=np.float64)
        self.running = np.concatenate([np.zeros((len(Channel), 1)), summed], axis=1)
        self.grid = np.arange(self.running.shape[1])

    def level(self, start: Array, stop: Array) -> Array:
        """Log mean energy (4, P), a row per Channel, between the offsets `start` (P,) and `stop` (P,)."""
        shift = np.where(start < self.first, self.period, 0.0) - np.where(stop > self.last, self.period, 0.0)
        left, right = start + shift - self.first, stop + shift - self.first + 1.0
        width = np.maximum(right - left, LEAST_WIDTH)
        return np.stack(
            [
                np.log((np.interp(right, self.grid, row) - np.interp(left, self.grid, row)) / width + ENERGY_FLOOR)
                for row in self.running
            ]
        )
