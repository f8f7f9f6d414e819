"""Random impulses: knocks at random instants that ring the machine's resonances."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from physics.arrays import Array
from physics.checks import (
    HIGHEST_DAMPING,
    require,
    require_below_nyquist,
    require_between,
    require_not_negative,
    require_positive,
    require_up_to,
    settle_tuples,
)
from physics.recursive_filter import filtered

MOST_PER_SECOND = 10_000.0
# With this spread of the logarithm one knock in six is 148 times the median or higher.
LARGEST_SPREAD = 5.0


@dataclass(frozen=True)
class Resonance:
    """A resonance of the machine: `frequency` (Hz) at which it rings and `damping`, nearly its share of the critical.

    InvalidParameter unless the frequency is above 0 and the damping above 0, 0.7 at most.
    """

    frequency: float
    damping: float

    def __post_init__(self) -> None:
        require_positive("frequency", self.frequency, "Hz", what="impulse resonance")
        require_up_to("damping", self.damping, HIGHEST_DAMPING, what="impulse damping")

    def check_rate(self, rate: float) -> None:
        """Raise InvalidParameter unless the resonance lies below half the sampling `rate` (Hz)."""
        require_below_nyquist("frequency", self.frequency, rate, what="impulse resonance")


@dataclass(frozen=True)
class Impulses:
    """Knocks that come `per_second` on average, independent of one another, and ring `resonances`.

    `amplitude` (m/s²) is their median height; its natural logarithm scatters by `spread`. InvalidParameter unless there
    are 0 to 10 000 a second, the amplitude is not below 0, the spread lies between 0 and 5 and there is a resonance.
    """

    per_second: float
    amplitude: float
    spread: float
    resonances: tuple[Resonance, ...]

    def __post_init__(self) -> None:
        settle_tuples(self, "resonances")
        require_between("per_second", self.per_second, 0.0, MOST_PER_SECOND, what="impulses per second")
        require_not_negative("amplitude", self.amplitude, "m/s²", what="impulse amplitude")
        require_between("spread", self.spread, 0.0, LARGEST_SPREAD, what="impulse spread")
        require(bool(self.resonances), "impulses have no resonance to ring", "resonances")

    def check_rate(self, rate: float) -> None:
        """Raise InvalidParameter unless all resonances lie below half the sampling `rate` (Hz)."""
        for resonance in self.resonances:
            resonance.check_rate(rate)


def impulses(generator: np.random.Generator, layer: Impulses, samples: int, rate: float) -> Array:
    """The knocks of one record (T, 2), m/s², each starting within it.

    Draws, in this order: their number N (Poisson), instants t (N,) (uniform), heights (N,) (log-normal), directions
    (N,) (uniform over the turn) and shares (N, R) of each resonance (uniform, then brought to a sum of 1). A knock adds
    height × share × (cos, sin)(direction) × exp(−2π ζ f τ) sin(2π f τ), τ being the time since it.
    InvalidParameter if a resonance does not lie below half the `rate` (Hz).
    """
    layer.check_rate(rate)
    duration = samples / rate
    count = int(generator.poisson(layer.per_second * duration))
    instant = duration * generator.random(count)
    height = layer.amplitude * np.exp(layer.spread * generator.standard_normal(count))
    direction = 2.0 * math.pi * generator.random(count)
    share = generator.random((count, len(layer.resonances)))
    share = share / share.sum(axis=1, keepdims=True)
    strength = height[:, None] * np.column_stack([np.cos(direction), np.sin(direction)])
    total = np.zeros((samples, 2))
    for number, resonance in enumerate(layer.resonances):
        total += _ringing(resonance, instant, strength * share[:, number, None], samples, rate)
    return total


def _ringing(resonance: Resonance, instant: Array, strength: Array, samples: int, rate: float) -> Array:
    """Decaying sines (T, 2) that start at `instant` (N,) s with `strength` (N, 2), exact at the samples."""
    turn = 2.0 * math.pi * resonance.frequency / rate
    decay = math.exp(-resonance.damping * turn)
    first = np.ceil(instant * rate).astype(np.int64)
    # A decaying sine follows from its first two samples: they are all that drives the recursion.
    started = [_sine(resonance, (first + later) / rate - instant)[:, None] * strength for later in (0, 1)]
    drive = np.zeros((samples + 2, 2))
    np.add.at(drive, first, started[0])
    np.add.at(drive, first + 1, started[1] - 2.0 * decay * math.cos(turn) * started[0])
    return filtered(drive[:samples], [((1.0, 0.0, 0.0), (-2.0 * decay * math.cos(turn), decay**2))])


def _sine(resonance: Resonance, since: Array) -> Array:
    turn = 2.0 * math.pi * resonance.frequency * since
    return np.exp(-resonance.damping * turn) * np.sin(turn)
