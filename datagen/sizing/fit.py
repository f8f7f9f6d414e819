"""The calibration fitted to trials of simulated machines.

python -m datagen.sizing.fit CORPUS... --out FILE.npz

Every later stage learns from what the earlier ones say of virtual bearings that they were not fitted to, and so do the
reach of the intervals and the most doubt. The reach is set on the first corpus alone, for whose mixture of spalls the
intervals are to hold; the most doubt on all records without events and on the first corpus's clean ones.
"""

from __future__ import annotations

import argparse
import io
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from datagen.corpus_files.index import read_index
from datagen.corpus_files.manifest import read_manifest
from datagen.errors import BadInput
from datagen.exits import BAD_INPUT, print_error
from datagen.files.atomic import write_file
from datagen.files.places import OUT, require_file
from datagen.sizing.committee import FOLDS, folds
from datagen.sizing.cross_fit import CrossFit
from datagen.sizing.fit_limits import most_doubt, reach
from datagen.sizing.fit_stages import fit_doubt, fit_guess, fit_pair_score, fit_rank
from datagen.sizing.training_rows import Trial, trials
from datagen.sizing.trial_columns import TrialColumns
from datagen.versions import measured_on, program_hash
from labels.spall_size.estimation.calibration import Calibration, Judgement
from physics.arrays import Array

LEARNED_SPLITS = ("train", "validation")
FEATURE_CODE = (
    "labels",
    "labels/spall_size",
    "labels/spall_size/columns",
    "labels/spall_size/estimation",
    "labels/spall_size/events",
    "labels/spall_size/signal",
)
LEARNED_WITH = ("numpy", "scipy", "scikit-learn")


def main(arguments: Sequence[str] | None = None) -> int:
    """Fit to the training and validation splits of all corpora and write the file; the exit code."""
    parser = argparse.ArgumentParser(prog="python -m datagen.sizing.fit", description="Fit the size estimator.")
    parser.add_argument("corpora", nargs="+", type=Path, metavar="CORPUS", help="Intervals hold for the first.")
    parser.add_argument(OUT, required=True, type=Path, metavar="FILE.npz", help="The calibration.")
    parser.add_argument("--workers", type=int, default=2, metavar="N", help="Processes that read the records.")
    asked = parser.parse_args(arguments)
    try:
        fit(asked.corpora, asked.out, asked.workers)
    except BadInput as problem:
        print_error(problem)
        return BAD_INPUT
    return 0


def fit(corpora: Sequence[Path], out: Path, workers: int) -> None:
    """The calibration of the trials of `corpora` in the file `out`, which is absent or as it was until it is whole.

    Raises BadInput: before any work where an argument cannot be used, such as a folder without records to learn from or
    no place for the file, and before the first stage where the trials do not suffice.
    """
    require_file(out)
    if workers < 1:
        raise BadInput(field="--workers", value=workers, allowed="1 or more")
    for corpus in corpora:
        _require_training(corpus)
    by_corpus = [trials(corpus, LEARNED_SPLITS, workers) for corpus in corpora]
    made = [trial for trials_of_corpus in by_corpus for trial in trials_of_corpus]
    columns = TrialColumns.of(made, np.arange(len(made)) < len(by_corpus[0]))
    _require_enough(columns)
    print(f"{len(made)} trials of {_record_count(made)} records")
    calibration = replace(fit_calibration(made, columns), origin=_origin(corpora, made))
    whole = io.BytesIO()
    np.savez_compressed(whole, **calibration.to_arrays())  # type: ignore[arg-type]
    write_file(out, whole.getvalue(), OUT)
    print(f"{out}: {len(whole.getvalue())} bytes")


def _require_training(corpus: Path) -> None:
    present = set(read_index(corpus)["split"])
    if not present & set(LEARNED_SPLITS):
        raise BadInput(
            "no records to learn from",
            file=str(corpus),
            field="split",
            value=", ".join(sorted(present)),
            allowed=" or ".join(LEARNED_SPLITS),
        )


def _require_enough(columns: TrialColumns) -> None:
    bearings = np.unique(columns.bearing).size
    if bearings < FOLDS:
        raise BadInput(
            "too few bearings to leave some out", field="bearings", value=bearings, allowed=f"{FOLDS} or more"
        )
    if not columns.eventless.any():
        raise BadInput(
            "no record without events, by which the most doubt is set", allowed="corpora with healthy records"
        )
    if not np.isfinite(columns.lag[columns.as_stored]).any():
        raise BadInput("no record of the first corpus has events that are known, by which the reach is set")
    learned_from = np.isfinite(columns.lag), columns.arc > 0.0, columns.decided
    if not all(used[fitted].any() for fitted, _ in folds(columns.bearing) for used in learned_from):
        problem = "too few bearings with events that are known: where some are left out, none is left to learn from"
        raise BadInput(problem, allowed="corpora with spalls on more bearings")


def _record_count(made: list[Trial]) -> int:
    """How many records the trials are of; the number of a record alone is not unique over corpora."""
    return len({(trial.bearing_id, trial.record) for trial in made})


def _origin(corpora: Sequence[Path], made: list[Trial]) -> str:
    """In words, what was fitted to: corpora and the hashes of their recipes, records, sampling rates, programs."""
    manifests = [read_manifest(corpus) for corpus in corpora]
    names = ", ".join(f"{manifest.name} (recipe {manifest.identity.recipe_hash})" for manifest in manifests)
    rates = ", ".join(f"{rate:g}" for rate in sorted({trial.evidence.rate for trial in made}))
    programs = measured_on(*LEARNED_WITH)
    versions = ", ".join(f"{name} {programs[name]}" for name in ("python", *LEARNED_WITH))
    features = program_hash(*FEATURE_CODE)
    return (
        f"Fitted by datagen.sizing.fit to {_record_count(made)} records at "
        f"{rates} Hz, the training and validation splits of {names}; features {features}, {versions}."
    )


def fit_calibration(made: list[Trial], columns: TrialColumns) -> Calibration:
    """The calibration of the training trials `made` (N,) and their `columns`; says how they fare out of fold."""
    score = fit_pair_score(made, columns.bearing)
    told = {"blind": [trial.without_load() for trial in made], "with load and Hertz factor": made}
    judgements = []
    for name, seen in told.items():
        judgement, cross_fits = _judgement(seen, columns, score.scores)
        print(name)
        for noise, cross_fit in cross_fits.items():
            print(noise, *cross_fit.lines(), sep="; ")
        judgements.append(judgement)
    blind, with_load = judgements
    return Calibration(score.trees, blind, with_load)


def _judgement(made: list[Trial], columns: TrialColumns, scores: list[Array]) -> tuple[Judgement, dict[str, CrossFit]]:
    """The judgement of the pairs that lead by `scores`, and how typical trials fare out of fold, by their noise."""
    rank = fit_rank(made, scores, columns.bearing)
    lag_fit = fit_guess(rank.rows, np.log(columns.lag / rank.lag), columns.bearing)
    estimated_lag = np.minimum(rank.lag * np.exp(lag_fit.centre), columns.period)
    doubt = fit_doubt(rank.rows, estimated_lag, columns)
    error, expected = np.abs(estimated_lag / columns.true_lag - 1.0), doubt.expected
    most = most_doubt(columns, error, expected)
    true_arc = np.where(columns.arc > 0.0, columns.arc, np.nan)
    arc_fit = fit_guess(rank.rows, np.log(true_arc / rank.lag_arc), columns.bearing)
    usual = columns.as_stored & (expected <= most)
    lag_guess, arc_guess = (replace(fitted.guess, reach=reach(fitted.missed, usual)) for fitted in (lag_fit, arc_fit))
    scored = {"clean": columns.asked_clean, "as stored": columns.asked_as_stored}
    cross_fits = {noise: CrossFit(error[chosen], expected[chosen], most) for noise, chosen in scored.items()}
    return Judgement(rank.trees, lag_guess, arc_guess, doubt.trees, most), cross_fits


if __name__ == "__main__":
    sys.exit(main())
