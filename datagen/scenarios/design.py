"""Space-filling designs: the numbers of a part's machines and records spread evenly over the space of its settings.

In a designed part each setting is a dimension, and takes its number from a point of the design instead of its stream:
settings of a machine from the point of the machine's place in the part, those of a record from that of the record's
place. The number of the stream then places the value inside the point's cell. Redraws (attempts from 1 on) leave the
design and take the numbers of their streams as they are.

`latin_hypercube`: each dimension puts exactly one machine (record) into each of as many equal strata as there are.
`sobol`: a scrambled Sobol sequence; any first 2^m of them put exactly one into each of 2^m strata, and pairs of
dimensions are spread evenly too, so the beginning of a corpus is already diverse.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from datagen.scenarios.streams import stream

# Streams whose first numbers are dimensions: (purpose, item, dimensions kept for it). Append only: the order is that of
# the Sobol dimensions. What has no dimension here is drawn freely: waviness, single balls, slip, roughness, noise.
DIMENSIONS = (
    ("defect", 0, 6),
    ("operation", 0, 24),
    ("spall", 0, 16),
    ("machine", 0, 80),
    ("signal", 0, 4),
    ("split", 0, 1),
    ("imperfections", 1, 2),
    ("background", 0, 4),
    ("chain", 0, 8),
    ("sensor_modes", 0, 24),
    ("pink_noise", 0, 4),
    ("shaft_harmonics", 0, 8),
    ("gear_mesh", 0, 16),
    ("mains_hum", 0, 8),
    ("impulses", 0, 10),
    ("recording", 0, 1),
    ("noise_target", 0, 1),
)
FIRSTS = tuple(accumulate((count for _, _, count in DIMENSIONS), initial=0))
PLACES = {(name, item): (first, count) for first, (name, item, count) in zip(FIRSTS, DIMENSIONS, strict=False)}
TOTAL = FIRSTS[-1]
BLOCK = 1024
SOBOL_RESOLUTION = 2.0**-30


@dataclass(frozen=True)
class Design:
    """The design of the part with index `part` of a recipe with that `seed`; `kind` is "random", "latin_hypercube" or
    "sobol"."""

    kind: str
    seed: int
    part: int

    def refine(self, dimension: int, point: int, points: int, number: float) -> float:
        """A number in [0, 1) in the cell of `point` (of `points`) along a dimension, placed in it by `number`."""
        if self.kind == "random":
            return number
        if self.kind == "sobol":
            block = sobol_block(self.seed, self.part, point // BLOCK)
            return float(block[point % BLOCK, dimension]) + number * SOBOL_RESOLUTION
        cells = _latin_cells(self.seed, self.part, points, dimension)
        return min((int(cells[point]) + number) / points, 1.0 - 2.0**-53)


def dimension_of(purpose: str, item: int, position: int) -> int | None:
    """The dimension of the `position`-th number of a stream, or None if it has none."""
    first, count = PLACES.get((purpose, item), (0, 0))
    return first + position if position < count else None


@lru_cache(maxsize=16)
def sobol_block(seed: int, part: int, block: int) -> NDArray[np.float64]:
    """Points (BLOCK, TOTAL) of the part's sequence, from point `block` · BLOCK on."""
    from scipy.stats import qmc

    engine = qmc.Sobol(TOTAL, scramble=True, rng=stream(seed, "part", part, "design"))
    if block:
        engine.fast_forward(block * BLOCK)
    return np.asarray(engine.random(BLOCK))


@lru_cache(maxsize=2 * TOTAL)
def _latin_cells(seed: int, part: int, points: int, dimension: int) -> NDArray[np.int32]:
    """The stratum (points,) of each point along one dimension."""
    from scipy.stats import qmc

    generator = stream(seed, "part", part, "design", item=1 + dimension)
    centres = qmc.LatinHypercube(1, scramble=False, rng=generator).random(points)[:, 0]
    return np.floor(centres * points).astype(np.int32)
