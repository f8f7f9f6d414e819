"""Passes made for tests: their rate, period and lag, bursts, and means of passes that are known."""

import numpy as np

from labels.spall_size.signal.alignment import Alignment
from labels.spall_size.signal.mean_pass import MeanPass, mean_pass

RATE = 65536.0
PERIOD = 0.011
LAG = 60.0 / RATE


def offset_from(found, true):
    """Distance (s) of each found time from the nearest true one."""
    return found - true[np.abs(true[None, :] - found[:, None]).argmin(axis=1)]


def bursts(cell, height, count):
    """The energy of `count` cells of the tracker, five samples each, all 1 but at a `cell` with an event."""
    energy = np.ones(count)
    energy[np.asarray(cell)] = height
    return np.repeat(energy, 5)


def mean_of_passes(whitened, place, weight=None, signal=None):
    weight = np.ones(len(place)) if weight is None else np.array(weight)
    signal = whitened if signal is None else signal
    return mean_pass(signal, whitened, Alignment(np.asarray(place, dtype=float), weight), 400.0)


def mean_of_steps(first, last, period=400.0):
    """A mean pass with a rumble of a hundredfold energy between two offsets, in every channel."""
    offset = np.arange(-440, 441)
    phase = (offset + 0.5 * period) % period - 0.5 * period
    rumble = np.where((phase >= first) & (phase <= last), 100.0, 1.0)
    flat = np.zeros(offset.size)
    return MeanPass(offset, np.tile(rumble, (4, 1)), flat, flat, 1.0, flat, 1.0, 50.0, period)
