"""Imported records as the dataset of a shard, with the names, types and units of the tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from datagen.corpus_files.format import COMPONENT_DIMENSIONS, IMPORTED, from_columns, global_attributes
from datagen.recordings.recorded import Recorded
from labels.envelope import stored_envelope
from labels.schema import LABELS

if TYPE_CHECKING:
    import xarray

ATTRIBUTES = {
    "summary": "Vibration of rolling bearings, recorded on real machines and imported with the labels that are known.",
    "keywords": "rolling bearing, vibration, condition monitoring, measurement",
    "source": "recordings of real machines, imported by spallgen",
    "processing_level": IMPORTED,
}


def imported_dataset(indices: Sequence[int], records: Sequence[Recorded], attributes: dict[str, str]) -> xarray.Dataset:
    """One dataset of `records` that share their `key`, with these global `indices`; unknown labels are left out, and
    `attributes` are added to the global ones."""
    first = records[0]
    columns: dict[str, Any] = {
        "acceleration": np.stack([record.acceleration for record in records]),
        "provenance": [record.provenance for record in records],
        "time": np.arange(first.acceleration.shape[0]) / first.rate,
        "axis": first.axes,
        **{dim: parts for parts, (dim,) in COMPONENT_DIMENSIONS.items()},
    }
    angles = [record.shaft_angle for record in records if record.shaft_angle is not None]
    if angles:
        columns["shaft_angle"] = np.stack(angles)
    if "y" in first.axes:
        columns["envelope"] = np.stack([_envelope(record) for record in records])
    columns |= {
        label.name: [record.labels[label.name] for record in records] for label in LABELS if label.name in first.labels
    }
    return from_columns(columns | {"record": indices}, global_attributes(first.labels) | ATTRIBUTES | attributes)


def _envelope(record: Recorded) -> NDArray[np.float32]:
    along = record.acceleration[:, record.axes.index("y")]
    return stored_envelope(along, record.rate, record.labels["envelope_band"])
