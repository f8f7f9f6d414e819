"""What a person asked of `classify`, checked before anything is read."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from datagen.benchmark.answers import estimator_name
from datagen.benchmark.impulse_training import NAME, ingredients_of
from datagen.benchmark.kept_rows import is_kept
from datagen.benchmark.options import FEATURES, SAVE, TEST_ON, TRAIN, TRANSFER_ROWS, WINDOWS, Learning, Scoring
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.predictions import FACTS
from datagen.benchmark.reading_policy import LEAST_NOISE_DB
from datagen.benchmark.trained import is_saved
from datagen.benchmark.verdicts import RULE
from datagen.corpus import Corpus
from datagen.corpus_files.index import no_records
from datagen.corpus_files.manifest import manifest_path, no_corpus
from datagen.errors import BadInput
from datagen.files.places import require_file
from datagen.judging.scored_runs import require_log
from datagen.judging.stated_speed import SPEED_ERROR
from datagen.judging.user_code import FIELD, load_user_code
from labels.classifier.learners import LEARNERS

INPUTS = (FEATURES, WINDOWS)
WITH_A_CORPUS = "with a corpus to learn from as --train"
LEAST_BANDWIDTH = 1000.0
MOST_NOISE_DB = 100.0
TRAINING = (
    f"the folder of a simulated corpus, a file that {SAVE} wrote, {TRANSFER_ROWS}, {NAME} or {NAME}-without-INGREDIENT"
)
ESTIMATOR_FORMS = (
    "module:Class, made without arguments, or module:object, with predict_proba or predict; or module:function"
)


def checked(asked: Benchmark) -> Benchmark:
    """The benchmark as it was asked for, with the user's estimator if its options name one; raises BadInput for an
    option or a folder that cannot be used."""
    learning, scoring = asked.learning, asked.scoring
    _require_learning(learning)
    _require_scoring(scoring)
    _require_use(asked)
    estimator = _own_estimator(learning.estimator) if learning.estimator is not None else None
    if scoring.levels and learning.takes_windows:
        problem = "noise is added where features are computed"
        raise BadInput(problem, field="--noise-db", value=scoring.noise_db, allowed="--input features")
    if asked.learning_curve and estimator is not None and not hasattr(estimator, "fit"):
        problem = f"{learning.estimator} does not learn"
        raise BadInput(problem, field="--learning-curve", allowed="our learners, or an estimator with a method fit")
    _require_folders(asked.train, asked.tests, learning.takes_windows)
    return replace(asked, estimator=estimator)


def _own_estimator(name: str) -> Any:
    """The user's estimator called "module:name"; raises BadInput if it cannot be asked, or reports could not tell it
    from what else they hold."""
    found = load_user_code(name, ESTIMATOR_FORMS)
    # What is fitted first may have its predict from then on.
    if not (callable(found) or any(hasattr(found, method) for method in ("fit", "predict_proba", "predict"))):
        raise BadInput("it can be neither fitted nor asked", field=FIELD, value=name, allowed=ESTIMATOR_FORMS)
    shown = estimator_name(found)
    if shown in (RULE, *FACTS):
        problem = f'reports hold something else under the name "{shown}"'
        raise BadInput(problem, field=FIELD, value=name, allowed="an estimator of another name")
    return found


def _require_learning(learning: Learning) -> None:
    if learning.learner not in (*LEARNERS, "all"):
        raise BadInput(field="--learner", value=learning.learner, allowed=", ".join((*LEARNERS, "all")))
    if learning.estimator is not None and learning.learner != Learning().learner:
        problem = "an estimator of your own learns in place of ours"
        raise BadInput(problem, field="--learner", value=learning.learner, allowed="without --estimator")
    if learning.input not in INPUTS:
        raise BadInput(field="--input", value=learning.input, allowed=", ".join(INPUTS))
    if learning.takes_windows and not learning.estimator:
        raise BadInput("our learners take features", field="--input", value=WINDOWS, allowed="with --estimator")
    require_bandwidth(learning.bandwidth)
    if not 0.0 <= learning.speed_error <= SPEED_ERROR:
        raise BadInput(field="--speed-error", value=learning.speed_error, allowed=f"0 to {SPEED_ERROR:g}")


def require_bandwidth(bandwidth: float | None) -> None:
    """Raise BadInput for a `bandwidth` (Hz; None: as usual) that is too narrow for features."""
    if bandwidth is not None and not LEAST_BANDWIDTH <= bandwidth < math.inf:
        raise BadInput(field="--bandwidth", value=bandwidth, allowed=f"{LEAST_BANDWIDTH:g} Hz or more")


def _require_scoring(scoring: Scoring) -> None:
    if not 0.0 <= scoring.reject <= 1.0:
        raise BadInput(field="--reject", value=scoring.reject, allowed="0 to 1")
    allowed = f"numbers from {LEAST_NOISE_DB:g} to {MOST_NOISE_DB:g} dB with commas between them"
    if not all(LEAST_NOISE_DB <= level <= MOST_NOISE_DB for level in scoring.levels):
        raise BadInput(field="--noise-db", value=scoring.noise_db, allowed=allowed)
    if not scoring.levels and scoring.noise_draws != Scoring().noise_draws:
        raise BadInput(
            "there is no noise to draw", field="--noise-draws", value=scoring.noise_draws, allowed="with --noise-db"
        )


def _require_use(asked: Benchmark) -> None:
    """Raise BadInput unless the trained models are scored or saved, and options of learning come with something that is
    yet to be learned from, or read, by them. Features that are kept were read at many bandwidths: they go with any."""
    train, save, learning = asked.train, asked.save, asked.learning
    if save is None and not asked.tests:
        raise BadInput("nothing to score on", field=TEST_ON, allowed=f"a corpus, or {SAVE} FILE to learn only")
    if save is not None:
        require_file(save, SAVE)
        if learning.estimator is not None:
            raise BadInput("an estimator of your own is yours to keep", field=SAVE, allowed="with our learners")
    changed = _changed(learning)
    if is_saved(train):
        changed += ["learning_curve"] * asked.learning_curve + [SAVE.removeprefix("--")] * (save is not None)
        if changed:
            raise BadInput(f"{train} has learned already", field=_option(changed[0]), allowed=WITH_A_CORPUS)
    if is_kept(train) and "speed_error" in changed:
        raise BadInput(f"{train} have been read already", field="--speed-error", allowed=WITH_A_CORPUS)


def _changed(learning: Learning) -> list[str]:
    """The options of learning that are not as usual."""
    usual = Learning()
    return [field.name for field in fields(Learning) if getattr(learning, field.name) != getattr(usual, field.name)]


def _option(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def _require_folders(train: Path, tests: tuple[Path, ...], windows: bool) -> None:
    if not is_saved(train) and not is_kept(train) and ingredients_of(train) is None:
        if _corpus(train, TRAIN, TRAINING).manifest.imported:
            raise BadInput("classifiers learn from simulated corpora only", file=str(train), field=TRAIN)
    elif windows:
        raise BadInput(f"of {train} there are features only", field="--input", value=WINDOWS, allowed=FEATURES)
    for place, folder in enumerate(tests):
        if folder.resolve() in (earlier.resolve() for earlier in tests[:place]):
            raise BadInput("this corpus is named twice", file=str(folder), field=TEST_ON)
        corpus = _corpus(folder, TEST_ON, "the folder of a corpus, simulated or imported")
        if corpus.labels.empty:
            raise no_records(folder, TEST_ON)
        if corpus.manifest.imported:
            require_log(folder)


def _corpus(folder: Path, option: str, allowed: str) -> Corpus:
    """The corpus in a `folder` that an `option` names; raises BadInput with what it takes if there is none."""
    manifest = manifest_path(folder)
    if manifest.exists():
        return Corpus(folder)
    problem = no_corpus(folder, manifest.name).problem if folder.exists() else "no such file or folder"
    raise BadInput(problem, field=option, value=str(folder), allowed=allowed)
