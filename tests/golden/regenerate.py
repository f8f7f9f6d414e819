"""Our own pinned numbers: `python tests/golden/regenerate.py` writes records.json anew, `--dry-run` only compares.

They say that results have changed, not that they are right: whoever regenerates them says in the commit why they may.
"""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.record_rows import record_rows
from datagen.recipes.recipe import load_recipe
from datagen.records.record import Record, make_record
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from datagen.sizing.estimators import default_estimator
from datagen.sizing.stated_situation import situation_of
from labels.features.table import FEATURE_NAMES

FILE = Path(__file__).with_name("records.json")
RECORDS = (("quickstart", 0), ("quickstart", 46), ("corpus", 6))
JUDGED = ("quickstart", 0)
FIRST = 3
# (relative, absolute), by the first word of a name. Responses are promised to 1e-3, on both sides of a comparison;
# times are held to half a sample at 65 536 Hz. Features are logarithms or shares, a hundredth of which is nothing.
TOLERANCES = {
    "rms_m_s2": (2e-3, 0.0),
    "tension_share": (2e-3, 2e-5),
    "release_s": (0.0, 8e-6),
    "regain_s": (0.0, 8e-6),
    "mean_stiffness": (2e-3, 2e2),
    "features": (2e-3, 1e-2),
    "size": (1e-2, 0.0),
}


def scenario_of(dataset: str, record: int) -> Scenario:
    """The scenario of one record of a dataset that comes with spallgen."""
    return draw_scenario(load_recipe(dataset), record)


def response(made: Record) -> dict[str, float]:
    """Level, contact and stiffness of a record, SI units, and its first events."""
    lost = np.isfinite(made.passes.release_time) & np.isfinite(made.passes.regain_time)
    events = {
        f"{name}_s {k}": float(times[lost][k])
        for name, times in (("release", made.passes.release_time), ("regain", made.passes.regain_time))
        for k in range(min(FIRST, int(lost.sum())))
    }
    level = np.sqrt(np.mean(np.square(made.acceleration, dtype=np.float64), axis=0))
    stiffness = made.stiffness.mean(axis=1, dtype=np.float64)
    return {
        **{f"rms_m_s2 {axis}": float(value) for axis, value in zip("xy", level, strict=True)},
        "tension_share": float(made.labels["tension_share"]),
        **{f"mean_stiffness {entry}": float(value) for entry, value in zip(("xx", "yy", "xy"), stiffness, strict=True)},
        **events,
    }


def judgement(scenario: Scenario, made: Record) -> dict[str, float]:
    """The feature row of the y axis of a record, and the size that the estimator tells of it (s, rad, mm)."""
    rows = record_rows(made.acceleration, pandas.Series(made.labels), Reading()).rows
    bearing = scenario.scene.rig.bearing
    situation = situation_of(made.labels, (bearing.load_deflection, bearing.exponent))
    estimate = default_estimator().estimate(made.acceleration.astype(np.float64), scenario.rate, situation)
    features = zip(FEATURE_NAMES, rows[1].values.tolist(), strict=True)
    sizes = {"lag": estimate.lag, "extent": estimate.extent, "extent_mm": estimate.extent_mm, "trust": estimate.trust}
    return {f"features {name}": value for name, value in features} | {f"size {n}": v for n, v in sizes.items()}


def numbers(relative: float | None = None) -> dict[str, dict[str, float]]:
    """Every pinned number by record and name; `relative`: another accuracy than the recipe's."""
    found = {}
    for dataset, record in RECORDS:
        scenario = scenario_of(dataset, record)
        if relative is not None:
            scenario = replace(scenario, accuracy=replace(scenario.accuracy, relative=relative))
        made = make_record(scenario)
        found[f"{dataset} {record}"] = response(made)
        if (dataset, record) == JUDGED:
            found[f"{dataset} {record}"] |= judgement(scenario, made)
    return found


def differences(pinned: dict[str, dict[str, float]], found: dict[str, dict[str, float]]) -> list[str]:
    """A sentence for each number that is missing, new, or beyond its tolerance."""
    said = []
    for record in sorted(pinned | found):
        own, other = pinned.get(record, {}), found.get(record, {})
        for name in sorted(own | other):
            if name not in own or name not in other:
                said.append(f"{record}: {name} is {'no longer made' if name in own else 'not pinned'}")
            elif not _near(name, own[name], other[name]):
                said.append(f"{record}: {name} is {other[name]:.6g}, pinned is {own[name]:.6g}")
    return said


def _near(name: str, pinned: float, found: float) -> bool:
    relative, absolute = TOLERANCES[name.split()[0]]
    return math.isclose(pinned, found, rel_tol=relative, abs_tol=absolute)


def rounded(found: dict[str, dict[str, float]]) -> dict[str, dict[str, float]]:
    """To six digits: far below every tolerance, and the same on every machine for all but a few last digits."""
    return {record: {name: float(f"{value:.6g}") for name, value in own.items()} for record, own in found.items()}


def main(arguments: list[str] | None = None, file: Path = FILE) -> int:
    """Write the numbers, or with --dry-run tell what differs: 1 if anything does."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dry-run", action="store_true", help="compare only")
    asked: Any = parser.parse_args(arguments)
    found = numbers()
    pinned = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    said = differences(pinned, found)
    for sentence in said:
        print(sentence)
    if asked.dry_run:
        return int(bool(said))
    file.write_text(json.dumps(rounded(found), indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
