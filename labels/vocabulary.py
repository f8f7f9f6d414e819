"""Our labels in the words of the PyPI package `bearing-datasets` (its schema 2): code for its sets runs on ours."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

FAULT_TYPE = {
    "none": "normal",
    "outer": "outer",
    "inner": "inner",
    "ball": "rolling_element",
    "cage": "cage",
    "several": "bearing",
    "unknown": "unknown",
}
SEVERITY = {"healthy": ("none", 0), "line": ("line", 1), "extended": ("extended", 2)}


@dataclass(frozen=True)
class Alias:
    """A column of the other vocabulary that holds the value of one of our labels times `factor`."""

    column: str
    label: str
    factor: float = 1.0


ALIASES: tuple[Alias, ...] = (
    Alias("recording_id", "record"),
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

CONSTANTS: dict[str, str] = {
    "sensor_location": "test_bearing",
    "sensor_mounting": "pedestal",
    "quantity": "acceleration",
    "unit": "m/s^2",
    "speed_profile": "constant",
    "load_unit": "N",
}


def common_row(labels: Mapping[str, Any], axis: str) -> dict[str, object]:
    """Columns of the common vocabulary for one axis ("x" or "y") of a generated record with these `labels`.

    Numbers keep the unit that the vocabulary gives them; KeyError if a label or one of its values is unknown.
    """
    row: dict[str, object] = dict(CONSTANTS)
    for alias in ALIASES:
        value = labels[alias.label]
        row[alias.column] = value * alias.factor if alias.factor != 1.0 else value
    severity, level = SEVERITY[str(labels["condition"])]
    healthy = labels["condition"] == "healthy"
    record = labels["record"]
    return row | {
        "recording_id": str(record),
        "signal_id": f"{record}_{axis}",
        "channel": axis,
        "axis": axis,
        "n_samples": round(labels["rate_hz"] * labels["duration_s"]),
        "native_label": "healthy" if healthy else f"{labels['condition']}_{labels['location']}",
        "fault_type": FAULT_TYPE[str(labels["location"])],
        "fault_location": "none" if healthy else "test_bearing",
        "sensor_at_fault": not healthy,
        "fault_origin": "none" if healthy else "artificial",
        "fault_severity": severity,
        "fault_severity_level": level,
    }
