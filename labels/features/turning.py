"""Signals seen at even angles of the shaft instead of even instants: computed order tracking, for speeds that change.

Where the speed changes, lines of the shaft and of passing balls are smeared over frequency; over the angle turned they
stay lines. Resonances do the opposite, so bands are cut out of the signal in time, and what is turned is the slow rest:
the low end of its spectrum, and squared envelopes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft
from scipy.interpolate import CubicSpline

from physics.arrays import Array, ComplexArray

# Samples, for each component asked for, between which the spline runs.
OVERSAMPLING = 8
# Highest speed over the mean speed, reached at the end of an even run-up from rest: there the last component asked for
# comes from a component of this many times its number.
REACH = 2


@dataclass(frozen=True)
class Turning:
    """The `angle` (T,), rad, that the shaft has turned at each of T even instants of a record; ValueError if it turns
    back or stands still.

    Frequencies of what is seen at even angles are orders times the mean speed, `revolutions` a record.
    """

    angle: Array

    def __post_init__(self) -> None:
        if self.angle.ndim != 1 or self.angle.size < 2 or not (np.diff(self.angle) > 0.0).all():
            raise ValueError("the angle of the shaft has to grow from sample to sample")

    @property
    def revolutions(self) -> float:
        """How often the shaft turns in the record."""
        return float(self._course[-1]) / (2.0 * math.pi)

    @cached_property
    def _course(self) -> Array:
        """Angle turned (T + 1,) up to the end of the last sample, where the speed goes on."""
        return np.append(self.angle, 2.0 * self.angle[-1] - self.angle[-2]) - self.angle[0]

    @cached_property
    def _shares(self) -> Array:
        """Share of the record (T + 1,) that has passed by then."""
        return np.linspace(0.0, 1.0, self._course.size)

    def first(self, samples: int) -> Turning:
        """The turning of the first `samples` of the record."""
        return Turning(self.angle[:samples])

    def evenly(self, spectrum: ComplexArray, samples: int, count: int) -> Array:
        """What the Fourier components `spectrum` (F,) of the record's `samples` make up, at even angles (N,).

        It holds the first `count` components of what it turns into.
        """
        size = fft.next_fast_len(OVERSAMPLING * count, real=True)
        slow = np.asarray(fft.irfft(spectrum[: REACH * count], size)) * (size / samples)
        instants = np.interp(np.arange(size) * (self._course[-1] / size), self._course, self._shares)
        spline = CubicSpline(np.arange(size + 1) / size, np.append(slow, slow[0]), bc_type="periodic")
        return np.asarray(spline(instants))
