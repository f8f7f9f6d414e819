"""The calibration fitted to trials of simulated machines: run as `python -m datagen.sizing.fit CORPUS... FILE.npz`.

Every later stage learns from what the earlier ones say of virtual bearings that they were not fitted to, and so do the
reach of the intervals and the most doubt. The reach is set on the first corpus alone, for whose mixture of spalls the
intervals are to hold; the most doubt on all records without events and on the first corpus's clean ones.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from datagen.corpora.manifest import read_manifest
from datagen.records.versions import measured_on, program_hash
from datagen.sizing.committee import FOLDS, Committee
from datagen.sizing.cross_fit import CrossFit
from datagen.sizing.training_rows import Trial, trials
from labels.spall_size.calibration import SMALLEST_SPREAD, Calibration, Guess, Judgement
from labels.spall_size.measurement import LeadingPairs, Measurement, leading_order, leading_pairs, measure
from labels.spall_size.trees import Trees

Array = NDArray[np.float64]

COVERAGE = 0.90
ABSTENTION = 0.98
LAG_ERROR = 0.045  # of what is told of clean records; 0.05 is asked of machines not seen
LARGEST_COST = 3.0  # of a lag told where there are no events
SHORTEST_TOLD, SURELY_TOLD = 2.0, 3.0  # samples
LARGEST_ERROR = 1.0
GROSS, GROSS_WEIGHT = 0.5, 0.2  # where the pair was mistaken there is little to learn of how far off a right one lies
KEPT_SHARE = 0.06  # of the pairs that are not the events
WRONG_BELOW = 0.05
LEARNED_WITH = ("numpy", "scipy", "scikit-learn")
PAIRS = Committee(
    1, {"max_iter": 220, "learning_rate": 0.09, "max_leaf_nodes": 24, "min_samples_leaf": 40, "max_bins": 63}
)
RANK = Committee(
    2,
    {
        "max_iter": 220,
        "learning_rate": 0.08,
        "max_leaf_nodes": 48,
        "min_samples_leaf": 60,
        "max_bins": 63,
        "max_features": 0.3,
    },
)
SMALL = {"max_iter": 200, "learning_rate": 0.05, "max_leaf_nodes": 12, "max_bins": 63}
CENTRE = Committee(1, SMALL | {"min_samples_leaf": 20, "loss": "absolute_error"})
SPREAD = Committee(1, SMALL | {"min_samples_leaf": 20})
DOUBT = Committee(4, SMALL | {"min_samples_leaf": 40, "max_features": 0.1})


def fit_calibration(made: list[Trial], typical: NDArray[np.bool_]) -> Calibration:
    """The calibration of the training trials `made` (N,); intervals hold for those that are `typical` (N,)."""
    groups = np.array([trial.bearing_id for trial in made])
    scores = _scores_out_of_fold(made, groups)
    return Calibration(
        pair_score=_pair_score(made),
        blind=_judgement(made, typical, scores, groups, load_known=False),
        with_load=_judgement(made, typical, scores, groups, load_known=True),
    )


def _pair_score(made: list[Trial]) -> Trees:
    """Trees fitted to the quality of all pairs that are near the events and a share of the others."""
    features = np.concatenate([trial.evidence.pairs.features for trial in made]).astype(np.float32)
    quality = np.concatenate([trial.quality for trial in made])
    wrong = quality < WRONG_BELOW
    kept = ~wrong | (np.random.default_rng(0).random(quality.size) < KEPT_SHARE)
    weight = np.where(wrong, 1.0 / KEPT_SHARE, 1.0)
    return PAIRS.fit(features[kept], quality[kept], weight[kept])


def _scores_out_of_fold(made: list[Trial], groups: NDArray[np.str_]) -> list[Array]:
    from sklearn.model_selection import GroupKFold

    scores: dict[int, Array] = {}
    for fitted, others in GroupKFold(FOLDS).split(groups, groups=groups):
        trees = _pair_score([made[k] for k in fitted])
        scores |= {int(k): trees.predict(made[k].evidence.pairs.features) for k in others}
    return [scores[k] for k in range(len(made))]


def _judgement(
    made: list[Trial], typical: NDArray[np.bool_], scores: list[Array], groups: NDArray[np.str_], *, load_known: bool
) -> Judgement:
    rank, measured = ranked(made, scores, groups, load_known=load_known)
    print("with load and Hertz factor" if load_known else "blind")
    rows = np.array([one.row for one in measured], dtype=np.float32).astype(np.float64)  # trees compare in single
    return judged(made, typical, measured, rows, groups, rank)


def judged(
    made: list[Trial],
    typical: NDArray[np.bool_],
    measured: list[Measurement],
    rows: Array,
    groups: NDArray[np.str_],
    rank: Trees,
) -> Judgement:
    """The judgement of the pairs `measured` (N,), whose `rows` are (N, F), by a `rank` that was fitted before.

    Intervals hold for the `typical` (N,) trials of which a size is told.
    """
    stored = np.array([trial.stored for trial in made])
    true_lag = np.array([trial.true_lag for trial in made])
    lag_error = np.log(np.array([trial.lag for trial in made]) / np.array([one.lag for one in measured]))
    arc = np.array([trial.arc for trial in made])
    arc_error = np.log(np.where(arc > 0.0, arc, np.nan) / np.array([one.lag_arc for one in measured]))
    lag, told = _guess(rows, lag_error, groups)
    lag_told = _lag_told(made, measured, told.centre)
    doubt, expected = _doubt(rows, _cost(made, lag_told), true_lag, groups)
    abstaining = float(np.quantile(expected[stored & ~(true_lag >= SHORTEST_TOLD)], 1.0 - ABSTENTION))
    asked = typical & np.array([trial.asked for trial in made])
    clean = asked & np.array([trial.clean for trial in made])
    error = np.abs(lag_told / true_lag - 1.0)
    most = CrossFit(error[clean], expected[clean], abstaining).most_within(LAG_ERROR)
    for noise, scored in (("clean", clean), ("as stored", asked & stored)):
        print(noise, *CrossFit(error[scored], expected[scored], most).lines(), sep="; ")
    usual = typical & stored & (expected <= most)
    arc_guess, arc_told = _guess(rows, arc_error, groups)
    lag, arc_guess = replace(lag, reach=told.reach(usual)), replace(arc_guess, reach=arc_told.reach(usual))
    return Judgement(rank, lag, arc_guess, doubt, most)


def _lag_told(made: list[Trial], measured: list[Measurement], told: Array) -> Array:
    """Lags (N,) in samples, measured and corrected as `told` (N,)."""
    longest = np.array([trial.evidence.mean.period for trial in made])
    return np.minimum(np.array([one.lag for one in measured]) * np.exp(told), longest)


def _cost(made: list[Trial], lag_told: Array) -> Array:
    """Relative error (N,) of the lags told (N,), in samples; 3 at most, and where there are no events."""
    error = np.abs(lag_told / np.array([trial.lag for trial in made]) - 1.0)
    return np.where(np.isfinite(error), np.minimum(error, LARGEST_COST), LARGEST_COST)


def ranked(
    made: list[Trial], scores: list[Array], groups: NDArray[np.str_], *, load_known: bool
) -> tuple[Trees, list[Measurement]]:
    """The rank of the leading pairs by `scores`, and the pairs that it puts first in bearings it was not fitted to."""
    leading = [_leading(trial, score, load_known) for trial, score in zip(made, scores, strict=True)]
    rows = np.concatenate([one.rows for one in leading])
    sizes = [one.lag.size for one in leading]
    order = [leading_order(trial.evidence.pairs, score) for trial, score in zip(made, scores, strict=True)]
    quality = np.concatenate([trial.quality[own] for trial, own in zip(made, order, strict=True)])
    everywhere = np.ones(quality.size, dtype=bool)
    told = np.split(RANK.out_of_fold(rows, quality, everywhere, np.repeat(groups, sizes)), np.cumsum(sizes)[:-1])
    measured = [measure(one, rank) for one, rank in zip(leading, told, strict=True)]
    return RANK.fit(rows, quality), measured


def _leading(trial: Trial, score: Array, load_known: bool) -> LeadingPairs:
    situation = trial.situation
    return leading_pairs(trial.evidence, score, situation if load_known else replace(situation, load=None))


@dataclass(frozen=True)
class OutOfFold:
    """What a guess says of bearings it was not fitted to: `centre` (N,), and the error left over that expected (N,)."""

    centre: Array
    missed: Array

    def reach(self, usual: NDArray[np.bool_]) -> float:
        """How many expected errors hold 90 % of the `usual` (N,) ones."""
        return float(np.quantile(self.missed[usual & np.isfinite(self.missed)], COVERAGE))


def _guess(rows: Array, error: Array, groups: NDArray[np.str_]) -> tuple[Guess, OutOfFold]:
    """The guess of `error` (N,) from `rows` (N, F), its reach still 1, and what it says of bearings not fitted to."""
    known = np.isfinite(error)
    aim = np.clip(error, -LARGEST_ERROR, LARGEST_ERROR)
    weight = np.where(np.abs(aim) < GROSS, 1.0, GROSS_WEIGHT)
    told = CENTRE.out_of_fold(rows, aim, known, groups, weight)
    missed = np.abs(aim - told)
    width = np.maximum(SPREAD.out_of_fold(rows, missed, known, groups), 0.0) + SMALLEST_SPREAD
    centre, spread = CENTRE.fit(rows[known], aim[known], weight[known]), SPREAD.fit(rows[known], missed[known])
    return Guess(centre, spread, 1.0), OutOfFold(told, missed / width)


def _doubt(rows: Array, cost: Array, true_lag: Array, groups: NDArray[np.str_]) -> tuple[Trees, Array]:
    """The expected `cost` (N,), and what it is (N,) in bearings it was not fitted to."""
    scored = ~((true_lag >= SHORTEST_TOLD) & (true_lag < SURELY_TOLD))
    expected = DOUBT.out_of_fold(rows, cost, scored, groups)
    return DOUBT.fit(rows[scored], cost[scored]), expected


def main(corpora: list[str], file: str, workers: int = 2) -> None:
    """Fit to the training and validation splits of all `corpora` and write `file`."""
    by_corpus = [trials(Path(corpus), ("train", "validation"), workers) for corpus in corpora]
    made = [trial for own in by_corpus for trial in own]
    typical = np.arange(len(made)) < len(by_corpus[0])
    print(f"{len(made)} trials of {len({(trial.bearing_id, trial.record) for trial in made})} records")
    calibration = replace(fit_calibration(made, typical), origin=_origin(corpora, made))
    np.savez_compressed(file, **calibration.to_arrays())  # type: ignore[arg-type]
    print(f"{file}: {Path(file).stat().st_size} bytes")


def _origin(corpora: list[str], made: list[Trial]) -> str:
    """In words, what was fitted to: corpora and the hashes of their recipes, records, sampling rates, programs."""
    manifests = [read_manifest(Path(corpus)) for corpus in corpora]
    names = ", ".join(f"{one.name} (recipe {one.identity.recipe_hash})" for one in manifests)
    rates = ", ".join(f"{rate:g}" for rate in sorted({trial.evidence.rate for trial in made}))
    programs = measured_on(*LEARNED_WITH)
    versions = ", ".join(f"{name} {programs[name]}" for name in ("python", *LEARNED_WITH))
    return (
        f"Fitted by datagen.sizing.fit to {len({(trial.bearing_id, trial.record) for trial in made})} records at "
        f"{rates} Hz, the training and validation splits of {names}; features {program_hash('labels')}, {versions}."
    )


if __name__ == "__main__":
    main(sys.argv[1:-1], sys.argv[-1])
