"""What stands in for missing samples: values that go on from those before and lead to those after.

A straight line is as far off as the vibration is large, and its corners are impacts in the quietest band.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

from physics.arrays import Array

# Samples that foretell the next one, two for each resonance, and their largest share of all samples.
ORDER, LARGEST_SHARE = 32, 0.1
# Stretches of the recording from which it is learned how they do.
MOST_STRETCHES = 20_000


def straight(values: Array, bad: NDArray[np.intp]) -> Array:
    """The `values` (T,) with straight lines over the places `bad`: for pulses, of which `foretold` would add some."""
    good = np.delete(np.arange(values.size), bad)
    filled = values.copy()
    filled[bad] = np.interp(bad, good, values[good])
    return filled


def foretold(values: Array, bad: NDArray[np.intp]) -> Array:
    """The `values` (T,) with others at the places `bad`, by which the errors of foretelling every sample from those
    before it, and from those after it, are smallest [Janssen et al. 1986, IEEE Trans. ASSP 34, 317].

    T is 100 at least, and no more than a hundredth of the values are bad.
    """
    order = min(ORDER, int(LARGEST_SHARE * values.size))
    whole = values.copy()
    whole[bad] = 0.0
    forwards = _error_weights(whole, bad, order)
    both = [(weights, _of_missing(weights, bad, values.size)) for weights in (forwards, forwards[::-1])]
    errors = sum(missing.T @ np.correlate(whole, weights, "valid") for weights, missing in both)
    whole[bad] = spsolve(sum(missing.T @ missing for _, missing in both), -errors)
    return whole


def _error_weights(whole: Array, bad: NDArray[np.intp], order: int) -> Array:
    """By which `order` + 1 samples in a row must be multiplied for the error of foretelling the last one from the
    others; learned in both directions where none is `bad`."""
    stretches = np.lib.stride_tricks.sliding_window_view(whole, order + 1)
    holes = np.zeros(whole.size + 1, dtype=np.int64)
    holes[bad + 1] = 1
    before = np.cumsum(holes)
    sound = np.flatnonzero(before[order + 1 :] == before[: -order - 1])
    chosen = stretches[sound[:: -(-sound.size // MOST_STRETCHES)]]
    chosen = np.concatenate([chosen, chosen[:, ::-1]])
    foretelling, *_ = np.linalg.lstsq(chosen[:, :-1], chosen[:, -1])
    return np.append(-foretelling, 1.0)


def _of_missing(weights: Array, bad: NDArray[np.intp], size: int) -> csc_array:
    """Weight of each of the samples `bad` in the error of each stretch of `size` samples (stretches, bad)."""
    stretches = size - weights.size + 1
    starts = bad[:, None] - np.arange(weights.size)
    column, tap = np.nonzero((starts >= 0) & (starts < stretches))
    return csc_array((weights[tap], (starts[column, tap], column)), shape=(stretches, bad.size))
