"""Small recordings written by other libraries, and imports of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from imports import Bring, noise

from datagen.corpus import Corpus
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec

HEAD = 'name = "mine"\n'


@pytest.fixture
def bring(tmp_path: Path) -> Bring:
    """A function that imports what a SPEC text names below `tmp_path` and opens the corpus."""

    def run(text: str, out: str = "corpus") -> Corpus:
        (tmp_path / "spec.toml").write_text(HEAD + text)
        import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / out)
        return Corpus(tmp_path / out)

    return run


@pytest.fixture
def mat(tmp_path: Path) -> Callable[..., np.ndarray]:
    """A function that writes a .mat file with one column `sig` and more variables; gives the column."""

    def write(name: str, samples: np.ndarray | None = None, **more: object) -> np.ndarray:
        column = noise(seed=sum(name.encode())) if samples is None else samples
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        scipy.io.savemat(path, {"sig": column[:, None], **more})
        return column

    return write
