"""The estimator that comes with spallgen, and those that users bring."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.judging.user_code import FIELD, load_user_code
from datagen.sizing.user_estimator import ESTIMATOR_FORMS, UserEstimator
from labels.schema import SPLITS
from labels.spall_size.estimation.calibration import Calibration
from labels.spall_size.estimation.estimator import SizeEstimator
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate

CALIBRATION_FILE = Path(__file__).with_name("calibration.npz")
# Recipes' seeds, which decide what machines are drawn, and the splits of their corpora that the calibration is fitted
# to: of datasets/size_ladder, size_training and size_imperfect.
FITTED_SPLITS: Mapping[int, tuple[str, ...]] = {3303: ("train", "validation"), 4404: SPLITS, 4406: SPLITS}


class AnyEstimator(Protocol):
    """Anything that estimates the size of the spall in one record."""

    def estimate(self, acceleration: NDArray[np.float64], rate: float, situation: Situation) -> SizeEstimate:
        """The size from acceleration (T, axes), m/s², the last one along the load, sampled at `rate` (Hz)."""


@cache
def default_estimator() -> SizeEstimator:
    """Our estimator, fitted to datasets/size_training, size_imperfect and all but the test split of size_ladder."""
    with np.load(CALIBRATION_FILE) as file:
        arrays: Mapping[str, NDArray[np.generic]] = {name: file[name] for name in file.files}
    return SizeEstimator(Calibration.from_arrays(dict(arrays)))


def is_fitted_to(seed: int, split: str) -> bool:
    """Whether our estimator has been fitted to machines that a recipe of this `seed` draws for this `split`."""
    return split in FITTED_SPLITS.get(seed, ())


@cache
def find_estimator(name: str | None) -> AnyEstimator:
    """The estimator called "module:Class", made without arguments, or "module:function", or the default one.

    A process makes it when it first asks for it, and then keeps it. Raises BadInput if there is none of that name.
    """
    if name is None:
        return default_estimator()
    made = load_user_code(name, ESTIMATOR_FORMS)
    if not callable(getattr(made, "estimate", made)):
        problem = "it has no method estimate, and cannot be called"
        raise BadInput(problem, field=FIELD, value=name, allowed=ESTIMATOR_FORMS)
    return UserEstimator(name, made)
