"""Scores of a classifier, each with the interval that a bootstrap over records gives it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.features.conditioning import Array

DRAWS = 2000
SEED = 1963
LEVEL = 0.95
Names = NDArray[Any]
Score = Callable[..., float]


@dataclass(frozen=True)
class Interval:
    """A score and the bootstrap interval (95 %) of it; NaN where it is not defined."""

    value: float
    low: float
    high: float


def balanced_accuracy(truth: Names, said: Names, classes: Sequence[str] | None = None) -> float:
    """Mean over the classes (those in `truth` if not given) of the share of their records that is called by its name.

    Classes without a record do not count; NaN if none has one.
    """
    truth, said = np.asarray(truth), np.asarray(said)
    names = np.unique(truth) if classes is None else classes
    shares = [float(np.mean(said[truth == name] == name)) for name in names if (truth == name).any()]
    return float(np.mean(shares)) if shares else float("nan")


def accuracy(truth: Names, said: Names) -> float:
    """Share of records called by their name; NaN without records."""
    truth = np.asarray(truth)
    return float(np.mean(truth == np.asarray(said))) if truth.size else float("nan")


def area_under_roc(positive: NDArray[np.bool_], score: Array) -> float:
    """Probability that a positive record scores above a negative one, ties counting half; NaN without both."""
    positive, score = np.asarray(positive, dtype=bool), np.asarray(score, dtype=np.float64)
    count, other = int(positive.sum()), int((~positive).sum())
    if count == 0 or other == 0:
        return float("nan")
    _, place, repeats = np.unique(score, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(repeats) - 0.5 * (repeats - 1))[place]
    return float((ranks[positive].sum() - 0.5 * count * (count + 1)) / (count * other))


def bootstrap(score: Score, *columns: Names, strata: Names | None = None, draws: int = DRAWS) -> Interval:
    """`score` of the columns (N,) of records and its 95 % interval over records drawn anew, within each of `strata`."""
    columns = tuple(np.asarray(column) for column in columns)
    values = _drawn(score, columns, strata, draws)
    return _interval(score(*columns), values)


def paired_difference(
    score: Score, truth: Names, said: Names, rival: Names, strata: Names | None = None, draws: int = DRAWS
) -> Interval:
    """`score`(truth, said) minus `score`(truth, rival), with the interval over records drawn anew for both at once."""

    def difference(drawn: Names, own: Names, other: Names) -> float:
        return score(drawn, own) - score(drawn, other)

    return bootstrap(difference, truth, said, rival, strata=strata, draws=draws)


def _drawn(score: Score, columns: tuple[Names, ...], strata: Names | None, draws: int) -> Array:
    generator = np.random.default_rng(SEED)
    size = columns[0].size
    if size == 0:
        return np.full(1, np.nan)
    labels = np.zeros(size, dtype=np.int64) if strata is None else np.unique(strata, return_inverse=True)[1]
    members = [np.flatnonzero(labels == label) for label in np.unique(labels)]
    found = np.empty(draws)
    for draw in range(draws):
        rows = np.concatenate([generator.choice(own, own.size) for own in members])
        found[draw] = score(*(column[rows] for column in columns))
    return found


def _interval(value: float, drawn: Array) -> Interval:
    drawn = drawn[np.isfinite(drawn)]
    if drawn.size == 0:
        return Interval(value, float("nan"), float("nan"))
    low, high = np.quantile(drawn, ((1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0))
    return Interval(value, float(low), float(high))


def confusion(truth: Names, said: Names, rows: Sequence[str], columns: Sequence[str]) -> NDArray[np.int64]:
    """Number of records (R, C) whose truth is each of `rows` and that are called each of `columns`."""
    truth, said = np.asarray(truth), np.asarray(said)
    counts = [[int(np.sum((truth == row) & (said == column))) for column in columns] for row in rows]
    return np.array(counts, dtype=np.int64)


def reliability(positive: NDArray[np.bool_], probability: Array, bins: int = 10) -> dict[str, list[float]]:
    """Of records by predicted probability in equal bins: the mean `predicted`, the share `observed` and their number
    `records`; empty bins are left out."""
    positive, probability = np.asarray(positive, dtype=bool), np.asarray(probability)
    place = np.minimum((probability * bins).astype(np.int64), bins - 1)
    used = [place == bin_ for bin_ in range(bins) if (place == bin_).any()]
    return {
        "predicted": [float(probability[rows].mean()) for rows in used],
        "observed": [float(positive[rows].mean()) for rows in used],
        "records": [float(rows.sum()) for rows in used],
    }


def calibration_error(positive: NDArray[np.bool_], probability: Array, bins: int = 10) -> float:
    """Mean distance between predicted probability and observed share over the bins, weighted by records."""
    curve = reliability(positive, probability, bins)
    weights = np.array(curve["records"])
    if weights.size == 0:
        return float("nan")
    gaps = np.abs(np.array(curve["predicted"]) - np.array(curve["observed"]))
    return float((gaps * weights).sum() / weights.sum())


def accuracy_against(quantity: Array, right: NDArray[np.bool_], bins: int = 5) -> list[dict[str, float]]:
    """Accuracy with its interval in bins of equally many records of a `quantity` (N,), NaN left out."""
    quantity, right = np.asarray(quantity, dtype=np.float64), np.asarray(right, dtype=bool)
    known = np.isfinite(quantity)
    quantity, right = quantity[known], right[known]
    if quantity.size == 0:
        return []
    edges = np.unique(np.quantile(quantity, np.linspace(0.0, 1.0, bins + 1)))
    place = np.clip(np.searchsorted(edges, quantity, side="right") - 1, 0, max(edges.size - 2, 0))
    table = []
    for bin_ in np.unique(place):
        rows = place == bin_
        found = bootstrap(lambda own: float(np.mean(own)), right[rows], draws=500)
        middle = float(np.median(quantity[rows]))
        table.append(
            {"at": middle, "records": int(rows.sum()), "accuracy": found.value, "low": found.low, "high": found.high}
        )
    return table
