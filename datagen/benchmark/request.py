"""What a person asked of `classify`, checked before anything is read."""

from __future__ import annotations

import math
import os
from dataclasses import asdict, dataclass
from pathlib import Path

from datagen.benchmark.classify import Benchmark
from datagen.benchmark.impulse_training import ingredients_of
from datagen.benchmark.score_log import log_path
from datagen.benchmark.trained import SAVE, is_saved
from datagen.benchmark.training import SPEED_ERROR
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.own_code import load_own
from datagen.places import require_file, require_results_folder
from labels.classifier.learners import LEARNERS

INPUTS = ("features", "windows")
LEAST_BANDWIDTH = 1000.0
OF_LEARNING = ("learner", "estimator", "input", "bandwidth", "speed_error", "first")
LEAST_NOISE_DB, MOST_NOISE_DB = -100.0, 100.0
SPOKEN = "module:Class, made without arguments, or module:object, with predict_proba or predict; or module:function"


@dataclass(frozen=True)
class Asked:
    """The options of the command line, as they are logged."""

    learner: str = "all"
    estimator: str | None = None
    input: str = "features"
    bandwidth: float | None = None
    speed_error: float = SPEED_ERROR
    first: int | None = None
    reject: float = 0.0
    noise_db: str = ""
    noise_draws: int = 10

    def require(self) -> None:
        """Raise BadInput for an option that cannot be."""
        if self.learner not in (*LEARNERS, "all"):
            raise BadInput(field="--learner", value=self.learner, allowed=", ".join((*LEARNERS, "all")))
        if self.input not in INPUTS:
            raise BadInput(field="--input", value=self.input, allowed=", ".join(INPUTS))
        if self.input == "windows" and not self.estimator:
            raise BadInput("our learners take features", field="--input", value="windows", allowed="with --estimator")
        if self.bandwidth is not None and not LEAST_BANDWIDTH <= self.bandwidth < math.inf:
            raise BadInput(field="--bandwidth", value=self.bandwidth, allowed=f"{LEAST_BANDWIDTH:g} Hz or more")
        if not 0.0 <= self.speed_error <= SPEED_ERROR:
            raise BadInput(field="--speed-error", value=self.speed_error, allowed=f"0 to {SPEED_ERROR:g}")
        if not 0.0 <= self.reject <= 1.0:
            raise BadInput(field="--reject", value=self.reject, allowed="0 to 1")

    def levels(self) -> tuple[float, ...]:
        """Signal over noise, dB, of the noise to add; raises BadInput for text that says none."""
        allowed = f"numbers from {LEAST_NOISE_DB:g} to {MOST_NOISE_DB:g} dB with commas between them"
        try:
            found = tuple(float(part) for part in self.noise_db.split(",") if part.strip())
        except ValueError:
            raise BadInput(field="--noise-db", value=self.noise_db, allowed=allowed) from None
        if not all(LEAST_NOISE_DB <= level <= MOST_NOISE_DB for level in found):
            raise BadInput(field="--noise-db", value=self.noise_db, allowed=allowed)
        return found


def benchmark_of(
    train: Path,
    tests: tuple[Path, ...],
    asked: Asked,
    curve: bool = False,
    workers: int = 2,
    out: Path | None = None,
    save: Path | None = None,
) -> Benchmark:
    """The benchmark that is asked for; raises BadInput for an option or a folder that cannot be."""
    asked.require()
    _require_use(train, tests, asked, curve, save)
    levels = asked.levels()
    own = load_own(asked.estimator, SPOKEN) if asked.estimator is not None else None
    if levels and asked.input == "windows":
        raise BadInput(
            "noise is added where features are computed", "", "--noise-db", asked.noise_db, "--input features"
        )
    if curve and own is not None and not hasattr(own, "fit"):
        problem = f"{asked.estimator} does not learn"
        raise BadInput(problem, field="--learning-curve", allowed="our learners, or an estimator with a method fit")
    _require_folders(train, tests, asked.input == "windows")
    if out is not None:
        require_results_folder(out)
    return Benchmark(
        train,
        tests,
        learner=asked.learner,
        estimator=own,
        given=asked.estimator or "",
        takes_windows=asked.input == "windows",
        bandwidth=asked.bandwidth,
        speed_error=asked.speed_error,
        first=asked.first,
        doubt=asked.reject,
        noise_db=levels,
        noise_draws=asked.noise_draws,
        workers=workers,
        curve=curve,
        save=save,
        options=asdict(asked),
    )


def _require_use(train: Path, tests: tuple[Path, ...], asked: Asked, curve: bool, save: Path | None) -> None:
    """Raise BadInput unless there is something to do with what is learned, and to learn where options ask for it."""
    if save is None and not tests:
        raise BadInput("nothing to score on", field="--test", allowed=f"a corpus, or {SAVE} FILE to learn only")
    if save is not None:
        require_file(save, SAVE)
        if asked.estimator is not None:
            raise BadInput("an estimator of your own is yours to keep", field=SAVE, allowed="with our learners")
    if not is_saved(train):
        return
    usual = Asked()
    changed = [name for name in OF_LEARNING if getattr(asked, name) != getattr(usual, name)]
    changed += ["learning_curve"] * curve + [SAVE.removeprefix("--")] * (save is not None)
    if changed:
        option = f"--{changed[0].replace('_', '-')}"
        raise BadInput(f"{train} has learned already", field=option, allowed="with a corpus to learn from as --train")


def _require_folders(train: Path, tests: tuple[Path, ...], windows: bool) -> None:
    if not is_saved(train) and ingredients_of(train) is None:
        if Corpus(train).manifest.imported:
            raise BadInput("classifiers learn from simulated corpora only", str(train), "--train")
    elif windows:
        raise BadInput("plain impulse trains have features only", field="--input", value="windows", allowed="features")
    for folder in tests:
        corpus = Corpus(folder)
        if corpus.labels.empty:
            raise BadInput("this corpus has no records", str(folder), "--test")
        if corpus.manifest.imported and not os.access(folder, os.W_OK):
            raise BadInput("runs on recordings are logged here, and it cannot be written", str(log_path(folder)))
