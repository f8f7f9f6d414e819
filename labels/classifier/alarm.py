"""At what probability a spall is called: so that one healthy record in twenty is, and fewer where noise hides them.

In a clear record a healthy bearing shows what it does: its stiffness varies as balls pass, so the lines of BPFO stand
in its envelopes. Under noise they do not, and a probability that means little in a clear record means much. The alarm
therefore rises with how far a record's bands differ from noise, which their median spectral kurtosis tells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from labels.features.conditioning import Array
from labels.features.table import FEATURE_NAMES

CLEARNESS = "median_band_kurtosis"
NOISE_LIKE, CLEAR = 0.02, 0.06
"""Values of that feature below which a record cannot be told from noise, and above which it is taken as clear."""
SHARE_IN_NOISE = 0.5
"""Records like noise may raise this share of the alarms that are allowed on average; the clear ones raise the rest."""
EDGE = 1e-4
FEWEST_ROWS = 20


def clearness(table: Array) -> Array:
    """How clear (N,) each row of the feature table is: 0 like noise, 1 clear, with the logarithm between."""
    kurtosis = np.maximum(np.asarray(table)[:, FEATURE_NAMES.index(CLEARNESS)], EDGE)
    return np.clip(np.log(kurtosis / NOISE_LIKE) / np.log(CLEAR / NOISE_LIKE), 0.0, 1.0)


def logit(probability: Array) -> Array:
    """ln(p / (1 − p)) of probabilities, kept within 1e-4 of 0 and 1."""
    inside = np.clip(probability, EDGE, 1.0 - EDGE)
    return np.asarray(np.log(inside / (1.0 - inside)))


@dataclass(frozen=True)
class Alarm:
    """Probabilities of a spall at which a record like noise and a clear one are called; their logits between."""

    in_noise: float
    in_clear: float

    def at(self, table: Array) -> Array:
        """Probability (N,) of a spall at which each row of the feature table is called."""
        clear = clearness(table)
        low, high = logit(np.array([self.in_noise, self.in_clear]))
        return np.asarray(0.5 * (1.0 + np.tanh(0.5 * (low * (1.0 - clear) + high * clear))))


def fit_alarm(spall: Array, table: Array, records: NDArray[np.int64], noisy: NDArray[np.bool_], share: float) -> Alarm:
    """The alarm that `share` of healthy records pass, half of that of the rows that are like noise.

    `spall` (N,) are probabilities of a spall for healthy rows (N, F) of bearings not learned from; rows of one of
    `records` (N,) vote together, and those marked `noisy` (N,) were made from it by adding noise: they say what noise
    does, not how often a record alarms. ValueError if all are noisy.
    """
    if np.all(noisy):
        raise ValueError("no healthy record without added noise to set the alarm on")
    level, clear = logit(spall), clearness(table)
    hidden = level[clear == 0.0] if np.sum(clear == 0.0) >= FEWEST_ROWS else level
    low = float(np.quantile(hidden, 1.0 - SHARE_IN_NOISE * share))
    own, place = np.unique(records[~noisy], return_inverse=True)
    rows = np.bincount(place)
    above = np.bincount(place, (level - low * (1.0 - clear))[~noisy]) / rows
    weight = np.bincount(place, clear[~noisy]) / rows
    # A record alarms where its mean level passes low (1 − clear) + high clear, that is where high lies below this:
    needed = np.where(weight > 0.0, above / np.maximum(weight, EDGE), np.where(above > 0.0, np.inf, -np.inf))
    high = np.sort(needed)[::-1][min(int(share * own.size), own.size - 1)]
    low, high = (0.5 * (1.0 + np.tanh(0.5 * value)) for value in (low, float(np.clip(high, low, -np.log(EDGE)))))
    return Alarm(float(low), float(high))
