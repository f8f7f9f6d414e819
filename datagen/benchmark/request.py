"""What a person asked of `classify`, checked before anything is read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from datagen.benchmark.classify import Benchmark
from datagen.errors import BadInput
from datagen.own_code import load_own
from labels.learners import LEARNERS

INPUTS = ("features", "windows")
LEAST_BANDWIDTH = 1000.0
MOST_SPEED_ERROR = 0.02
SPOKEN = "module:Class, made without arguments, with predict_proba or predict; or module:function"


def benchmark_of(train: Path, tests: tuple[Path, ...], options: dict[str, Any], curve: bool, workers: int) -> Benchmark:
    """The benchmark of these options of the command line; raises BadInput for one that cannot be."""
    if options["learner"] not in (*LEARNERS, "all"):
        raise BadInput(field="--learner", value=options["learner"], allowed=", ".join((*LEARNERS, "all")))
    if options["input"] not in INPUTS:
        raise BadInput(field="--input", value=options["input"], allowed=", ".join(INPUTS))
    if options["input"] == "windows" and not options["estimator"]:
        raise BadInput("our learners take features", field="--input", value="windows", allowed="with --estimator")
    if options["bandwidth"] is not None and not options["bandwidth"] >= LEAST_BANDWIDTH:
        raise BadInput(field="--bandwidth", value=options["bandwidth"], allowed=f"{LEAST_BANDWIDTH:g} Hz or more")
    if not 0.0 <= options["speed_error"] <= MOST_SPEED_ERROR:
        raise BadInput(field="--speed-error", value=options["speed_error"], allowed=f"0 to {MOST_SPEED_ERROR:g}")
    own = load_own(options["estimator"], SPOKEN) if options["estimator"] else None
    return Benchmark(
        train,
        tests,
        options["learner"],
        own,
        options["input"] == "windows",
        options["bandwidth"],
        options["speed_error"],
        options["first"],
        options["reject"],
        _levels(options["noise_db"]),
        options["noise_draws"],
        workers,
        curve,
        options,
    )


def _levels(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise BadInput(field="--noise-db", value=text, allowed="numbers of dB with commas between them") from None
