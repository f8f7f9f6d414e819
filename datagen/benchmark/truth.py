"""What a record is according to its labels: for training and scoring only, never told to a classifier or estimator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from labels.classifier.classes import joint_class
from labels.schema import LOCATIONS, UNKNOWN

if TYPE_CHECKING:
    import pandas


def true_class(labels: Mapping[str, Any]) -> str:
    """The class that a classifier learns from the record, or "unknown" where the labels do not say one of CLASSES."""
    try:
        return joint_class(str(labels["condition"]), str(labels["location"]))
    except ValueError:
        return UNKNOWN


def true_location(labels: Mapping[str, Any]) -> str:
    """none, outer or inner; "unknown" for everything else (a faulty ball too), which is predicted but not scored."""
    said = str(labels["location"])
    return said if said in LOCATIONS else UNKNOWN


def true_classes(table: pandas.DataFrame) -> NDArray[np.str_]:
    """The `true_class` (R,) of each record of a table of labels."""
    return np.array([true_class(labels) for _, labels in table.iterrows()], dtype=np.str_)


def true_locations(table: pandas.DataFrame) -> NDArray[np.str_]:
    """The `true_location` (R,) of each record of a table of labels."""
    return np.array([true_location(labels) for _, labels in table.iterrows()], dtype=np.str_)
