"""Does the program keep the accuracy asked for by itself, and what does that cost beside the best choice in hindsight?

python tests/benchmarks/own_choice.py [--scenes 300] [--seed 777001] [--seconds 0.1] [--dataset corpus]
    [--out docs/own_choice.json]

Scenes are drawn at random from the whole recipe of a dataset under a seed that nothing was tuned with. Each is
simulated as a user would, at an accuracy of 1e-3, and held against an independent method, fixed steps of the
exponential Runge-Kutta method with every change located, 32 a sample and, where that is not enough to judge by, 128.
Where even these two disagree no trajectory converges, and the scene is counted apart, whatever the program calls it; a
scene that the program calls chaotic and that converges has missed the accuracy. The rivals in hindsight are settings of
`spallgen chart` on every n-th scene, of which the cheapest that kept the accuracy counts, fixed steps without a pilot.
The same once more at the accuracy that the recipe itself asks for, which it ties to the record's noise.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NotRequired, TypedDict

import numpy as np
from numpy.typing import NDArray

from datagen.charts.contestants import ACCURACIES, SUBSTEPS
from datagen.freed_memory import keep_freed_memory
from datagen.recipes.recipe import load_recipe
from datagen.scenarios.allowed_error import allowed_error
from datagen.scenarios.sampling import draw_scenario
from datagen.versions import measured_on
from physics.cage import CagePath
from physics.outcome import SimulationFailed
from physics.request import Accurate, FixedSteps, Solution
from physics.rms import relative_error, rms
from physics.scene import Scene
from physics.simulate import simulate
from physics.trace import Trace
from physics.warming import warm_up

ROOT = Path(__file__).resolve().parents[2]
ACCURACY = 1e-3
JUDGING_SUBSTEPS = (32, 128)
# A judge that two step sizes of its own method tell apart by less than this share of the accuracy is good enough.
CERTAIN = 0.2
THIRD_OCTAVES = 2.0 ** (np.arange(-12, 13) / 3.0) * 1000.0
CHEAP_METHODS = ("exponential_rk4", "exponential_adams4", "runge_kutta4", "dormand_prince")
Array = NDArray[np.float64]


class Row(TypedDict):
    """What is found about one scene; `best` and `best_seconds` where rivals in hindsight kept the accuracy."""

    seconds: float
    error: float
    estimate: float
    spalls: int
    sensitivity: float
    chaotic: bool
    judge_apart: float
    changes: int
    spectra_apart_db: float
    own_error_over_allowed: float
    best: NotRequired[str]
    best_seconds: NotRequired[float]


def timed(run: Callable[[], Trace]) -> tuple[float, Array]:
    """Processor time (s), the better of two, and the acceleration."""
    seconds = []
    for _ in range(2):
        begin = time.process_time()
        result = run()
        seconds.append(time.process_time() - begin)
    return min(seconds), result.acceleration


def shortened(scene: Scene, seconds: float) -> Scene:
    """Its first `seconds`."""

    def cut(cage: CagePath) -> CagePath:
        return replace(cage, duration=min(cage.duration, seconds))

    return replace(scene, cage=cut(scene.cage), second_cage=scene.second_cage and cut(scene.second_cage))


def judge(scene: Scene, rate: float) -> tuple[Trace, float]:
    """The response by fixed steps, and how far (relative RMS) the accelerations of two step sizes are apart."""
    coarse, fine = (
        simulate(scene, rate, FixedSteps(count)) for count in (JUDGING_SUBSTEPS[0] // 2, JUDGING_SUBSTEPS[0])
    )
    last = fine
    apart = relative_error(coarse.acceleration, fine.acceleration)
    if apart > CERTAIN * ACCURACY:
        last = simulate(scene, rate, FixedSteps(JUDGING_SUBSTEPS[1]))
        apart = relative_error(fine.acceleration, last.acceleration)
    return last, apart


def rivals(scene: Scene, rate: float, exact: Array) -> dict[str, float]:
    """Processor time (s) of every setting of the chart that keeps the accuracy."""
    settings: dict[str, Solution] = {
        f"modal {accuracy:g}": Accurate(accuracy, path_fineness=1) for accuracy in ACCURACIES
    }
    for method in CHEAP_METHODS:
        for count in SUBSTEPS[method]:
            settings[f"{method} {count}"] = FixedSteps(count, method)
    kept = {}
    for name, setting in settings.items():
        try:
            seconds, found = timed(partial(simulate, scene, rate, setting))
        except SimulationFailed:
            continue
        if relative_error(found, exact) <= ACCURACY:
            kept[name] = seconds
    return kept


def spectral_difference(one: Array, other: Array, rate: float) -> float:
    """Median over third octaves of the difference (dB) of two signals' power, both axes together."""
    frequency = np.fft.rfftfreq(one.shape[0], 1.0 / rate)
    powers = [np.sum(np.abs(np.fft.rfft(signal, axis=0)) ** 2, axis=1) for signal in (one, other)]
    band = np.digitize(frequency, THIRD_OCTAVES)
    sums = np.array([np.bincount(band, power, THIRD_OCTAVES.size + 1)[1:-1] for power in powers])
    used = sums.min(axis=0) > 0.0
    return float(np.median(np.abs(10.0 * np.log10(sums[0, used] / sums[1, used]))))


def measure(scene: Scene, rate: float, allowed: tuple[float, float], hindsight: bool) -> Row:
    """One scene's row; `allowed` is the accuracy and the error (m/s²) that its recipe asks for."""
    trace = simulate(scene, rate, Accurate(ACCURACY))
    seconds, _ = timed(partial(simulate, scene, rate, Accurate(ACCURACY)))
    judged, apart = judge(scene, rate)
    exact = judged.acceleration
    accuracy, least = allowed
    own = simulate(scene, rate, Accurate(accuracy, least_error=least))
    row: Row = {
        "seconds": seconds,
        "error": relative_error(trace.acceleration, exact),
        "estimate": trace.error_estimate,
        "spalls": len(scene.spalls),
        "sensitivity": trace.sensitivity,
        "chaotic": trace.chaotic,
        "judge_apart": apart,
        "changes": int(trace.changes.time.size),
        "spectra_apart_db": spectral_difference(trace.acceleration, exact, rate),
        "own_error_over_allowed": rms(own.acceleration - exact) / max(accuracy * rms(exact), least),
    }
    kept = rivals(scene, rate, exact) if hindsight and apart <= CERTAIN * ACCURACY else {}
    if kept:
        best = min(kept, key=lambda name: kept[name])
        row["best"], row["best_seconds"] = best, kept[best]
    return row


def summary(rows: dict[str, Row]) -> dict[str, object]:
    """Shares and ratios over all scenes, None where there are none to take them of.

    Scenes that no two step sizes of the judge agree on are counted apart.
    """
    judged = [row for row in rows.values() if row["judge_apart"] <= CERTAIN * ACCURACY]
    unsettled = [row for row in rows.values() if row["judge_apart"] > CERTAIN * ACCURACY]
    rivalled = [row for row in judged if "best" in row]
    return {
        "scenes": len(rows),
        "unsettled": len(unsettled),
        "unsettled_called_chaotic": sum(bool(row["chaotic"]) for row in unsettled),
        "unsettled_spectra_apart_db": max((float(row["spectra_apart_db"]) for row in unsettled), default=None),
        "judged": len(judged),
        "judged_called_chaotic": sum(bool(row["chaotic"]) for row in judged),
        "own_accuracy_kept": sum(row["own_error_over_allowed"] <= 1.0 for row in judged),
        "rivalled": len(rivalled),
        "kept_the_accuracy": sum(row["error"] <= ACCURACY for row in judged),
        "share_kept": float(np.mean([row["error"] <= ACCURACY for row in judged])) if judged else None,
        "worst_error": max((row["error"] for row in judged), default=None),
        "error_over_estimate": [
            float(q) for q in np.quantile([row["error"] / row["estimate"] for row in judged], (0.05, 0.5, 0.95))
        ]
        if judged
        else None,
        "cost_over_hindsight": sum(row["seconds"] for row in rivalled) / sum(row["best_seconds"] for row in rivalled)
        if rivalled
        else None,
        "in_hindsight": {
            name: sum(row["best"] == name for row in rivalled) for name in sorted({row["best"] for row in rivalled})
        },
    }


def main() -> None:
    """Measure every scene and write the result after each, so that a run that is cut short is not lost."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--seed", type=int, default=777001)
    parser.add_argument("--seconds", type=float, default=0.1, help="length of each scene")
    parser.add_argument("--dataset", default="corpus")
    parser.add_argument("--hindsight", type=int, default=1, help="rival settings on every n-th scene; 0: none")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "own_choice.json")
    options = parser.parse_args()
    keep_freed_memory()  # as where records are made
    warm_up()
    recipe = load_recipe(ROOT / "datasets" / options.dataset).model_copy(update={"seed": options.seed})
    # At random: the parts and machines of a corpus take turns, so that every n-th record may be of one kind.
    records = np.random.default_rng(options.seed).choice(recipe.count, options.scenes, replace=False)
    rows: dict[str, Row] = {}
    for place, record in enumerate(records.tolist()):
        scenario = draw_scenario(recipe, record)
        hindsight = options.hindsight > 0 and place % options.hindsight == 0
        scene, allowed = shortened(scenario.scene, options.seconds), allowed_error(scenario)
        rows[str(record)] = measure(scene, scenario.rate, allowed, hindsight)
        report = {
            "recipe": options.dataset,
            "seed": options.seed,
            "accuracy": ACCURACY,
            "seconds_a_scene": options.seconds,
            "made_with": measured_on("numpy", "scipy", "numba"),
            "summary": summary(rows),
            "rows": rows,
        }
        options.out.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
        print(record, json.dumps(rows[str(record)]), flush=True)
    print(json.dumps(report["summary"], indent=1))


if __name__ == "__main__":
    main()
