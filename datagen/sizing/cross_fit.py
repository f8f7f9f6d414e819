"""How a calibration fares on training records of bearings that it was not fitted to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Array

ANSWERED_SHARES = (0.80, 0.85, 0.90, 0.95, 0.98)


@dataclass(frozen=True)
class CrossFit:
    """The relative `error` (N,) of the lags of N records that should be given a size, and the `expected` error (N,); no
    size is given where that is above `most`."""

    error: Array
    expected: Array
    most: float

    def most_within(self, error: float) -> float:
        """The limit on the expected error, at most `most`, up to which the mean error of the sizes given is at most
        `error`; the smallest expected error if even the error of that record is larger."""
        ordered = np.argsort(self.expected, kind="stable")
        ordered = ordered[self.expected[ordered] <= self.most]
        mean = np.cumsum(self.error[ordered]) / np.arange(1, ordered.size + 1)
        if ordered.size == 0 or mean[-1] <= error:
            return self.most
        within = np.flatnonzero(mean <= error)
        return float(self.expected[ordered[within[-1] if within.size else 0]])

    def lines(self) -> list[str]:
        """In words: the share without a size, the error of the others, and the error if another share were given a
        size."""
        answered = self.expected <= self.most
        ordered = self.error[np.argsort(self.expected, kind="stable")]
        shares = [f"{share:.0%}: {_mean(ordered[: round(share * ordered.size)]):.1%}" for share in ANSWERED_SHARES]
        return [
            f"{answered.size} records ask for a size: with {self.most:.2f} at most {1.0 - _mean(answered):.1%} get "
            f"none, lag error {_mean(self.error[answered]):.1%}",
            f"lag error by share answered: {', '.join(shares)}",
        ]


def _mean(values: NDArray[np.bool_] | Array) -> float:
    return float(np.mean(values)) if values.size else float("nan")
