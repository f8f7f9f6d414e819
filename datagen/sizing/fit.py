"""The calibration fitted to trials of simulated machines: run as `python -m datagen.sizing.fit CORPUS FILE.npz`.

Every later stage learns from what the earlier ones say of virtual bearings that they were not fitted to (five folds),
and so do the reach of the intervals and the least trust.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.sizing.training_rows import Trial, trials
from labels.spall_size.calibration import SMALLEST_SPREAD, Calibration, Guess
from labels.spall_size.measurement import Measurement, measure
from labels.spall_size.trees import Trees

Array = NDArray[np.float64]

FOLDS = 5
COVERAGE = 0.90
RIGHT_WITHIN = 0.15
WANTED_ABSTENTION = 0.955
SHORTEST_TOLD, SURELY_TOLD = 2.0, 3.0  # samples
LARGEST_ERROR = 1.0
PAIRS = {"max_iter": 220, "learning_rate": 0.09, "max_leaf_nodes": 20, "min_samples_leaf": 40}
GUESSES = {"max_iter": 130, "learning_rate": 0.06, "max_leaf_nodes": 10, "min_samples_leaf": 15}
TRUST = {"max_iter": 120, "learning_rate": 0.05, "max_leaf_nodes": 8, "min_samples_leaf": 20}


def fit_calibration(made: list[Trial]) -> Calibration:
    """The calibration of the training trials `made`."""
    from sklearn.ensemble import HistGradientBoostingRegressor

    groups = np.array([trial.bearing_id for trial in made])
    score = HistGradientBoostingRegressor(**PAIRS, random_state=0)
    measured = _measured_out_of_fold(score, made, groups)
    score.fit(*_pair_table(made))
    rows = np.array([one.row for one in measured])
    loaded = np.array([one.row if one.load_row is None else one.load_row for one in measured])
    lag_error = np.log(np.array([trial.lag for trial in made]) / np.array([one.lag for one in measured]))
    arc = np.array([trial.arc for trial in made])
    arc_error = np.log(np.where(arc > 0.0, arc, np.nan) / np.array([one.lag_arc for one in measured]))
    lag, told = _guess(rows, lag_error, groups)
    right = np.where(np.isfinite(lag_error), np.abs(lag_error - told) < RIGHT_WITHIN, False)
    true_lag = np.array([trial.true_lag for trial in made])
    trust, least = _trust(rows, right, true_lag, groups)
    trust_with_load, least_with_load = _trust(loaded, right, true_lag, groups)
    return Calibration(
        pair_score=to_trees(score),
        lag=lag,
        arc=_guess(rows, arc_error, groups)[0],
        arc_with_load=_guess(loaded, arc_error, groups)[0],
        trust=trust,
        trust_with_load=trust_with_load,
        least=least,
        least_with_load=least_with_load,
    )


def _pair_table(made: list[Trial]) -> tuple[Array, Array]:
    features = np.concatenate([trial.evidence.pairs.features for trial in made])
    return features.astype(np.float32), np.concatenate([trial.quality for trial in made])


def _measured_out_of_fold(model: Any, made: list[Trial], groups: NDArray[np.str_]) -> list[Measurement]:
    from sklearn.base import clone
    from sklearn.model_selection import GroupKFold

    measured: dict[int, Measurement] = {}
    for fitted, others in GroupKFold(FOLDS).split(groups, groups=groups):
        fold = clone(model).fit(*_pair_table([made[k] for k in fitted]))
        for k in others:
            score = fold.predict(made[k].evidence.pairs.features.astype(np.float32))
            measured[k] = measure(made[k].evidence, score, made[k].situation)
    return [measured[k] for k in range(len(made))]


def _guess(rows: Array, error: Array, groups: NDArray[np.str_]) -> tuple[Guess, Array]:
    """The guess of `error` (N,) from `rows` (N, F), and what it says (N,) of bearings it was not fitted to."""
    from sklearn.ensemble import HistGradientBoostingRegressor

    known = np.isfinite(error)
    aim = np.clip(error, -LARGEST_ERROR, LARGEST_ERROR)
    centre = HistGradientBoostingRegressor(loss="absolute_error", **GUESSES, random_state=0)
    spread = HistGradientBoostingRegressor(**GUESSES, random_state=0)
    told = _out_of_fold(centre, rows, aim, known, groups)
    missed = np.abs(aim - told)
    width = np.maximum(_out_of_fold(spread, rows, missed, known, groups), 0.0) + SMALLEST_SPREAD
    reach = float(np.quantile((missed / width)[known], COVERAGE))
    fitted = centre.fit(rows[known], aim[known]), spread.fit(rows[known], missed[known])
    return Guess(to_trees(fitted[0]), to_trees(fitted[1]), reach), told


def _trust(rows: Array, right: NDArray[np.bool_], true_lag: Array, groups: NDArray[np.str_]) -> tuple[Trees, float]:
    """Log odds of a right lag, and the least of them at which records without events are told nothing of."""
    from sklearn.ensemble import HistGradientBoostingClassifier

    model = HistGradientBoostingClassifier(**TRUST, random_state=0)
    scored = ~((true_lag >= SHORTEST_TOLD) & (true_lag < SURELY_TOLD))
    odds = _out_of_fold(model, rows, right, scored, groups)
    nothing = ~(true_lag >= SHORTEST_TOLD)
    return to_trees(model.fit(rows[scored], right[scored])), float(np.quantile(odds[nothing], WANTED_ABSTENTION))


def _out_of_fold(
    model: Any, rows: Array, aim: NDArray[Any], used: NDArray[np.bool_], groups: NDArray[np.str_]
) -> Array:
    from sklearn.base import clone
    from sklearn.model_selection import GroupKFold

    told = np.zeros(aim.size)
    for fitted, others in GroupKFold(FOLDS).split(rows, groups=groups):
        fitted = fitted[used[fitted]]
        fold = clone(model).fit(rows[fitted], aim[fitted])
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


def main(corpus: str, file: str, workers: int = 2) -> None:
    """Fit to the training and validation splits of `corpus` and write `file`."""
    made = trials(Path(corpus), ("train", "validation"), workers)
    print(f"{len(made)} trials of {len({trial.record for trial in made})} records")
    calibration = fit_calibration(made)
    np.savez_compressed(file, **calibration.to_arrays())  # type: ignore[arg-type]
    print(f"{file}: {Path(file).stat().st_size} bytes; least trust {calibration.least:.2f}, with load "
          f"{calibration.least_with_load:.2f}; reach {calibration.lag.reach:.2f}")  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
