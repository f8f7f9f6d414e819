"""Our labels in the words of the PyPI package `bearing-datasets` (its schema 2): code for its sets runs on ours."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from labels.schema import HEALTHY, MEASURED, UNKNOWN

FAULT_TYPE = {
    "none": "normal",
    "outer": "outer",
    "inner": "inner",
    "ball": "rolling_element",
    "cage": "cage",
    "several": "bearing",
    UNKNOWN: "unknown",
}
SEVERITY = {HEALTHY: ("none", 0), "line": ("line", 1), "extended": ("extended", 2), UNKNOWN: ("not graded", 1)}


@dataclass(frozen=True)
class Alias:
    """A column of the other vocabulary that holds the value of one of our labels times `factor`."""

    column: str
    label: str
    factor: float = 1.0


ALIASES: tuple[Alias, ...] = (
    Alias("fs", "rate_hz"),
    Alias("speed_rpm", "speed_rpm"),
    Alias("load", "load_n"),
    Alias("fault_size_mm", "extent_mm"),
    Alias("defect_depth_um", "depth", 1e6),
    Alias("defect_length_deg", "extent", math.degrees(1.0)),
    Alias("bearing_id", "bearing_id"),
    Alias("bearing_model", "bearing"),
    Alias("bpfo", "bpfo"),
    Alias("bpfi", "bpfi"),
    Alias("bsf", "bsf"),
    Alias("ftf", "ftf"),
)

CONSTANTS: dict[str, object] = {
    "sensor_location": "test_bearing",
    "sensor_mounting": "pedestal",
    "quantity": "acceleration",
    "unit": "m/s^2",
    "speed_profile": "constant",
    "load_unit": "N",
}
UNKNOWN_OF_A_RECORDING: dict[str, object] = {"sensor_mounting": "unknown", "speed_profile": "unknown"}


def common_row(labels: Mapping[str, Any], axis: str) -> dict[str, object]:
    """Columns of the common vocabulary for one axis ("x" or "y") of a record with these `labels`.

    Numbers keep the unit that the vocabulary gives them; KeyError if a label or one of its values is unknown.
    """
    measured = labels["model"] == MEASURED
    name = labels["recording"] or str(labels["record"])
    row: dict[str, object] = CONSTANTS | (UNKNOWN_OF_A_RECORDING if measured else {}) | {"recording_id": name}
    for alias in ALIASES:
        value = labels[alias.label]
        row[alias.column] = value * alias.factor if alias.factor != 1.0 else value
    severity, level = SEVERITY[str(labels["condition"])]
    healthy = labels["condition"] == HEALTHY
    place = "none" if healthy else "unknown" if labels["location"] == UNKNOWN else "test_bearing"
    return row | {
        "signal_id": f"{name}_{axis}",
        "channel": labels["channel"] or axis,
        "axis": axis,
        "n_samples": round(labels["rate_hz"] * labels["duration_s"]),
        "native_label": HEALTHY if healthy else f"{labels['condition']}_{labels['location']}",
        "fault_type": FAULT_TYPE[str(labels["location"])],
        "fault_location": place,
        "sensor_at_fault": place == "test_bearing",
        "fault_origin": "none" if healthy else "unknown" if measured else "artificial",
        "fault_severity": severity,
        "fault_severity_level": level,
    }
