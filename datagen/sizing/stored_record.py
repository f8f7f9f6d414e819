"""What a shard holds of one record, and where, by its ball passes, the events of the spall are."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from labels.spall_size.event_truth import EventTruth, event_truth
from physics.angular_speed import RPM_PER_HZ
from physics.arrays import Array

PASS_COLUMNS = ("exit_time", "release_time", "regain_time", "fall_time", "rise_time")
LATEST_REGAIN_SPACINGS = 0.5  # behind the exit


@dataclass(frozen=True)
class StoredRecord:
    """What a shard holds of a record: `acceleration` and the `clean` one (T, axes), and whether it is `simulated`.

    `text` is the JSON that says how it came about ("" if there is none); `passes` are PASS_COLUMNS of its ball passes
    by name, if any are known; `speed_changes` where the angle of its shaft is stored.
    """

    acceleration: Array
    clean: Array | None
    simulated: bool
    text: str
    passes: dict[str, Array] | None
    speed_changes: bool = False

    def contact_stiffness(self) -> tuple[float, float] | None:
        """Hertz factor and exponent from the scenario or the provenance; None if neither holds them."""
        try:
            parameters = json.loads(self.text)["parameters"]
            return float(parameters["K"]), float(parameters["n"])
        except (KeyError, TypeError, ValueError):
            return None

    def truth(self, labels: Mapping[str, Any]) -> EventTruth | None:
        """The events of the spall of a record with these `labels`; None if its ball passes are not known."""
        if self.passes is None:
            return None
        return event_truth(
            release=self.passes["release_time"],
            regain=self.passes["regain_time"],
            fall=self.passes["fall_time"],
            rise=self.passes["rise_time"],
            latest=self.passes["exit_time"] + LATEST_REGAIN_SPACINGS * nominal_period(labels),
        )


def stored_record(file: Any, position: int, record: int) -> StoredRecord:
    """What an open shard's `file` holds at this `position`, with the ball passes of this `record`."""
    clean, simulated = file.variables.get("acceleration_clean"), "scenario" in file.variables
    text = file.variables.get("scenario" if simulated else "provenance")
    passes = None
    if set(PASS_COLUMNS) <= set(file.variables):
        of_record = np.flatnonzero(np.asarray(file.variables["pass_record"][:]) == record)
        passes = {name: np.asarray(file.variables[name][:], dtype=np.float64)[of_record] for name in PASS_COLUMNS}
    return StoredRecord(
        acceleration=np.asarray(file.variables["acceleration"][position], dtype=np.float64),
        clean=None if clean is None else np.asarray(clean[position], dtype=np.float64),
        simulated=simulated,
        text="" if text is None else str(text[position]),
        passes=passes,
        speed_changes="shaft_angle" in file.variables,
    )


def nominal_period(labels: Mapping[str, Any]) -> float:
    """Time between two ball passes over the spall without slip, s; over the outer race if there is no spall."""
    order = {"outer": "bpfo", "inner": "bpfi"}.get(str(labels["location"]), "bpfo")
    return RPM_PER_HZ / (float(labels["speed_rpm"]) * float(labels[order]))
