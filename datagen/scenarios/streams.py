"""Random streams: every random number follows from (seed, scope, index, purpose) alone, on any worker, in any order.

A stream is `numpy.random.default_rng(SeedSequence(seed, spawn_key=(scope, index, purpose, attempt, item)))`. The lists
below are append-only: their order is part of every corpus ever made. `attempt` counts redraws of impossible draws from
0; `item` tells apart several things of one kind (the spalls of a race, the cages of a bearing).
"""

from __future__ import annotations

import numpy as np

SCOPES = ("record", "machine", "part")
PURPOSES = (
    "machine",
    "signal",
    "imperfections",
    "background",
    "split",
    "operation",
    "defect",
    "spall",
    "slip",
    "roughness",
    "white_noise",
    "chain",
    "sensor_modes",
    "pink_noise",
    "shaft_harmonics",
    "gear_mesh",
    "mains_hum",
    "impulses",
    "recording",
    "noise_target",
    "design",
    "balance_machines",
    "balance_records",
    "stated_speed",
    "bootstrap",
)
RULE = (
    "numpy.random.default_rng(SeedSequence(recipe, spawn_key=(scope, index, purpose, attempt, item))), scope and "
    "purpose being places in the lists of scopes and purposes, from 0; the layers of the background have the scope "
    "'record', index record, attempt record_attempt and item 0"
)
LARGEST_INDEX = 2**32 - 1


def stream(seed: int, scope: str, index: int, purpose: str, attempt: int = 0, item: int = 0) -> np.random.Generator:
    """A fresh generator at the start of the stream of one purpose of one record, machine (virtual bearing) or part.

    ValueError if the scope or the purpose is unknown, or a number is not from 0 to 2³² − 1.
    """
    for name, number in (("index", index), ("attempt", attempt), ("item", item)):
        if not 0 <= number <= LARGEST_INDEX:
            raise ValueError(f"{name} = {number}; allowed: 0 to {LARGEST_INDEX}")
    key = (SCOPES.index(scope), index, PURPOSES.index(purpose), attempt, item)
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
