"""Spalls of two degrees at the bottom of a race."""

import dataclasses
import math

import numpy as np

from physics.spall import Spall

EXTENT = math.radians(2.0)
BOTTOM = math.radians(270.0)
DEEP = 1e-3


def gap(race="outer", extent=EXTENT, depth=DEEP, **other):
    return Spall(race, 1, BOTTOM, extent, depth, profile="ball_path", **other)


def tukey(race="outer", **changes):
    return dataclasses.replace(Spall(race, 1, BOTTOM, EXTENT, 12e-6, 0.010, 0.004), **changes)


def inside(spall, count=1001):
    return np.linspace(-spall.extent / 2, spall.extent / 2, count)
