"""The sampling rate of a file that holds the times of its samples instead of a rate."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput

# How far times, which are often written with few decimals, may lie off a straight line, as a share of their span.
ROUNDING = 1e-3
DIGITS = 9


def rate_of(times: NDArray[np.float64], path: Path, wish: str) -> float:
    """Sampling rate, Hz, of samples at evenly spaced `times` (T,), s; a single number is the step between them.

    Of the rates that the rounded times allow it is the one with the fewest digits: the files of a data set are rounded
    differently but have the same rate. Raises BadInput naming file and variable if the times do not rise evenly.
    """
    refusal, beside = partial(BadInput, file=str(path), field="rate_hz", value=wish), 0.0
    if times.size == 1:
        step = float(times.ravel()[0])
    elif times.ndim == 1:
        step = float(times[-1] - times[0]) / (times.size - 1)
        beside = float(np.abs(times - times[0] - step * np.arange(times.size)).max())
        if beside > max(2.0 * abs(step), ROUNDING * abs(step) * times.size):
            raise refusal("these times are not evenly spaced", allowed="one step between all samples")
    else:
        step = 0.0
    if not (0.0 < step < math.inf and 1.0 / step < math.inf):
        raise refusal("is not a column of rising times", allowed="times or their step, s")
    return _roundest(step, 2.0 * beside / max(times.size - 1, 1))


def _roundest(step: float, off: float) -> float:
    """The rate, Hz, with the fewest digits whose step, s, is no more than `off` from `step`."""
    rates = [float(f"{1.0 / step:.{digits}g}") for digits in range(1, DIGITS + 1)]
    return next((rate for rate in rates if abs(1.0 / rate - step) <= off), rates[-1])
