"""What follows from the recipes alone: `python datasets/make_expected.py [NAME ...]` writes each expected.json anew.

Every scenario of a dataset is drawn and none is simulated. A corpus has these counts and quantiles, or was made of
another recipe.
"""

from __future__ import annotations

import json
import math
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from datagen.recipes.recipe import Recipe, load_recipe
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from labels.description import largest_spall

FOLDER = Path(__file__).parent
FILE_NAME = "expected.json"
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)


def expected(recipe: Recipe) -> dict[str, Any]:
    """Counts of records and machines, and quantiles of what was drawn; those of sizes are of records with a spall."""
    drawn = [draw_scenario(recipe, record) for record in range(recipe.count)]
    return {
        "recipe_hash": recipe.hash,
        "records": len(drawn),
        "bearings": len({one.bearing_id for one in drawn}),
        "condition": _counts(one.condition for one in drawn),
        "location": _counts(one.location for one in drawn),
        "split": _counts(one.split for one in drawn),
        "speed_rpm": _quantiles([one.scene.operation.shaft_speed * 30.0 / math.pi for one in drawn]),
        "load_n": _quantiles([one.scene.operation.load for one in drawn]),
        "extent_mm": _quantiles([size for one in drawn if (size := _extent_mm(one)) is not None]),
        "snr_target_db": _quantiles([one.noise_target.ratio_db for one in drawn if one.noise_target is not None]),
    }


def _counts(names: Any) -> dict[str, int]:
    return dict(sorted(Counter(names).items()))


def _extent_mm(scenario: Scenario) -> float | None:
    spall = largest_spall(scenario.scene)
    return None if spall is None else spall.length(scenario.scene.rig.bearing) * 1e3


def _quantiles(values: list[float]) -> dict[str, float] | None:
    """By share of the values, to eight digits, which no rounding of a logarithm reaches; None without values."""
    if not values:
        return None
    found = np.quantile(values, SHARES)
    return {f"{share:g}": float(f"{value:.8g}") for share, value in zip(SHARES, found, strict=True)}


def main(names: list[str]) -> None:
    """Write the file of each dataset named, of all if none is."""
    for name in names or sorted(path.parent.name for path in FOLDER.glob("*/recipe.toml")):
        text = json.dumps(expected(load_recipe(FOLDER / name)), indent=1)
        (FOLDER / name / FILE_NAME).write_text(text + "\n", encoding="utf-8")
        print(f"{name}: {FILE_NAME} is written")


if __name__ == "__main__":
    main(sys.argv[1:])
