"""The stages of the fit: each gives its model, and what that says of virtual bearings it was not fitted to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from datagen.sizing.committee import Committee, folds
from datagen.sizing.training_rows import Trial
from datagen.sizing.trial_columns import TrialColumns
from labels.spall_size.columns.table import leading_rows
from labels.spall_size.estimation.calibration import SMALLEST_SPREAD, Guess
from labels.spall_size.estimation.measurement import measure
from labels.spall_size.estimation.trees import Trees
from labels.spall_size.events.leading import leading_view
from physics.arrays import Array

Bearings = NDArray[np.str_]

LARGEST_COST = 3.0  # of a lag that is given although there are no events
LARGEST_ERROR = 1.0
# Errors above GROSS mean that the wrong pair was taken, from which there is little to learn about the right one.
GROSS, GROSS_WEIGHT = 0.5, 0.2
KEPT_SHARE = 0.06  # of the pairs that are not the events
WRONG_BELOW = 0.05
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


@dataclass(frozen=True)
class FittedScore:
    """The score of a pair as `trees`, and what it says out of fold of the pairs of each of N trials, (P,) each."""

    trees: Trees
    scores: list[Array]


def fit_pair_score(made: list[Trial], bearing: Bearings) -> FittedScore:
    """The score of the pairs of the trials `made` (N,), which are of these bearings (N,)."""
    scores: dict[int, Array] = {}
    for fitted, others in folds(bearing):
        trees = _pair_score([made[k] for k in fitted])
        scores |= {int(k): trees.predict(made[k].evidence.pairs.features) for k in others}
    return FittedScore(_pair_score(made), [scores[k] for k in range(len(made))])


def _pair_score(made: list[Trial]) -> Trees:
    """Trees fitted to the quality of all pairs that are near the events and a share of the others."""
    features = np.concatenate([trial.evidence.pairs.features for trial in made]).astype(np.float32)
    quality = np.concatenate([trial.quality for trial in made])
    wrong = quality < WRONG_BELOW
    kept = ~wrong | (np.random.default_rng(0).random(quality.size) < KEPT_SHARE)
    weight = np.where(wrong, 1.0 / KEPT_SHARE, 1.0)
    return PAIRS.fit(features[kept], quality[kept], weight[kept])


@dataclass(frozen=True)
class FittedRank:
    """The rank of a leading pair as `trees`, and the pair that it puts first, out of fold, in each of N trials: its
    `lag` (N,), samples, the arc of that, `lag_arc` (N,), rad, and all that is known of it, `rows` (N, F)."""

    trees: Trees
    lag: Array
    lag_arc: Array
    rows: Array


def fit_rank(made: list[Trial], scores: list[Array], bearing: Bearings) -> FittedRank:
    """The rank of the pairs that lead by `scores`, (P,) of each of the trials `made` (N,) of these bearings (N,)."""
    leading = [leading_view(trial.evidence, score, trial.situation) for trial, score in zip(made, scores, strict=True)]
    rows_of_each = [leading_rows(view) for view in leading]
    rows = np.concatenate(rows_of_each)
    sizes = [len(some) for some in rows_of_each]
    quality = np.concatenate([trial.quality[view.order] for trial, view in zip(made, leading, strict=True)])
    everywhere = np.ones(quality.size, dtype=np.bool_)
    ranks = np.split(RANK.out_of_fold(rows, quality, everywhere, np.repeat(bearing, sizes)), np.cumsum(sizes)[:-1])
    first = [measure(*of_trial) for of_trial in zip(leading, rows_of_each, ranks, strict=True)]
    return FittedRank(
        RANK.fit(rows, quality),
        np.array([pair.lag for pair in first]),
        np.array([pair.lag_arc for pair in first]),
        np.array([pair.row for pair in first], dtype=np.float32).astype(np.float64),  # trees compare in single
    )


@dataclass(frozen=True)
class FittedGuess:
    """A guess whose reach is still 1, and what it says out of fold: `centre` (N,), and the error left over the one that
    it expects, `missed` (N,), NaN where the error is unknown."""

    guess: Guess
    centre: Array
    missed: Array


def fit_guess(rows: Array, error: Array, bearing: Bearings) -> FittedGuess:
    """The guess of a logarithmic `error` (N,), NaN where unknown, from `rows` (N, F) of these bearings (N,)."""
    known = np.isfinite(error)
    aim = np.clip(error, -LARGEST_ERROR, LARGEST_ERROR)
    weight = np.where(np.abs(aim) < GROSS, 1.0, GROSS_WEIGHT)
    predicted = CENTRE.out_of_fold(rows, aim, known, bearing, weight)
    missed = np.abs(aim - predicted)
    width = np.maximum(SPREAD.out_of_fold(rows, missed, known, bearing), 0.0) + SMALLEST_SPREAD
    centre, spread = CENTRE.fit(rows[known], aim[known], weight[known]), SPREAD.fit(rows[known], missed[known])
    return FittedGuess(Guess(centre, spread, 1.0), predicted, missed / width)


@dataclass(frozen=True)
class FittedDoubt:
    """The relative error to be expected of a lag as `trees`, and what it is out of fold, `expected` (N,)."""

    trees: Trees
    expected: Array


def fit_doubt(rows: Array, estimated_lag: Array, columns: TrialColumns) -> FittedDoubt:
    """The doubt in estimated lags (N,), samples, from `rows` (N, F); 3 at most, and where there are no events."""
    error = np.abs(estimated_lag / columns.lag - 1.0)
    cost = np.where(np.isfinite(error), np.minimum(error, LARGEST_COST), LARGEST_COST)
    expected = DOUBT.out_of_fold(rows, cost, columns.decided, columns.bearing)
    return FittedDoubt(DOUBT.fit(rows[columns.decided], cost[columns.decided]), expected)
