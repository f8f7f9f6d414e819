"""The limits of a calibration: above which doubt no size is given, and how far intervals reach."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.sizing.cross_fit import CrossFit
from datagen.sizing.trial_columns import TrialColumns
from physics.arrays import Array

COVERAGE = 0.90
ABSTENTION = 0.98
LAG_ERROR = 0.045  # of what is answered of clean records; 0.05 is asked of machines not seen


def most_doubt(columns: TrialColumns, error: Array, expected: Array) -> float:
    """The largest `expected` error (N,) at which a size is given, for lags of this relative `error` (N,).

    At it 98 % of the trials without events get none; it is lower if the mean error of the typical clean ones would
    otherwise be above 4.5 %. There must be a trial without events.
    """
    abstaining = float(np.quantile(expected[columns.eventless], 1.0 - ABSTENTION))
    clean = columns.asked_clean
    return CrossFit(error[clean], expected[clean], abstaining).most_within(LAG_ERROR)


def reach(missed: Array, usual: NDArray[np.bool_]) -> float:
    """The factor on expected errors within which 90 % of the `usual` errors lie, from `missed` (N,), errors over
    expected ones.

    Raises BadInput if none of the usual ones is known.
    """
    known = missed[usual & np.isfinite(missed)]
    if known.size == 0:
        raise BadInput(
            "no record of the first corpus that is given a size has known events, so intervals have no reach"
        )
    return float(np.quantile(known, COVERAGE))
