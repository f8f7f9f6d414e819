"""The quasi-static stiffness over a record, solved at as few instants as will do, with its error."""

from __future__ import annotations

import math
from typing import NamedTuple

from physics.arrays import Array
from physics.scene import Scene
from physics.statics.rest_series import TOLERANCE, XX, XY, YY, coarsest_stride, rest_series

# Beside corners, where balls take or lose their load, polynomials miss more than their difference says: up to 14 times
# as much, over the record, in 80 records of the wide corpus and of both rigs.
ERROR_FACTOR = 15.0


class StiffnessSeries(NamedTuple):
    """`stiffness` (T, 3): kxx, kyy, kxy in N/m; its estimated `error`, RMS of the worst component over the mean of kyy;
    and the share of the instants that was `solved`."""

    stiffness: Array
    error: float
    solved: float


def stiffness_series(scene: Scene, step: float, count: int) -> StiffnessSeries:
    """The stiffness at the `count` instants k · `step` (s), each at its instant's load and angles.

    Raises SimulationFailed where no position of the shaft carries the load.
    """
    rows, missed, share = rest_series(scene, step, count, coarsest_stride(scene, step))
    mean = rows[:count, YY].mean()
    error = math.hypot(ERROR_FACTOR * math.sqrt(missed.max()) / mean, TOLERANCE) if mean > 0.0 else 0.0
    return StiffnessSeries(rows[:count, XX : XY + 1], error, share)
