"""Records as one xarray dataset a shard: names, dimensions and units come from the tables of `labels`."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.records.profile_grid import profile_grid
from datagen.versions import program_versions
from labels.schema import BAND_EDGES, LABELS, LAYERS, Label
from labels.variables import AXES, DEFECTS, PASSES, SIGNALS, VARIABLES, Variable
from physics.words import STIFFNESS_COMPONENTS

if TYPE_CHECKING:
    import xarray

    from datagen.records.record import Record

FORMAT = "spallgen corpus 1"
SIMULATED, IMPORTED = "simulated", "imported"
COMPONENT_DIMENSIONS = {BAND_EDGES: ("band_edge",), LAYERS: ("layer",)}
SIMULATED_ATTRIBUTES = {
    "summary": "Simulated vibration of rolling bearings, healthy or with a raceway spall, with exact labels.",
    "keywords": "rolling bearing, raceway spall, vibration, condition monitoring, simulation",
    "source": "six-degree-of-freedom bearing model with nonlinear contact, simulated by spallgen",
    "references": "Petersen, Howard, Sawalhi, Moazen Ahmadi, Singh (2014)",
    "processing_level": SIMULATED,
}
NUMBERS = {label.name for label in LABELS if label.dtype == "float64"}
ROUNDED = "Rounded from float64 to float32: relative error of each value at most 6e-8."
# Stored over raw size with zlib, as measured on both test rigs; used to estimate the disk space that a corpus needs.
ZLIB_SHARE = {
    "acceleration": 0.9,
    "acceleration_clean": 0.85,
    "acceleration_sensor": 0.9,
    "background": 0.25,
    "envelope": 0.77,
    "stiffness": 0.6,
    "cage_angle": 0.72,
    "profile_depth": 0.39,
    "contact_force": 0.3,
}


@dataclass(frozen=True)
class Identity:
    """What made a corpus, as hashes of 16 hexadecimal digits: a corpus never mixes two identities.

    `model_hash` is that of the physics, `program_hash` that of the other packages that draw, describe and store records
    (of their whole text, comments included). The `recipe_hash` of an imported corpus is that of its SPEC and of the
    files that this names, and its `model_hash` is "".
    """

    recipe_hash: str
    model_hash: str
    format_hash: str
    program_hash: str

    def to_dict(self) -> dict[str, str]:
        """The hashes by name."""
        return asdict(self)


@cache
def format_hash() -> str:
    """Hash of the names, dimensions, types, units and meanings of all variables and labels, 16 hexadecimal digits."""
    rows = [FORMAT, *map(asdict, VARIABLES), *map(asdict, LABELS)]
    return data_hash(rows)


def data_hash(data: Any) -> str:
    """Hash of plain data, 16 hexadecimal digits."""
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()[:16]


def label_variable(label: Label) -> Variable:
    """The variable that holds a label: one value a record, or one a record and component."""
    dims = ("record", *COMPONENT_DIMENSIONS.get(label.components, ()))
    return Variable(
        label.name, dims, label.dtype, label.unit, label.name.replace("_", " "), label.sentence,
        values=label.values, missing=label.missing,
    )  # fmt: skip


LABEL_VARIABLES = tuple(label_variable(label) for label in LABELS if label.name != "record")
VARIABLE = {variable.name: variable for variable in (*VARIABLES, *LABEL_VARIABLES)}


def to_dataset(records: Sequence[Record], attributes: dict[str, str]) -> xarray.Dataset:
    """One dataset of `records` that share sampling rate, duration, bearing size, stiffness axis and stored signals.

    `attributes` are added to the global ones. Variables absent from the records are absent from the dataset.
    """
    first = records[0]
    columns: dict[str, Any] = {"scenario": [record.scenario for record in records]}
    for variable in SIGNALS:
        if getattr(first, variable.name) is not None:
            columns[variable.name] = np.stack([getattr(record, variable.name) for record in records])
    for label in LABELS:
        columns[label.name] = [record.labels[label.name] for record in records]
    columns |= _pass_columns(records) | _defect_columns(records) | _coordinates(first, columns)
    return from_columns(columns, global_attributes(first.labels) | SIMULATED_ATTRIBUTES | attributes)


def from_columns(columns: dict[str, Any], attributes: dict[str, str]) -> xarray.Dataset:
    """The dataset of values by name of variable or label, with the dimensions, types and units of the tables."""
    import xarray

    imported = attributes.get("processing_level") == IMPORTED
    data = {name: _array(VARIABLE[name], values, imported) for name, values in columns.items()}
    coordinates = {name: data.pop(name) for name in list(data) if VARIABLE[name].dims == (name,)}
    return xarray.Dataset(data, coordinates, attributes)


def is_imported(dataset: xarray.Dataset) -> bool:
    """True if the records of a shard's `dataset` are imported recordings."""
    return dataset.attrs.get("processing_level") == IMPORTED


def _array(variable: Variable, values: Any, imported: bool) -> tuple[tuple[str, ...], np.ndarray, dict[str, str]]:
    dtype: Any = np.str_ if variable.dtype == "str" else variable.dtype
    attributes = {"long_name": variable.long_name, "comment": variable.sentence}
    if variable.unit:
        attributes["units"] = variable.unit
    if variable.dtype == "float32":
        attributes["comment"] += f" {ROUNDED}"
    unknown = "it is unknown" if imported and variable.name in NUMBERS else ""
    if variable.missing or unknown:
        attributes["missing"] = f"NaN where {', or '.join(filter(None, (variable.missing, unknown)))}"
    return variable.dims, np.asarray(values, dtype=dtype), attributes


def _coordinates(first: Record, columns: dict[str, Any]) -> dict[str, Any]:
    known = {"time": first.time, "axis": AXES, "component": STIFFNESS_COMPONENTS,
             "stiffness_time": first.stiffness_time, "band_edge": BAND_EDGES, "layer": LAYERS}  # fmt: skip
    for dim in ("row", "ball", "profile_angle"):
        owner = next((v for v in SIGNALS if dim in v.dims and v.name in columns), None)
        if owner is not None:
            size = columns[owner.name].shape[owner.dims.index(dim)]
            known[dim] = profile_grid(size) if dim == "profile_angle" else np.arange(1, size + 1)
    return known


def _pass_columns(records: Sequence[Record]) -> dict[str, Any]:
    columns = {"pass_record": _repeated(records, [record.passes.entry_time.size for record in records])}
    for variable in PASSES[1:]:
        field = variable.name.removeprefix("pass_")
        columns[variable.name] = np.concatenate([getattr(record.passes, field) for record in records])
    return columns


def _defect_columns(records: Sequence[Record]) -> dict[str, Any]:
    columns: dict[str, Any] = {"defect_record": _repeated(records, [len(record.spalls) for record in records])}
    spalls = [spall for record in records for spall in record.spalls]
    for variable in DEFECTS[1:]:
        columns[variable.name] = [getattr(spall, variable.name.removeprefix("defect_")) for spall in spalls]
    return columns


def _repeated(records: Sequence[Record], counts: list[int]) -> np.ndarray:
    return np.repeat(np.array([record.index for record in records], dtype=np.int64), counts)


def global_attributes(labels: Mapping[str, Any]) -> dict[str, str]:
    """The attributes of a shard that every corpus has; `labels` are those of one of its records."""
    duration, rate = labels["duration_s"], labels["rate_hz"]
    return {
        "Conventions": "CF-1.11, ACDD-1.3",
        "format": FORMAT,
        "product_version": f"spallgen {program_versions()['spallgen']}",
        "time_coverage_duration": _iso_duration(float(duration)),
        "time_coverage_resolution": _iso_duration(1.0 / float(rate)),
    }


def _iso_duration(seconds: float) -> str:
    """A duration in the words of ISO 8601, which knows no powers of ten, with 12 digits."""
    return f"PT{np.format_float_positional(seconds, precision=12, unique=False, fractional=False, trim='-')}S"


def content_hash(dataset: xarray.Dataset) -> str:
    """SHA-256 of names, dimensions, types and values of all variables: the same for equal arrays, however stored."""
    digest = hashlib.sha256()
    for name in sorted(map(str, dataset.variables)):
        variable = dataset.variables[name]
        text = variable.dtype.kind in "OUT"
        values = np.asarray(variable.values)
        kind = "str" if text else values.dtype.newbyteorder("<").str
        digest.update(json.dumps([name, list(map(str, variable.dims)), kind, list(values.shape)]).encode())
        if text:
            digest.update(json.dumps([str(value) for value in values.ravel()]).encode())
        else:
            digest.update(np.ascontiguousarray(values.astype(kind, copy=False)).reshape(-1).view(np.uint8).data)
    return digest.hexdigest()
