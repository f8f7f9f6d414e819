"""How the energy runs through each event of a pair, in windows that scale with the lag between them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.mean_pass import MeanPass
from labels.spall_size.pair_features import Pairs
from labels.spall_size.running_energy import RunningEnergy

Array = NDArray[np.float64]

EDGES = (-0.5, -0.35, -0.25, -0.17, -0.1, -0.05, -0.02, 0.02, 0.05, 0.1, 0.17, 0.25, 0.35, 0.5)
PROFILED = (0, 1, 3)
RIVALS = 3
# Logarithms of the ratio of two lags: up to SAME they say the same, up to NEAR they may mean the same events.
SAME, NEAR = 0.03, 0.3


def profile_columns(mean: MeanPass, entry: Array, leave: Array, lag: Array) -> Array:
    """Log energies (P, 78) in 13 windows round either event of each pair, of the whole signal and of its low and high
    band."""
    summed = RunningEnergy(mean)
    edges = np.array(EDGES) * lag[:, None]
    middle, half = 0.5 * (edges[:, 1:] + edges[:, :-1]), np.maximum(0.5 * np.diff(edges, axis=1), 0.5)
    levels = []
    for place in (entry, leave):
        level = summed.level(place[:, None] + middle - half, place[:, None] + middle + half)
        levels += [level[channel] for channel in PROFILED]
    return np.concatenate(levels, axis=1)


def rival_columns(pairs: Pairs, score: Array, best: int) -> list[float]:
    """Score of the best pair, then the score and log relative lag of the next ones that differ from it in lag."""
    columns = [float(score[best])]
    order = np.argsort(-score)
    apart = np.abs(np.log(pairs.lag[order] / pairs.lag[best])) > SAME
    rivals = order[apart][:RIVALS]
    for k in range(RIVALS):
        if k < rivals.size:
            columns += [float(score[rivals[k]]), float(np.log(pairs.lag[rivals[k]] / pairs.lag[best]))]
        else:
            columns += [0.0, 0.0]
    near = np.abs(np.log(pairs.lag / pairs.lag[best])) < NEAR
    weight = np.maximum(score, 0.0) ** 2 * near
    return [*columns, float((weight * np.log(pairs.lag / pairs.lag[best])).sum() / max(weight.sum(), 1e-12))]
