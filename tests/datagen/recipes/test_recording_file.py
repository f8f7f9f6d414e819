"""Healthy recordings that a recipe names as a background."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.formats.csv_layout import CsvLayout
from datagen.recipes.recording_file import read_background

SAMPLES = np.random.default_rng(1).standard_normal(100)


def read(path: Path, rate: object):
    np.savez(path, data=SAMPLES, rate_hz=rate)
    return read_background(path, None, CsvLayout())


@pytest.mark.parametrize("rate", [1000, np.array([1000.0]), np.array([[1000.0]])])
def test_the_rate_that_a_file_states_is_taken(rate: object, tmp_path: Path) -> None:
    found = read(tmp_path / "bg.npz", rate)
    assert found.rate == 1000.0
    assert found.samples[:, 0] == pytest.approx(SAMPLES, rel=1e-6)


@pytest.mark.parametrize(
    ("rate", "told"), [(np.array([1000.0, 2000.0]), "2 values"), (np.array("fast"), "no number"), (1j, "no number")]
)
def test_a_rate_that_is_not_one_number_is_refused(rate: object, told: str, tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=f"bg.npz: rate_hz: it holds {told}; allowed: one number"):
        read(tmp_path / "bg.npz", rate)
