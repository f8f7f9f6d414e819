"""Scores of a classifier, each with the 95 % interval that a bootstrap over records gives it, or their number alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv

from labels.interval import Interval
from physics.arrays import Array

DRAWS = 2000
# As many as are drawn for scores that take longer.
FEWER_DRAWS = 500
SEED = 1963
LEVEL = 0.95
# Records with and without a fault, below which an area under the ROC gets no interval.
FEWEST_A_SIDE = 5
# Spread of a score over the draws that is rounding alone.
SAME = 1e-9
# Share of a value by which the lower ends of bins differ at least.
NEAR = 3e-3
# ... and by this at least: ratios set to 0 dB are 0 but for rounding.
ROUNDING = 1e-9
Names = NDArray[Any]
Stratum = list[NDArray[np.int64]]
Score = Callable[..., float]


def balanced_accuracy(truth: Names, said: Names, classes: Sequence[str] | None = None) -> float:
    """Mean over the classes (those in `truth` if not given) of the share of each one's records that are called right.

    `truth` and `said` (N,) are the true class of each record and the one it was given. Classes without a record do not
    count; NaN if none has one.
    """
    truth, said = np.asarray(truth), np.asarray(said)
    right, shares = truth == said, []
    for name in sorted(set(truth.tolist())) if classes is None else classes:
        its_own = truth == name
        if count := np.count_nonzero(its_own):
            shares.append(np.count_nonzero(right & its_own) / count)
    return sum(shares) / len(shares) if shares else float("nan")


def accuracy(truth: Names, said: Names) -> float:
    """Share of records whose class in `said` (N,) is the one in `truth` (N,); NaN without records."""
    truth = np.asarray(truth)
    return float(np.mean(truth == np.asarray(said))) if truth.size else float("nan")


def area_under_roc(positive: NDArray[np.bool_], score: Array) -> float:
    """Probability that a `positive` (N,) record has a higher `score` (N,) than a negative one, ties counting half; NaN
    unless there are both."""
    positive, score = np.asarray(positive, dtype=bool), np.asarray(score, dtype=np.float64)
    count, other = int(positive.sum()), int((~positive).sum())
    if count == 0 or other == 0:
        return float("nan")
    _, place, repeats = np.unique(score, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(repeats) - 0.5 * (repeats - 1))[place]
    return float((ranks[positive].sum() - 0.5 * count * (count + 1)) / (count * other))


def bootstrap(
    score: Score,
    *columns: Names,
    strata: Names | None = None,
    groups: Names | None = None,
    draws: int = DRAWS,
    limits: tuple[float, float] = (0.0, 1.0),
    unseen: bool = True,
) -> Interval:
    """`score` of the columns (N,) of records, with its 95 % interval from a bootstrap over records.

    Records are drawn anew within each stratum of `strata` (N,). Rows of one group of `groups` (N,) are drawn together
    and belong to the stratum of the first of them. A stratum whose draws all give the same score seems certain, though
    it may have one record: it adds what its number of groups allows within the `limits` of the score, as if it were
    independent of the draws [MOVER: Zou & Donner 2008, Stat. Med. 27]; without `unseen`, only where all strata are so.
    The ends are NaN without records, and if no draw gives a score.
    """
    columns = tuple(np.asarray(column) for column in columns)
    if columns[0].size == 0:
        return Interval(score(*columns), float("nan"), float("nan"))
    members = _units(columns[0].size, strata, groups)
    drawn = _drawn(score, columns, members, draws)
    found = _interval(score(*columns), drawn)
    if not np.isfinite(drawn).any():
        return found
    same = np.ptp(drawn[np.isfinite(drawn)]) < SAME
    alike = [stratum for stratum in members if same or (unseen and _is_certain(score, columns, stratum))]
    if not alike:
        return found
    share = unseen_share([len(stratum) for stratum in alike]) * len(alike) / len(members)
    slack = share * _reach(score, columns, alike, limits)
    below = math.hypot(max(found.value - found.low, 0.0), slack)
    above = math.hypot(max(found.high - found.value, 0.0), slack)
    return Interval(found.value, max(found.value - below, limits[0]), min(found.value + above, limits[1]))


def paired_difference(
    score: Score,
    truth: Names,
    said: Names,
    rival: Names,
    strata: Names | None = None,
    groups: Names | None = None,
    draws: int = DRAWS,
) -> Interval:
    """`score`(truth, said) minus `score`(truth, rival), with its interval from a bootstrap that draws the same records
    for both.

    `said` and `rival` (N,) are two answers to the same `truth` (N,); `strata` and `groups` (N,) as in `bootstrap`.
    Classes in which both score alike add nothing if others differ: few records of one class must not hide that an
    answer is worse in another.
    """

    def difference(truth: Names, said: Names, rival: Names) -> float:
        return score(truth, said) - score(truth, rival)

    limits = (-1.0, 1.0)
    return bootstrap(
        difference, truth, said, rival, strata=strata, groups=groups, draws=draws, limits=limits, unseen=False
    )


def area_interval(
    positive: NDArray[np.bool_],
    score: Array,
    rival: Array | None = None,
    groups: Names | None = None,
) -> Interval:
    """Area under the ROC of a score (N,), or by how much it exceeds that of a `rival` score (N,), with its interval.

    The bootstrap draws `positive` (N,) and negative records separately. The ends of the interval are NaN if either side
    has fewer than five `groups` (N,). If every draw gives the same area, the interval allows for positives and
    negatives unlike those seen.
    """
    positive = np.asarray(positive, dtype=bool)
    value = area_under_roc(positive, score) - (0.0 if rival is None else area_under_roc(positive, rival))
    sides = [len(stratum) for stratum in _units(positive.size, positive, groups)] if positive.size else []
    if len(sides) < 2 or min(sides) < FEWEST_A_SIDE:
        return Interval(value, float("nan"), float("nan"))
    if rival is None:
        return bootstrap(area_under_roc, positive, score, strata=positive, groups=groups, draws=FEWER_DRAWS)
    return paired_difference(area_under_roc, positive, score, rival, positive, groups, FEWER_DRAWS)


def unseen_share(counts: Sequence[int]) -> float:
    """Largest share (mean over strata of that many units) of units unlike all those seen, with 97.5 % certainty.

    For one stratum the end of the exact binomial interval of 0 in n, 1 − 0.025^(1/n) [Clopper & Pearson 1934]; for
    several the largest mean of shares under which seeing none still has a probability of 0.025.
    """
    numbers = np.sort(np.asarray(counts, dtype=np.float64))
    found = 0.0
    for some in range(1, numbers.size + 1):
        smallest = numbers[:some]
        # The seen shares p with the least sum and the product of p^n at 0.025 are proportional to n.
        seen = smallest * np.exp((np.log((1.0 - LEVEL) / 2.0) - np.sum(smallest * np.log(smallest))) / smallest.sum())
        if seen.max() <= 1.0:
            found = max(found, float(np.sum(1.0 - seen)) / numbers.size)
    return found


def exact_interval(count: float, total: int) -> Interval:
    """Share of `count` in `total` (1 or more) with the exact binomial interval [Clopper & Pearson 1934].

    A `count` between whole numbers, as of a mean over repeats, has an interval between theirs.
    """
    tail = (1.0 - LEVEL) / 2.0
    low = betaincinv(count, total - count + 1.0, tail) if count > 0.0 else 0.0
    high = betaincinv(count + 1.0, total - count, 1.0 - tail) if count < total else 1.0
    return Interval(count / total, float(low), float(high))


def _is_certain(score: Score, columns: tuple[Names, ...], stratum: Stratum) -> bool:
    """Whether every unit of a stratum has one and the same score of its own, so that its draws cannot differ."""
    unlike = {tuple(tuple(column[unit].tolist()) for column in columns): unit for unit in stratum}
    scores = np.array([score(*(column[unit] for column in columns)) for unit in unlike.values()])
    return bool(np.isfinite(scores).all() and np.ptp(scores) < SAME)


def _reach(score: Score, columns: tuple[Names, ...], members: list[Stratum], limits: tuple[float, float]) -> float:
    """How far the score could move, as a mean over strata, if no record were like those seen."""

    def room(value: float) -> float:
        return max(value - limits[0], limits[1] - value)

    alone = [score(*(column[np.concatenate(stratum)] for column in columns)) for stratum in members]
    # A score that needs all strata at once, such as an area under the ROC, may be moved by any of them to its limits.
    return max(room(value) if np.isfinite(value) else len(members) * room(score(*columns)) for value in alone)


def _units(size: int, strata: Names | None, groups: Names | None) -> list[Stratum]:
    """The rows of each group, by stratum."""
    labels = np.zeros(size, dtype=np.int64) if strata is None else np.unique(strata, return_inverse=True)[1]
    owners = np.arange(size) if groups is None else np.unique(groups, return_inverse=True)[1]
    order = np.argsort(owners, kind="stable")
    rows = np.split(order, np.flatnonzero(np.diff(owners[order])) + 1)
    found = [[unit for unit in rows if labels[unit[0]] == label] for label in np.unique(labels)]
    return [stratum for stratum in found if stratum]


def _drawn(score: Score, columns: tuple[Names, ...], members: list[Stratum], draws: int) -> Array:
    generator = np.random.default_rng(SEED)
    # Rows of their own are chosen as one array, which takes a fraction of the time.
    alone = [np.concatenate(stratum) if all(unit.size == 1 for unit in stratum) else None for stratum in members]
    found = np.empty(draws)
    for draw in range(draws):
        chosen: Stratum = []
        for stratum, rows in zip(members, alone, strict=True):
            places = generator.integers(0, len(stratum), len(stratum))
            chosen += [stratum[place] for place in places] if rows is None else [rows[places]]
        drawn = np.concatenate(chosen)
        found[draw] = score(*(column[drawn] for column in columns))
    return found


def _interval(value: float, drawn: Array) -> Interval:
    drawn = drawn[np.isfinite(drawn)]
    if drawn.size == 0:
        return Interval(value, float("nan"), float("nan"))
    low, high = np.quantile(drawn, ((1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0))
    return Interval(value, float(low), float(high))


def confusion(truth: Names, said: Names, rows: Sequence[str], columns: Sequence[str]) -> NDArray[np.int64]:
    """Number of records (R, C) whose class in `truth` (N,) is each of `rows` and in `said` (N,) each of `columns`."""
    truth, said = np.asarray(truth), np.asarray(said)
    counts = [[int(np.sum((truth == row) & (said == column))) for column in columns] for row in rows]
    return np.array(counts, dtype=np.int64)


def _starts(quantity: Array, bins: int) -> Array:
    """Lower ends (B,) of so many bins of a `quantity` (N,): values of it, so that none parts those that are nearly
    the same, as are measurements of one speed."""
    values = np.sort(quantity)
    parted = np.quantile(values, np.linspace(0.0, 1.0, bins, endpoint=False))
    starts = np.unique(values[np.searchsorted(values, parted - _near(parted))])
    return starts[np.diff(starts, prepend=-np.inf) > _near(starts)]


def _near(values: Array) -> Array:
    """How far from each of the `values` (N,) others are nearly the same."""
    return np.maximum(NEAR * np.abs(values), ROUNDING)


def accuracy_against(
    quantity: Array, right: NDArray[np.bool_], bins: int = 5, groups: Names | None = None
) -> list[dict[str, float]]:
    """Accuracy, the share of `right` (N,) answers, with its interval in bins of a `quantity` (N,), NaN left out.

    The bins hold equally many records; bins whose values are nearly the same are merged. Each row gives the median `at`
    of the quantity, the number of `records`, and the `accuracy` with the ends `low` and `high` of its interval. Rows of
    one group of `groups` (N,) are drawn together.
    """
    quantity, right = np.asarray(quantity, dtype=np.float64), np.asarray(right, dtype=bool)
    known = np.isfinite(quantity)
    quantity, right = quantity[known], right[known]
    owners = np.flatnonzero(known) if groups is None else np.asarray(groups)[known]
    if quantity.size == 0:
        return []
    place = np.searchsorted(_starts(quantity, bins), quantity, side="right") - 1
    table = []
    for bin_ in np.unique(place):
        rows = place == bin_
        found = bootstrap(lambda hits: float(np.mean(hits)), right[rows], groups=owners[rows], draws=FEWER_DRAWS)
        middle = float(np.median(quantity[rows]))
        table.append(
            {"at": middle, "records": int(rows.sum()), "accuracy": found.value, "low": found.low, "high": found.high}
        )
    return table
