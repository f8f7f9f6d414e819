"""Error and real-time factor of every reference scene, against a finer run and beside SciPy's DOP853 in the same run.

PYTHONPATH=. python tests/benchmarks/reference_scenes.py [--rounds 5] writes docs/reference_scenes.json and the table in
README.md.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Collection
from pathlib import Path

from datagen.freed_memory import keep_freed_memory
from datagen.versions import in_words, measured_on
from docs.marked_tables import write_marked
from physics.reference_scenes import REFERENCE_SCENES, reference_scene
from physics.request import FixedSteps, Reference
from physics.response.periodic import REPEATED
from physics.rms import relative_error
from physics.scene import Scene
from physics.simulate import simulate
from physics.trace import Trace
from physics.warming import warm_up

ROOT = Path(__file__).resolve().parents[2]
RATE = 65536.0
SCORED_FROM = 0.1
FINER_SUBSTEPS = 16
RIVAL_SCENES = ("G1", "F1")
RIVAL_DURATION = 0.05
DURATION, LONG_DURATION = 0.5, 5.0
SLIP_SEED = 1


def timed(scene: Scene, rounds: int) -> tuple[Trace, float]:
    """The response, and the real-time factor of the whole call: choice of tolerance, kinks, start and march."""
    trace = simulate(scene, RATE)
    seconds = []
    for _ in range(rounds):
        begin = time.process_time()
        trace = simulate(scene, RATE)
        seconds.append(time.process_time() - begin)
    return trace, scene.duration / statistics.median(seconds)


def measure(name: str, rounds: int) -> dict[str, float]:
    """Relative RMS errors, the program's own estimates of them, mean step and real-time factors (medians of rounds).

    Of the scene as it is defined, which does not slip, and of the same with slip.
    """
    return {
        f"{prefix}{key}": value
        for prefix, seed in (("", None), ("slip_", SLIP_SEED))
        for key, value in _measured(name, seed, rounds).items()
    }


def _measured(name: str, slip_seed: int | None, rounds: int) -> dict[str, float]:
    scene, long_scene = (reference_scene(name, seconds, slip_seed=slip_seed) for seconds in (DURATION, LONG_DURATION))
    finer = simulate(scene, RATE, FixedSteps(FINER_SUBSTEPS))
    trace, factor = timed(scene, rounds)
    long_trace, long_factor = timed(long_scene, rounds)
    scored = trace.time >= SCORED_FROM
    return {
        "error": relative_error(trace.acceleration[scored], finer.acceleration[scored]),
        "estimate": trace.error_estimate,
        "samples_per_step": trace.step * RATE,
        "repeated": trace.method == REPEATED,
        "real_time_factor": factor,
        "long_repeated": long_trace.method == REPEATED,
        "long_real_time_factor": long_factor,
    }


def measure_rival(scene: Scene) -> float:
    """Real-time factor of the package's slow reference: SciPy's DOP853 with located events, rtol 1e-9."""
    simulate(scene, RATE, Reference())
    begin = time.process_time()
    simulate(scene, RATE, Reference())
    return RIVAL_DURATION / (time.process_time() - begin)


def table(results: dict[str, dict[str, float]], rivals: dict[str, float], machine: str) -> str:
    """Markdown of the results."""
    lines = [
        f"| scene | error | estimated | times real time, {DURATION} s | {LONG_DURATION:.0f} s | slipping: error "
        f"| samples a step | times real time, {DURATION} s | {LONG_DURATION:.0f} s |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name, row in results.items():
        lines.append(
            f"| {name} | {row['error']:.1e} | {row['estimate']:.1e} | {row['real_time_factor']:.0f} "
            f"| {row['long_real_time_factor']:.0f} | {row['slip_error']:.1e} | {row['slip_samples_per_step']:.1f} "
            f"| {row['slip_real_time_factor']:.0f} | {row['slip_long_real_time_factor']:.0f} |"
        )
    rival = ", ".join(f"{factor:.3f} on {name}" for name, factor in rivals.items())
    repeated, long_repeated = (
        [name for name, row in results.items() if row[key]] for key in ("repeated", "long_repeated")
    )
    return "\n".join(
        [
            *lines,
            "",
            "G is the gearbox rig, F the fan rig; 0 healthy, 1 a line spall, 1s one with a gradual entry and a sharp "
            "exit, 1p one as a deep gap over which the ball is rolled, 2 a smooth extended spall, 2r a rough one.",
            "",
            "The accuracy asked for is 1e-3. Error: RMS of the resonator's acceleration against fixed steps, "
            f"{FINER_SUBSTEPS} a sample, relative, from {SCORED_FROM} s, in {DURATION} s at 65 536 Hz; estimated: what "
            "the program says of it, over the whole record. Processor time of one core, for records of both lengths. "
            "The scenes are defined without slip: their response repeats itself from ball to ball and is marched only "
            f"until it does (in {DURATION} s {_names(repeated, results)}; in {LONG_DURATION:.0f} s "
            f"{_names(long_repeated, results)}). The last four columns are of "
            "the same scenes with 1 % of random slip, which never repeat.",
            "",
            "SciPy's DOP853 at a relative tolerance of 1e-9 on a compiled right-hand side, events located, runs at "
            f"{rival} times real time in the same run. Its error is about 1e-6, so this is no comparison at equal "
            f"accuracy. {machine}",
        ]
    )


def _names(some: list[str], whole: Collection[str]) -> str:
    return "all" if len(some) == len(whole) else ", ".join(some) or "none"


def main() -> None:
    """Measure, and write the figures where readers look."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    keep_freed_memory()  # as where records are made
    warm_up()
    results = {name: measure(name, rounds) for name in REFERENCE_SCENES}
    rivals = {name: measure_rival(reference_scene(name, RIVAL_DURATION)) for name in RIVAL_SCENES}
    made = measured_on("numpy", "scipy", "numba")
    facts = {"made_with": made, "rounds": rounds, "scenes": results, "rival_real_time_factor": rivals}
    (ROOT / "docs" / "reference_scenes.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    new = table(results, rivals, f"Measured on {in_words(made)}.")
    write_marked(ROOT / "README.md", "reference scenes", __file__, new)
    print(new)


if __name__ == "__main__":
    main()
