"""How records are read for the benchmark: in which pieces, with what noise added, and with how wrong a speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from datagen.benchmark.log_uniform import log_uniform
from labels.band_tree import COMMON_BANDWIDTH
from labels.noise import with_white_noise
from physics.arrays import Array

# s: about the longest record of the transfer corpus. Evidence of a weak modulation, which every healthy bearing has,
# grows with the length of what is looked at; so what is longer than anything learned from is cut, and the pieces vote.
LONGEST_WINDOW = 10.5
SHORTEST_COPY = 0.3
NOISY_COPIES = 2
# The last of them, of which a stretch alone is read.
STRETCHED_COPY = NOISY_COPIES
LEAST_NOISE_DB = -100.0


@dataclass(frozen=True)
class Reading:
    """How records are turned into rows.

    `bandwidth` (Hz) limits all records alike; `window` (s) is the longest piece. White noise is added at `noise_db`
    (signal over noise, None: none); `noise_draw` numbers its draws.

    The other fields are for training on simulated records, which have exact speeds and all the same rate. The speed
    given is off by up to the share `speed_error`, and the bandwidth is drawn between `lowest_bandwidth` (None: not
    drawn) and the record's own. With `copies_db` each record is read three times: as it is, and twice with noise at a
    level drawn between these two ratios (dB), once the whole record and once a stretch of at least 0.3 s.
    """

    bandwidth: float = COMMON_BANDWIDTH
    window: float = LONGEST_WINDOW
    noise_db: float | None = None
    noise_draw: int = 0
    speed_error: float = 0.0
    lowest_bandwidth: float | None = None
    copies_db: tuple[float, float] | None = None

    @property
    def copies(self) -> int:
        """How often each record is read; copy 0 is the record as it is, copy 2 a stretch of it."""
        return 1 if self.copies_db is None else 1 + NOISY_COPIES

    def stream(self, seed: list[int], copy: int) -> np.random.Generator:
        """The random numbers of a `copy` of the record with that `seed`, other ones for every draw of noise."""
        # Seeds may not be negative, and no level is below LEAST_NOISE_DB.
        level = 0 if self.noise_db is None else int(round(10 * self.noise_db) - 10 * LEAST_NOISE_DB)
        return np.random.default_rng([*seed, self.noise_draw, level, copy])

    def with_noise(self, signal: Array, copy: int, stream: np.random.Generator) -> Array:
        """The signal (T,) with the noise that this `copy` of it has."""
        level = self.noise_db
        if copy and self.copies_db is not None:
            level = stream.uniform(*self.copies_db)
        return signal if level is None else with_white_noise(signal, level, stream)

    def stretch(self, samples: int, rate: float, copy: int, stream: np.random.Generator) -> slice:
        """Which of so many `samples` a `copy` has: all, or a stretch anywhere in them.

        Its length is log-uniform from 0.3 s to the whole.
        """
        if copy != STRETCHED_COPY:
            return slice(None)
        shortest = min(SHORTEST_COPY * rate, samples)
        size = int(log_uniform(stream, shortest, samples))
        start = int(stream.integers(0, samples - size, endpoint=True))
        return slice(start, start + size)

    def drawn_bandwidth(self, rate: float, stream: np.random.Generator) -> float:
        """The bandwidth (Hz), drawn if it is to be, of one piece of a record at `rate` (Hz)."""
        top = min(self.bandwidth, rate / 2.0)
        if self.lowest_bandwidth is None or self.lowest_bandwidth >= top:
            return top
        return log_uniform(stream, self.lowest_bandwidth, top)

    def speed_factor(self, stream: np.random.Generator) -> float:
        """The factor, drawn around 1, by which the shaft speed given for one piece is wrong."""
        return 1.0 + self.speed_error * stream.uniform(-1.0, 1.0)
