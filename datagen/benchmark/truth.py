"""What a record is according to its labels: for training and scoring only, never told to a classifier or estimator."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from labels.classifier.classes import joint_class
from labels.schema import LOCATIONS, UNKNOWN

if TYPE_CHECKING:
    import pandas


def true_classes(table: pandas.DataFrame) -> NDArray[np.str_]:
    """The class (R,) that a classifier learns from each record of a table of labels, or "unknown" where these do not
    say one of CLASSES."""
    return np.array([_class(*said) for said in zip(table["condition"], table["location"], strict=True)], dtype=np.str_)


def _class(condition: str, location: str) -> str:
    try:
        return joint_class(condition, location)
    except ValueError:
        return UNKNOWN


def true_locations(table: pandas.DataFrame) -> NDArray[np.str_]:
    """none, outer or inner (R,) of each record of a table of labels; "unknown" for everything else (a faulty ball too),
    which is predicted but not scored."""
    said = table["location"].to_numpy(np.str_)
    return np.where(np.isin(said, LOCATIONS), said, UNKNOWN)
