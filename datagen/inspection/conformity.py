"""Whether a shard's dataset is what the tables of labels and variables say: one sentence for each thing wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from datagen.corpus_files.format import LABEL_VARIABLES, is_imported
from labels.schema import HEALTHY, LABEL
from labels.variables import VARIABLES, Variable
from physics.spall import EXTENDED_FROM

if TYPE_CHECKING:
    import xarray


def violations(dataset: xarray.Dataset) -> Iterator[str]:
    """Every way in which the decoded `dataset` of a shard departs from the format or contradicts itself.

    Imported recordings may leave labels unknown and have no tables of passes and defects.
    """
    wrong = [sentence for variable in (*VARIABLES, *LABEL_VARIABLES) for sentence in _wrong_variable(dataset, variable)]
    yield from wrong
    if not wrong:
        yield from _wrong_times(dataset)
        yield from _wrong_labels(dataset)
        if not is_imported(dataset):
            yield from _wrong_tables(dataset)


def _is_optional(variable: Variable, dataset: xarray.Dataset) -> bool:
    imported = is_imported(dataset)
    coordinate_of_nothing = variable.dims == (variable.name,) and variable.name not in dataset.dims
    unknown = imported and variable.name in LABEL and variable.dtype in ("int64", "bool")
    return not variable.required(imported) or coordinate_of_nothing or unknown


def _wrong_variable(dataset: xarray.Dataset, variable: Variable) -> Iterator[str]:
    name = variable.name
    if name not in dataset.variables:
        if not _is_optional(variable, dataset):
            yield f"{name} is missing"
        return
    found = dataset.variables[name]
    kind = "str" if found.dtype.kind in "OUT" else str(found.dtype)
    if found.dims != variable.dims:
        yield f"{name} has dimensions {found.dims}; they must be {variable.dims}"
    if kind != variable.dtype:
        yield f"{name} is of type {kind}; it must be {variable.dtype}"
        return
    if found.attrs.get("units", "") != variable.unit:
        yield f'{name} has the unit "{found.attrs.get("units", "")}"; it must be "{variable.unit}"'
    if kind.startswith("float"):
        may_be_unknown = variable.missing or (name in LABEL and is_imported(dataset))
        bad = np.isinf(found.values) if may_be_unknown else ~np.isfinite(found.values)
        if bad.any():
            yield f"{name} has {int(bad.sum())} values that are not finite"
    if variable.values is not None:
        allowed = variable.values + (LABEL[name].imported if name in LABEL and is_imported(dataset) else ())
        strange = sorted(set(found.values.ravel().tolist()) - set(allowed))
        if strange:
            yield f'{name} has the value "{strange[0]}"; allowed: {", ".join(allowed)}'


def _wrong_times(dataset: xarray.Dataset) -> Iterator[str]:
    time = dataset["time"].values
    for rate in np.unique(dataset["rate_hz"].values):
        if np.abs(time * rate - np.arange(time.size)).max() > 1e-6:
            yield f"time is not 0, 1/rate_hz, 2/rate_hz, … for rate_hz = {rate:g}"
    for duration in np.unique(dataset["duration_s"].values):
        if abs(time.size - duration * dataset["rate_hz"].values[0]) > 1e-6 * time.size:
            yield f"duration_s = {duration:g} does not fit {time.size} samples"
    if "shaft_angle" in dataset and not (np.diff(dataset["shaft_angle"].values, axis=1) > 0.0).all():
        yield "shaft_angle does not grow from sample to sample"


def _wrong_labels(dataset: xarray.Dataset) -> Iterator[str]:
    healthy = dataset["condition"].values == HEALTHY
    extended = dataset["condition"].values == "extended"
    relative = dataset["extent_spacing"].values
    low, high = dataset["envelope_band"].values.T
    unbanded, half_rate = np.isnan(low) & np.isnan(high), dataset["rate_hz"].values / 2.0
    tension = dataset["tension_share"].values
    rules = {
        "condition and location disagree": healthy != (dataset["location"].values == "none"),
        "condition and extent disagree": healthy != (dataset["extent"].values == 0.0),
        "condition and extent_spacing disagree": (extended != (relative >= EXTENDED_FROM)) & ~np.isnan(relative),
        "envelope_band is not below half the rate": ~(unbanded | ((low < high) & (high <= half_rate))),
        "tension_share is not a share": (tension < 0.0) | (tension > 1.0),
    }
    if "spalls" in dataset:
        rules["condition and spalls disagree"] = healthy != (dataset["spalls"].values == 0)
    for sentence, broken in rules.items():
        if broken.any():
            yield f"{sentence} in record {int(dataset['record'].values[broken][0])}"


def _wrong_tables(dataset: xarray.Dataset) -> Iterator[str]:
    record = dataset["record"].values
    if np.unique(record).size != record.size:
        yield "a record occurs twice"
    passes = dataset["pass_record"].values
    entry, deepest, leave = (dataset[f"{moment}_time"].values for moment in ("entry", "deepest", "exit"))
    release, regain = dataset["release_time"].values, dataset["regain_time"].values
    rules = {
        "a ball pass belongs to no record": ~np.isin(passes, record),
        "a ball pass is not in the order entry, deepest point, exit": ~((entry <= deepest) & (deepest <= leave)),
        "a release lies outside its pass": (release < entry) | (release > leave),
        "contact is regained before it is lost": regain < release,
        "load rises before it falls": dataset["rise_time"].values < dataset["fall_time"].values,
    }
    for sentence, broken in rules.items():
        if broken.any():
            yield f"{sentence} (row {int(np.flatnonzero(broken)[0])} of the pass table)"
    counts = Counter(dataset["defect_record"].values.tolist())
    if [counts[index] for index in record.tolist()] != dataset["spalls"].values.tolist():
        yield "the defect table and the label spalls disagree"
