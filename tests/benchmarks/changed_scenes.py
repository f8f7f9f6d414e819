"""Scenes far beyond what recipes draw: is the accuracy kept, are contacts timed, is the stiffness right?

PYTHONPATH=. python tests/benchmarks/changed_scenes.py [--scenes 1000] [--seed 20310401] writes docs/changed_scenes.json
and the table of docs/accuracy.md.

Scenes of five recipes are changed at random: load, speed, springs and dampers by up to the powers of ten below, another
clearance, no slip, the other contact law, other rates. Each is simulated as a user would, at an accuracy of 1e-3, and
held against fixed steps (own_choice.py says how); its stiffness is held against one solved at every instant.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.sampling import draw_scenario
from datagen.versions import in_words, measured_on
from docs.marked_tables import write_marked
from labels.truth import ball_passes
from physics.cage import CagePath
from physics.checks import InvalidParameter
from physics.outcome import SimulationFailed
from physics.rms import relative_error, rms
from physics.scene import Scene
from physics.simulate import simulate
from physics.statics.load_distribution import require_equilibrium
from physics.statics.stiffness_series import stiffness_series
from physics.trace import Trace
from physics.warming import warm_up
from tests.benchmarks.own_choice import ACCURACY, CERTAIN, judge

ROOT = Path(__file__).resolve().parents[2]
DATASETS = ("fan_rig", "gearbox_rig", "size_ladder", "corpus", "transfer")
DURATIONS, RATES = (0.1, 0.2), (12000.0, 25600.0, 48000.0, 65536.0, 102400.0)
# How often a quantity is changed, and by which powers of ten.
CHANGES = {
    "load": (0.4, -1.2, 1.0),
    "speed": (0.4, -0.7, 0.8),
    "film damping": (0.3, -1.5, 1.0),
    "resonator damping": (0.3, -1.5, 0.5),
    "support damping": (0.3, -1.5, 0.5),
    "resonator stiffness": (0.2, -1.0, 1.0),
    "support stiffness": (0.2, -1.0, 1.0),
}
CLEARED, CLEARANCE = 0.3, (-4e-6, 30e-6)  # m
STEADY, OTHER_LAW = 0.5, 0.3
TIMED_WITHIN = 1e-6  # s


def changed(scene: Scene, duration: float, rng: np.random.Generator) -> Scene:
    """The `scene` for `duration` (s), changed at random; raises InvalidParameter where that is impossible."""
    by = {
        what: 10.0 ** rng.uniform(low, high) if rng.random() < often else 1.0
        for what, (often, low, high) in CHANGES.items()
    }
    rig, run, cage = scene.rig, scene.operation, scene.cage
    bearing = replace(rig.bearing, clearance=rng.uniform(*CLEARANCE)) if rng.random() < CLEARED else rig.bearing
    speed = cage.nominal_speed * by["speed"]
    if rng.random() < STEADY or not cage.knot_values:
        cage = CagePath(speed, duration, cage.start_angle, cage.mean_slip)
    else:
        cage = replace(cage, nominal_speed=speed, duration=min(duration, cage.duration))
    other_law = "paper" if scene.contact_law == "no_tension" else "no_tension"
    return replace(
        scene,
        rig=replace(
            rig,
            bearing=bearing,
            film_damping=rig.film_damping * by["film damping"],
            resonator_damping=rig.resonator_damping * by["resonator damping"],
            resonator_stiffness=rig.resonator_stiffness * by["resonator stiffness"],
            support_damping_x=rig.support_damping_x * by["support damping"],
            support_damping_y=rig.support_damping_y * by["support damping"],
            support_stiffness_x=rig.support_stiffness_x * by["support stiffness"],
            support_stiffness_y=rig.support_stiffness_y * by["support stiffness"],
        ),
        operation=replace(run, load=run.load * by["load"], shaft_speed=run.shaft_speed * by["speed"]),
        cage=cage,
        second_cage=None,
        contact_law=other_law if rng.random() < OTHER_LAW else scene.contact_law,
    )


def scenes(count: int, seed: int) -> list[tuple[str, Scene, float]]:
    """Name, scene and rate (Hz) of as many changed scenes as there are among `count` draws."""
    rng = np.random.default_rng(seed)
    recipes = [load_recipe(ROOT / "datasets" / name).model_copy(update={"seed": seed}) for name in DATASETS]
    found = []
    for _ in range(count):
        recipe = recipes[rng.integers(len(recipes))]
        record, duration, rate = int(rng.integers(recipe.count)), rng.choice(DURATIONS), float(rng.choice(RATES))
        drawn = draw_scenario(recipe, record).scene
        try:
            found.append((f"{recipe.name} {record}", changed(drawn, float(duration), rng), rate))
        except InvalidParameter:
            continue
    return found


def timing(scene: Scene, trace: Trace, judged: Trace) -> dict[str, int]:
    """How many releases and regains both traces have, how many of these differ by more than TIMED_WITHIN, and how many
    only one has."""
    tables = [ball_passes(scene, one.changes, scene.duration) for one in (trace, judged)]
    own, exact = (np.concatenate([table.release_time, table.regain_time]) for table in tables)
    both = np.isfinite(own) & np.isfinite(exact)
    apart = np.abs(own[both] - exact[both])
    return {
        "events": int(both.sum()),
        "events_late": int((apart > TIMED_WITHIN).sum()),
        "events_of_one": int((np.isfinite(own) != np.isfinite(exact)).sum()),
    }


def stiffness_error(scene: Scene, rate: float) -> dict[str, float]:
    """RMS error of the worst component of the stiffness over the mean of kyy, and what is said of it."""
    count = round(scene.duration * rate)
    series = stiffness_series(scene, 1.0 / rate, count)
    solved = require_equilibrium(scene, np.arange(count) / rate).stiffness
    mean = float(solved[:, 1].mean())
    error = max(rms(series.stiffness[:, part] - solved[:, part]) for part in range(3)) / mean if mean > 0.0 else 0.0
    return {"stiffness_error": error, "stiffness_said": series.error}


def measure(scene: Scene, rate: float) -> dict[str, float]:
    """One scene's row."""
    trace = simulate(scene, rate)
    judged, apart = judge(scene, rate)
    return {
        "error": relative_error(trace.acceleration, judged.acceleration),
        "estimate": trace.error_estimate,
        "sensitivity": trace.sensitivity,
        "chaotic": trace.chaotic,
        "judge_apart": apart,
        **timing(scene, trace, judged),
        **stiffness_error(scene, rate),
    }


def summary(rows: dict[str, dict[str, float]]) -> dict[str, object]:
    """Counts and worst values; scenes that no two step sizes of the judge agree on are counted apart."""
    judged = {name: row for name, row in rows.items() if row["judge_apart"] <= CERTAIN * ACCURACY}
    missed = {name: row for name, row in judged.items() if row["error"] > ACCURACY}
    kept = {name: row for name, row in judged.items() if name not in missed}

    def of_kept(column: str) -> int:
        return sum(int(row[column]) for row in kept.values())

    return {
        "scenes": len(rows),
        "judged": len(judged),
        "missed": missed,
        "above_estimate": sum(row["error"] > row["estimate"] for row in judged.values()),
        "events": of_kept("events"),
        "events_late": of_kept("events_late"),
        "events_of_one": of_kept("events_of_one"),
        "stiffness_error": max(row["stiffness_error"] for row in rows.values()),
    }


def table(found: dict[str, object]) -> str:
    """The summary, as Markdown."""
    result: dict[str, object] = found["summary"]  # type: ignore[assignment]
    missed: dict[str, dict[str, float]] = result["missed"]  # type: ignore[assignment]
    failed: dict[str, str] = found["failed"]  # type: ignore[assignment]
    worst = ", ".join(f"{row['error']:.1e} (said {row['estimate']:.1e})" for row in missed.values())
    return "\n".join(
        [
            "| what | found |",
            "|---|---|",
            f"| scenes; refused; with a trajectory that could be settled | {result['scenes']}; {len(failed)}; "
            f"{result['judged']} |",
            f"| of these: wrong by more than 1e-3 | {len(missed)}{': ' + worst if worst else ''} |",
            f"| of these: wrong by more than was said | {result['above_estimate']} |",
            f"| releases and regains that both have; more than 1 µs apart; that only one has | {result['events']}; "
            f"{result['events_late']}; {result['events_of_one']} |",
            f"| worst error of the stiffness, over the mean of kyy | {result['stiffness_error']:.1e} |",
            "",
            f"Seed {found['seed']}. Measured on {in_words(found['made_with'])}.",  # type: ignore[arg-type]
        ]
    )


def main() -> None:
    """Measure every scene, and write the result where readers look."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=20310401)
    options = parser.parse_args()
    warm_up()
    rows, failed = {}, {}
    for place, (name, scene, rate) in enumerate(scenes(options.scenes, options.seed)):
        try:
            rows[f"{place}: {name}"] = measure(scene, rate)
        except SimulationFailed as problem:
            failed[f"{place}: {name}"] = str(problem)
        print(place, name, flush=True)
    found = {
        "seed": options.seed,
        "accuracy": ACCURACY,
        "made_with": measured_on("numpy", "scipy", "numba"),
        "failed": failed,
        "summary": summary(rows),
    }
    (ROOT / "docs" / "changed_scenes.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    write_marked(ROOT / "docs" / "accuracy.md", "changed scenes", __file__, table(found))


if __name__ == "__main__":
    main()
