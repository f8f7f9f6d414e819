"""The records of a corpus as a size estimator sees them, with the truth to score it by where there is one."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.corpora.index import read_index
from datagen.scenarios.streams import stream
from labels.spall_size.event_truth import EventTruth, event_truth
from labels.spall_size.situation import Situation

Array = NDArray[np.float64]
PASS_COLUMNS = ("exit_time", "release_time", "regain_time", "fall_time", "rise_time")
SPEED_ERROR = 0.02
LATEST_REGAIN_SPACINGS = 0.5  # behind the exit
NEEDED = ("balls", "pitch_diameter", "ball_diameter", "speed_rpm", "rate_hz")


@dataclass(frozen=True)
class SizedRecord:
    """One record: `acceleration` (T, 2), the clean one or None, its labels, what may be told of the machine, the truth.

    `truth` is None for recordings whose ball passes are unknown.
    """

    record: int
    rate: float
    acceleration: Array
    clean: Array | None
    labels: dict[str, Any]
    situation: Situation
    truth: EventTruth | None


def sized_records(
    folder: Path, *, load_known: bool, splits: tuple[str, ...] | None = None, seed: int = 0
) -> Iterator[SizedRecord]:
    """The records of a corpus whose geometry and speed are known, in order, one in memory at a time.

    The stated shaft speed is wrong by up to ±2 %, drawn from `seed`, so that no estimator may lean on it.
    """
    import netCDF4

    table = read_index(folder)
    chosen = table if splits is None else table[table["split"].isin(splits)]
    chosen = chosen[np.array([_geometry_known(labels) for labels in chosen.to_dict("records")], dtype=np.bool_)]
    for shard, rows in chosen.groupby("shard", sort=True):
        with netCDF4.Dataset(folder / str(shard)) as file:
            file.set_auto_mask(False)
            for labels in rows.to_dict("records"):
                yield _read(file, {str(key): value for key, value in labels.items()}, load_known, seed)


def _geometry_known(labels: Mapping[Any, Any]) -> bool:
    return all(math.isfinite(float(labels.get(name, math.nan))) for name in NEEDED)


def _read(file: Any, labels: dict[str, Any], load_known: bool, seed: int) -> SizedRecord:
    position, record = int(labels["position"]), int(labels["record"])
    clean = file.variables.get("acceleration_clean")
    return SizedRecord(
        record=record,
        rate=float(labels["rate_hz"]),
        acceleration=np.asarray(file.variables["acceleration"][position], dtype=np.float64),
        clean=None if clean is None else np.asarray(clean[position], dtype=np.float64),
        labels=labels,
        situation=replace(
            situation_of(labels, _stiffness(file, position) if load_known else None, record, seed),
            polarity_known="scenario" in file.variables,  # where a sensor looked is not told with a recording
        ),
        truth=_truth(file, record, labels),
    )


def situation_of(labels: dict[str, Any], contact: tuple[float, float] | None, record: int, seed: int) -> Situation:
    """What an estimator is told: geometry, roughly the speed, and with `contact` (K, n) the load; never the race."""
    wrong = 1.0 + SPEED_ERROR * (2.0 * float(stream(seed, "record", record, "operation").random()) - 1.0)
    speed = float(labels["speed_rpm"]) * 2.0 * math.pi / 60.0
    load = float(labels.get("load_n", math.nan))
    known = contact is not None and math.isfinite(load) and load >= 0.0
    return Situation(
        balls=int(labels["balls"]),
        rows=int(labels["rows"]) if math.isfinite(float(labels.get("rows", 1))) else 1,
        pitch_diameter=float(labels["pitch_diameter"]),
        ball_diameter=float(labels["ball_diameter"]),
        shaft_speed=speed * wrong,
        contact_angle=float(labels["contact_angle"]) if math.isfinite(float(labels["contact_angle"])) else 0.0,
        load=load if known else None,
        load_deflection=contact[0] if known and contact else None,
        exponent=contact[1] if known and contact else 1.5,
    )


def _stiffness(file: Any, position: int) -> tuple[float, float] | None:
    """Hertz factor and exponent from the scenario; None for a recording, which has none."""
    if "scenario" not in file.variables:
        return None
    try:
        parameters = json.loads(str(file.variables["scenario"][position]))["parameters"]
        return float(parameters["K"]), float(parameters["n"])
    except (KeyError, TypeError, ValueError):
        return None


def nominal_period(labels: Mapping[str, Any]) -> float:
    """Time between two ball passes without slip, s; of the outer race if there is no spall."""
    order = {"outer": "bpfo", "inner": "bpfi"}.get(str(labels["location"]), "bpfo")
    return 60.0 / (float(labels["speed_rpm"]) * float(labels[order]))


def _truth(file: Any, record: int, labels: Mapping[str, Any]) -> EventTruth | None:
    if not set(PASS_COLUMNS) <= set(file.variables):
        return None
    own = np.flatnonzero(np.asarray(file.variables["pass_record"][:]) == record)
    leave, release, regain, fall, rise = (
        np.asarray(file.variables[name][:], dtype=np.float64)[own] for name in PASS_COLUMNS
    )
    return event_truth(release, regain, fall, rise, leave + LATEST_REGAIN_SPACINGS * nominal_period(labels))
