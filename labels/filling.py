"""What stands in for samples that are missing or wrong: values that go on from those before and lead to those after.

A straight line is as far off as the vibration is large, and its corners are impacts in the quietest band.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve
from threadpoolctl import threadpool_limits

from physics.arrays import Array

# Samples that foretell the next one, two for each resonance, and their largest share of all samples.
ORDER, LARGEST_SHARE = 32, 0.1
# Most stretches of a signal that the weights of these samples are learned from, and the fewest for each weight.
MOST_STRETCHES, STRETCHES_A_WEIGHT = 20_000, 4


def straight(values: Array, bad: NDArray[np.intp]) -> Array:
    """The `values` (T,) with straight lines over the places `bad` (B,): for pulses, as `foretold` adds some."""
    good = np.delete(np.arange(values.size), bad)
    filled = values.copy()
    filled[bad] = np.interp(bad, good, values[good])
    return filled


def foretold(values: Array, bad: NDArray[np.intp]) -> Array:
    """The `values` (T,) with others at the places `bad` (B,), by which the errors of foretelling every sample
    from those before it, and from those after it, are smallest [Janssen et al. 1986, IEEE Trans. ASSP 34, 317].

    Straight lines where too few stretches without bad places are left to learn from.
    """
    order = max(1, min(ORDER, int(LARGEST_SHARE * values.size)))
    level = np.delete(values, bad).mean()
    whole = values - level
    whole[bad] = 0.0
    stretches = _sound_stretches(whole, bad, order)
    if len(stretches) < STRETCHES_A_WEIGHT * order:
        return straight(values, bad)
    with threadpool_limits(1):  # the last digits of sums depend on how many threads share them
        forwards = _error_weights(stretches)
        both = [(weights, _of_missing(weights, bad, values.size)) for weights in (forwards, forwards[::-1])]
        errors = sum(missing.T @ np.correlate(whole, weights, "valid") for weights, missing in both)
        filled = values.copy()
        filled[bad] = level + spsolve(sum(missing.T @ missing for _, missing in both), -errors)
    return filled


def _sound_stretches(whole: Array, bad: NDArray[np.intp], order: int) -> Array:
    """Some of the stretches of `order` + 1 samples in a row of which none is `bad` (B,): (stretches, order + 1)."""
    stretches = np.lib.stride_tricks.sliding_window_view(whole, order + 1)
    holes = np.zeros(whole.size + 1, dtype=np.int64)
    holes[bad + 1] = 1
    before = np.cumsum(holes)
    sound = np.flatnonzero(before[order + 1 :] == before[: -order - 1])
    return stretches[sound[:: max(-(-sound.size // MOST_STRETCHES), 1)]]


def _error_weights(stretches: Array) -> Array:
    """By which the samples of a stretch must be multiplied for the error of foretelling the last one from the others;
    learned from `stretches` in both directions."""
    chosen = np.concatenate([stretches, stretches[:, ::-1]])
    foretelling, *_ = np.linalg.lstsq(chosen[:, :-1], chosen[:, -1])
    return np.append(-foretelling, 1.0)


def _of_missing(weights: Array, bad: NDArray[np.intp], size: int) -> csc_array:
    """Weight (stretches, B) of each sample of `bad` (B,) in the error of each stretch of a signal of `size` samples."""
    stretches = size - weights.size + 1
    starts = bad[:, None] - np.arange(weights.size)
    column, tap = np.nonzero((starts >= 0) & (starts < stretches))
    return csc_array((weights[tap], (starts[column, tap], column)), shape=(stretches, bad.size))
