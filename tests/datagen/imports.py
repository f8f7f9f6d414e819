"""What tests of imports share: a SPEC, kinds of fixtures that they ask for, noise, and how a refusal is read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from datagen.corpus import Corpus
from datagen.errors import BadInput

# Of one file with one axis.
SPEC = '[[recording]]\nname = "a"\nfiles = "a.mat"\ny = "sig"\nunit = "g"\nrate_hz = 1000\n'
Bring = Callable[..., Corpus]
Mat = Callable[..., np.ndarray]


def noise(size: int = 400, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(size)


def refusal(bring: Bring, text: str, tmp_path: Path) -> str:
    """The message of a refused import; nothing may be left of it."""
    before = {path.name for path in tmp_path.iterdir()} | {"spec.toml"}
    with pytest.raises(BadInput) as problem:
        bring(text)
    assert {path.name for path in tmp_path.iterdir()} == before
    return str(problem.value)
