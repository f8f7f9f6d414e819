"""Error and real-time factor of every reference scene, against a finer run and beside SciPy's DOP853 in the same run.

python tests/benchmarks/reference_scenes.py [--rounds 5] writes docs/reference_scenes.json and the table in README.md.
"""

from __future__ import annotations

import argparse
import json
import platform
import statistics
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.sampling import draw_scenario
from physics.simulate import simulate, warm_up

ROOT = Path(__file__).resolve().parents[2]
RATE = 65536.0
SCORED_FROM = 0.1
FINER_SUBSTEPS = 16
RIVAL_SCENES = ("G1", "F1")
RIVAL_DURATION = 0.05
LONG_DURATION = 5.0
BEGIN = "<!-- reference scenes: begin (written by tests/benchmarks/reference_scenes.py) -->"
END = "<!-- reference scenes: end -->"


def reference_scenes(seconds: float | None = None) -> dict[str, object]:
    """The reference scenes by name, read from the recipes of the two rigs; of the rough ones the first draw.

    Of the recipes' length, or of `seconds`.
    """
    scenes = {}
    for dataset, letter in (("gearbox_rig", "G"), ("fan_rig", "F")):
        recipe = load_recipe(ROOT / "datasets" / dataset)
        if seconds is not None:
            signal = recipe.signal.model_dump() | {"duration_s": seconds}
            recipe = recipe.model_copy(update={"signal": type(recipe.signal).model_validate(signal)})
        record = 0
        while (scenario := draw_scenario(recipe, record)).part.startswith(letter):
            scenes.setdefault(scenario.part, scenario.scene)
            record += 1
    return scenes


def rms(values: np.ndarray) -> float:
    """Root mean square over all entries."""
    return float(np.sqrt(np.mean(np.square(values))))


def timed(scene: object, rounds: int) -> tuple[object, float]:
    """The response, and the real-time factor of the whole call: choice of tolerance, kinks, start and march."""
    simulate(scene, RATE)
    seconds = []
    for _ in range(rounds):
        begin = time.process_time()
        trace = simulate(scene, RATE)
        seconds.append(time.process_time() - begin)
    return trace, scene.duration / statistics.median(seconds)


def measure(scene: object, long_scene: object, rounds: int) -> dict[str, float]:
    """Relative RMS error, the program's own estimate of it, mean step and real-time factors (medians of rounds)."""
    finer = simulate(scene, RATE, substeps=FINER_SUBSTEPS, estimate_error=False)
    trace, factor = timed(scene, rounds)
    scored = trace.time >= SCORED_FROM
    error = rms((trace.acceleration - finer.acceleration)[scored]) / rms(finer.acceleration[scored])
    return {
        "error": error,
        "estimate": trace.error_estimate,
        "samples_per_step": trace.step * RATE,
        "real_time_factor": factor,
        "long_real_time_factor": timed(long_scene, rounds)[1],
    }


def measure_rival(scene: object) -> float:
    """Real-time factor of the package's slow reference: SciPy's DOP853 with located events, rtol 1e-9."""
    from dataclasses import replace

    short = replace(scene, cage=replace(scene.cage, duration=RIVAL_DURATION))
    simulate(short, RATE, method="reference")
    begin = time.process_time()
    simulate(short, RATE, method="reference")
    return RIVAL_DURATION / (time.process_time() - begin)


def table(results: dict[str, dict[str, float]], rivals: dict[str, float], machine: str) -> str:
    """Markdown of the results."""
    lines = ["| scene | RMS error | its estimate | samples a step, mean | times real time, one core | of 5 s |"]
    lines.append("|---|---|---|---|---|---|")
    for name, row in results.items():
        lines.append(
            f"| {name} | {row['error']:.1e} | {row['estimate']:.1e} | {row['samples_per_step']:.1f} "
            f"| {row['real_time_factor']:.0f} | {row['long_real_time_factor']:.0f} |"
        )
    rival = ", ".join(f"{factor:.3f} on {name}" for name, factor in rivals.items())
    return "\n".join(
        [
            *lines,
            "",
            "The accuracy asked for is 1e-3. Error: resonator acceleration against fixed steps, "
            f"{FINER_SUBSTEPS} a sample, relative, from {SCORED_FROM} s, at 65 536 Hz; records of 0.5 s, and of "
            f"{LONG_DURATION:.0f} s in the last column; times are of the processor. SciPy's DOP853 at a relative "
            "tolerance of 1e-9 on a compiled "
            f"right-hand side, with events located, runs at {rival} times real time in the same run. {machine}",
        ]
    )


def main() -> None:
    """Measure, and write the figures where readers look."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    warm_up()
    scenes, long_scenes = reference_scenes(), reference_scenes(LONG_DURATION)
    results = {name: measure(scene, long_scenes[name], rounds) for name, scene in scenes.items()}
    rivals = {name: measure_rival(scenes[name]) for name in RIVAL_SCENES}
    versions = {name: version(name) for name in ("numpy", "scipy", "numba")}
    machine = f"{platform.machine()}, Python {platform.python_version()}, " + ", ".join(
        f"{name} {number}" for name, number in versions.items()
    )
    facts = {"machine": machine, "rounds": rounds, "scenes": results, "rival_real_time_factor": rivals}
    (ROOT / "docs" / "reference_scenes.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    new = table(results, rivals, f"Measured on {machine}.")
    readme.write_text(f"{before}{BEGIN}\n{new}\n{END}{after}", encoding="utf-8")
    print(new)


if __name__ == "__main__":
    main()
