"""The alarm: the probability of a spall above which a record is called faulty, such that few healthy ones are.

A stated share of all healthy records passes it, or less where it would lie lower for clear records than for noise, and
half of that share of those that look like noise. In a clear record a healthy bearing shows what it does: its stiffness
varies as balls pass, so the lines of BPFO stand in its envelopes. Under noise they do not, so a probability that means
little in a clear record means much there. The alarm therefore rises with how far a record's bands differ from noise,
which their median spectral kurtosis measures.

Whatever the probability, a record is called faulty too where a race's lines stand higher over the floor than in nearly
all healthy records. Learners want impulsiveness beside lines, and a spall heard through a narrow band has little.

Both are set for the mean of a record's axes, as for a single one. In the vote of several axes the one that says most
counts twice, so for that both lie higher, by as much as it raises healthy records.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from labels.classifier.log_odds import EDGE, logit, probability_of
from labels.classifier.rule import strengths
from labels.classifier.votes import averaged, raised
from labels.features.table import FEATURE_NAMES
from physics.arrays import Array, Flags

CLEARNESS = "median_band_kurtosis"
# Values of that feature below which a record looks like noise, and above which it is taken as clear.
NOISE_LIKE, CLEAR = 0.02, 0.06
# The share of false alarms among rows like noise over the share allowed among all healthy records.
SHARE_IN_NOISE = 0.5
# Kurtosis and mean clearness below this count as this, so that a logarithm and a quotient of them are finite.
SMALLEST = 1e-4
FEWEST_ROWS = 20
# Quantile of the healthy records' highest line family above which lines alone are an alarm: a rule that answers less
# often than the yardstick's, at 0.95.
LINES_QUANTILE = 0.98


def clearness(table: Array) -> Array:
    """How clear (N,) each row of the feature table (N, F) is: 0 like noise, 1 clear, with the logarithm between."""
    kurtosis = np.maximum(np.asarray(table)[:, FEATURE_NAMES.index(CLEARNESS)], SMALLEST)
    return np.clip(np.log(kurtosis / NOISE_LIKE) / np.log(CLEAR / NOISE_LIKE), 0.0, 1.0)


@dataclass(frozen=True)
class Alarm:
    """Probabilities of a spall at which a record like noise and a clear one are called, their logits between; and the
    height over the floor (infinite: none) of a race's line family above which a record is called whatever its
    probability.

    Of records of several axes these hold for what their axes say on average: their votes have to pass `several` more
    log odds, and their heights are divided by `height_several` before they are compared.
    """

    in_noise: float
    in_clear: float
    height: float = np.inf
    several: float = 0.0
    height_several: float = 1.0

    def at(self, table: Array, several: Flags | None = None) -> Array:
        """Probability (N,) of a spall above which each row of the feature table (N, F) is called faulty; `several` (N,)
        marks rows of records with several axes, none if None."""
        clear = clearness(table)
        low, high = logit(np.array([self.in_noise, self.in_clear]))
        more = 0.0 if several is None else self.several * several
        return probability_of(low * (1.0 - clear) + high * clear + more)

    def by_lines_alone(self, heights: Array) -> Flags:
        """Whether (R,) the `heights` (R, 2) of the races' lines are an alarm by themselves; NaN is none."""
        return np.asarray(heights.max(axis=1) > self.height)


def fit_alarm(
    spall: Array,
    table: Array,
    records: NDArray[np.int64],
    noisy: NDArray[np.bool_],
    axes: NDArray[np.int64],
    share: float,
) -> Alarm:
    """The alarm that at most a `share` of healthy records pass by the mean of their probabilities, SHARE_IN_NOISE times
    that of the rows like noise, and 1 − LINES_QUANTILE of the records by their lines.

    `spall` (N,) are probabilities of a spall for healthy rows (N, F) of bearings not learned from; rows of one of
    `records` (N,) vote together, and those marked `noisy` (N,) were made from it by adding noise: they say what noise
    does, not how often a record alarms. `axes` (N,) are the axes of the rows; without records of several, nothing is
    known of what a vote of several raises. ValueError if all are noisy.
    """
    if np.all(noisy):
        raise ValueError("no healthy record without added noise to set the alarm on")
    level, clear = logit(spall), clearness(table)
    low = _level_in_noise(level, clear, share)
    level, clear, table = level[~noisy], clear[~noisy], table[~noisy]
    records, axes = records[~noisy], axes[~noisy]
    high = np.clip(_level_in_clear(level, clear, low, records, share), low, -np.log(EDGE))
    in_noise, in_clear = probability_of(np.array([low, high]))
    lines = np.log(strengths(table))
    heights = averaged(lines, records, np.unique(records)).max(axis=1)
    alarm = Alarm(float(in_noise), float(in_clear), float(np.exp(np.quantile(heights, LINES_QUANTILE))))
    margin = level - logit(alarm.at(table))
    return replace(
        alarm,
        several=raised(margin[:, None], records, axes),
        height_several=float(np.exp(raised(lines, records, axes))),
    )


def _level_in_noise(level: Array, clear: Array, share: float) -> float:
    """Log odds that SHARE_IN_NOISE times a `share` of the rows like noise pass, by the `level` (N,) and clearness (N,)
    of rows; of all rows where few are like noise."""
    hidden = level[clear == 0.0] if np.sum(clear == 0.0) >= FEWEST_ROWS else level
    return float(np.quantile(hidden, 1.0 - SHARE_IN_NOISE * share))


def _level_in_clear(level: Array, clear: Array, low: float, records: NDArray[np.int64], share: float) -> float:
    """Log odds in the clear with which at most a `share` of the records alarm, those in noise being `low`; of rows of
    this `level` (N,) and clearness (N,), those of one of `records` (N,) by their mean. Infinite where none will do."""
    distinct = np.unique(records)
    above, weight = averaged(np.column_stack([level - low * (1.0 - clear), clear]), records, distinct).T
    # A record alarms where its mean level passes low (1 − clear) + high clear, that is where high lies below this:
    needed = np.where(weight > 0.0, above / np.maximum(weight, SMALLEST), np.where(above > 0.0, np.inf, -np.inf))
    return float(np.sort(needed)[::-1][min(int(share * distinct.size), distinct.size - 1)])
