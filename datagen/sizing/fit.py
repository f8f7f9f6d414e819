"""The calibration fitted to trials of simulated machines: run as `python -m datagen.sizing.fit CORPUS... FILE.npz`.

Every later stage learns from what the earlier ones say of virtual bearings that they were not fitted to, and so do the
reach of the intervals and the most doubt. Both are set on records with the noise of their corpus, the reach on the
first corpus alone, for whose mixture of spalls the intervals are to hold.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.sizing.training_rows import Trial, trials
from labels.spall_size.calibration import SMALLEST_SPREAD, Calibration, Guess, Judgement
from labels.spall_size.measurement import LeadingPairs, Measurement, leading_order, leading_pairs, measure
from labels.spall_size.trees import Trees

Array = NDArray[np.float64]

FOLDS = 3
COVERAGE = 0.90
ABSTENTION = 0.985
LARGEST_COST = 3.0  # of a lag told where there are no events
SHORTEST_TOLD, SURELY_TOLD = 2.0, 3.0  # samples
LARGEST_ERROR = 1.0
GROSS, GROSS_WEIGHT = 0.5, 0.2  # where the pair was mistaken there is little to learn of how far off a right one lies
KEPT_SHARE = 0.06  # of the pairs that are not the events
WRONG_BELOW = 0.05
PAIRS = {"max_iter": 220, "learning_rate": 0.09, "max_leaf_nodes": 24, "min_samples_leaf": 40, "max_bins": 63}
RANKS = {"max_iter": 200, "learning_rate": 0.06, "max_leaf_nodes": 16, "min_samples_leaf": 30, "max_bins": 63}
GUESSES = {"max_iter": 200, "learning_rate": 0.05, "max_leaf_nodes": 12, "min_samples_leaf": 20, "max_bins": 63}


def fit_calibration(made: list[Trial], typical: NDArray[np.bool_]) -> Calibration:
    """The calibration of the training trials `made` (N,); intervals hold for those that are `typical` (N,)."""
    from sklearn.ensemble import HistGradientBoostingRegressor

    groups = np.array([trial.bearing_id for trial in made])
    model = HistGradientBoostingRegressor(**PAIRS, random_state=0)
    scores = _scores_out_of_fold(model, made, groups)
    fit_pairs(model, made)
    return Calibration(
        pair_score=to_trees(model),
        blind=_judgement(made, typical, scores, groups, load_known=False),
        with_load=_judgement(made, typical, scores, groups, load_known=True),
    )


def fit_pairs(model: Any, made: list[Trial]) -> Any:
    """The `model` fitted to the quality of all pairs that are near the events and a share of the others."""
    features = np.concatenate([trial.evidence.pairs.features for trial in made]).astype(np.float32)
    quality = np.concatenate([trial.quality for trial in made])
    wrong = quality < WRONG_BELOW
    kept = ~wrong | (np.random.default_rng(0).random(quality.size) < KEPT_SHARE)
    weight = np.where(wrong, 1.0 / KEPT_SHARE, 1.0)
    return model.fit(features[kept], quality[kept], sample_weight=weight[kept])


def _scores_out_of_fold(model: Any, made: list[Trial], groups: NDArray[np.str_]) -> list[Array]:
    from sklearn.base import clone
    from sklearn.model_selection import GroupKFold

    scores: dict[int, Array] = {}
    for fitted, others in GroupKFold(FOLDS).split(groups, groups=groups):
        trees = to_trees(fit_pairs(clone(model), [made[k] for k in fitted]))
        scores |= {int(k): trees.predict(made[k].evidence.pairs.features) for k in others}
    return [scores[k] for k in range(len(made))]


def _judgement(
    made: list[Trial], typical: NDArray[np.bool_], scores: list[Array], groups: NDArray[np.str_], *, load_known: bool
) -> Judgement:
    rank, measured = ranked(made, scores, groups, load_known=load_known)
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
    doubt, expected = _doubt(rows, _cost(made, measured, told.centre), true_lag, groups)
    most = float(np.quantile(expected[stored & ~(true_lag >= SHORTEST_TOLD)], 1.0 - ABSTENTION))
    usual = typical & stored & (expected <= most)
    arc_guess, arc_told = _guess(rows, arc_error, groups)
    lag, arc_guess = replace(lag, reach=told.reach(usual)), replace(arc_guess, reach=arc_told.reach(usual))
    return Judgement(rank, lag, arc_guess, doubt, most)


def _cost(made: list[Trial], measured: list[Measurement], told: Array) -> Array:
    """Relative error (N,) of lags measured and corrected as `told` (N,); 3 at most, and where there are no events."""
    longest = np.array([trial.evidence.mean.period for trial in made])
    lag = np.minimum(np.array([one.lag for one in measured]) * np.exp(told), longest)
    error = np.abs(lag / np.array([trial.lag for trial in made]) - 1.0)
    return np.where(np.isfinite(error), np.minimum(error, LARGEST_COST), LARGEST_COST)


def ranked(
    made: list[Trial], scores: list[Array], groups: NDArray[np.str_], *, load_known: bool
) -> tuple[Trees, list[Measurement]]:
    """The rank of the leading pairs by `scores`, and the pairs that it puts first in bearings it was not fitted to."""
    from sklearn.ensemble import HistGradientBoostingRegressor

    leading = [_leading(trial, score, load_known) for trial, score in zip(made, scores, strict=True)]
    model = HistGradientBoostingRegressor(**RANKS, random_state=0)
    rows = np.concatenate([one.rows for one in leading])
    sizes = [one.lag.size for one in leading]
    quality = np.concatenate([trial.quality[leading_order(score)] for trial, score in zip(made, scores, strict=True)])
    everywhere = np.ones(quality.size, dtype=bool)
    told = np.split(_out_of_fold(model, rows, quality, everywhere, np.repeat(groups, sizes)), np.cumsum(sizes)[:-1])
    measured = [measure(one, rank) for one, rank in zip(leading, told, strict=True)]
    return to_trees(model.fit(rows, quality)), measured


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
    from sklearn.ensemble import HistGradientBoostingRegressor

    known = np.isfinite(error)
    aim = np.clip(error, -LARGEST_ERROR, LARGEST_ERROR)
    weight = np.where(np.abs(aim) < GROSS, 1.0, GROSS_WEIGHT)
    centre = HistGradientBoostingRegressor(loss="absolute_error", **GUESSES, random_state=0)
    spread = HistGradientBoostingRegressor(**GUESSES, random_state=0)
    told = _out_of_fold(centre, rows, aim, known, groups, weight)
    missed = np.abs(aim - told)
    width = np.maximum(_out_of_fold(spread, rows, missed, known, groups), 0.0) + SMALLEST_SPREAD
    fitted = centre.fit(rows[known], aim[known], weight[known]), spread.fit(rows[known], missed[known])
    return Guess(to_trees(fitted[0]), to_trees(fitted[1]), 1.0), OutOfFold(told, missed / width)


def _doubt(rows: Array, cost: Array, true_lag: Array, groups: NDArray[np.str_]) -> tuple[Trees, Array]:
    """The expected `cost` (N,), and what it is (N,) in bearings it was not fitted to."""
    from sklearn.ensemble import HistGradientBoostingRegressor

    model = HistGradientBoostingRegressor(**GUESSES, random_state=0)
    scored = ~((true_lag >= SHORTEST_TOLD) & (true_lag < SURELY_TOLD))
    expected = _out_of_fold(model, rows, cost, scored, groups)
    return to_trees(model.fit(rows[scored], cost[scored])), expected


def _out_of_fold(
    model: Any,
    rows: Array,
    aim: NDArray[Any],
    used: NDArray[np.bool_],
    groups: NDArray[np.str_],
    weight: Array | None = None,
) -> Array:
    from sklearn.base import clone
    from sklearn.model_selection import GroupKFold

    told, weight = np.zeros(aim.size), np.ones(aim.size) if weight is None else weight
    for fitted, others in GroupKFold(FOLDS).split(rows, groups=groups):
        fitted = fitted[used[fitted]]
        fold = clone(model).fit(rows[fitted], aim[fitted], weight[fitted])
        told[others] = fold.decision_function(rows[others]) if hasattr(fold, "classes_") else fold.predict(rows[others])
    return told


def to_trees(model: Any) -> Trees:
    """The trees of a fitted histogram gradient boosting model of scikit-learn as plain arrays."""
    parts, roots, count = [], [], 0
    for stage in model._predictors:
        nodes = stage[0].nodes
        roots.append(count)
        leaf = nodes["is_leaf"].astype(bool)
        parts.append(
            (
                np.where(leaf, -1, nodes["feature_idx"]).astype(np.int16),
                nodes["num_threshold"].astype(np.float32),
                (nodes["left"] + count).astype(np.int32),
                (nodes["right"] + count).astype(np.int32),
                np.where(leaf, nodes["value"], 0.0).astype(np.float32),
            )
        )
        count += nodes.size
    feature, threshold, left, right, value = (np.concatenate(column) for column in zip(*parts, strict=True))
    base = float(np.ravel(model._baseline_prediction)[0])
    return Trees(feature, threshold, left, right, value, np.array(roots, dtype=np.int32), base)


def main(corpora: list[str], file: str, workers: int = 2) -> None:
    """Fit to the training and validation splits of all `corpora` and write `file`."""
    by_corpus = [trials(Path(corpus), ("train", "validation"), workers) for corpus in corpora]
    made = [trial for own in by_corpus for trial in own]
    typical = np.arange(len(made)) < len(by_corpus[0])
    print(f"{len(made)} trials of {len({(trial.bearing_id, trial.record) for trial in made})} records")
    calibration = fit_calibration(made, typical)
    np.savez_compressed(file, **calibration.to_arrays())  # type: ignore[arg-type]
    print(f"{file}: {Path(file).stat().st_size} bytes")


if __name__ == "__main__":
    main(sys.argv[1:-1], sys.argv[-1])
