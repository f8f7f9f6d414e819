"""NumPy's files that hold something else than one channel say what can be read of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from imports import Bring

from datagen.errors import BadInput

SPEC = '[[recording]]\nname = "all"\nunit = "g"\nrate_hz = 1000\n'
NOISE = np.random.default_rng(3).standard_normal((2, 400))


def test_python_objects_are_called_so_and_other_arrays_of_the_file_are_read(bring: Bring, tmp_path: Path) -> None:
    ragged = np.array([NOISE[0], NOISE[1, :100]], dtype=object)
    np.savez(tmp_path / "a.npz", ragged=ragged, good=NOISE[0])
    message = r"a\.npz: its array ragged holds Python objects, which are not read; allowed: arrays of numbers, one for"
    with pytest.raises(BadInput, match=message):
        bring(SPEC + 'files = "a.npz"\ny = "ragged"\n')
    assert len(bring(SPEC + 'files = "a.npz"\ny = "good"\n')) == 1
    np.save(tmp_path / "b.npy", ragged, allow_pickle=True)
    with pytest.raises(BadInput, match=r"b\.npy: it holds Python objects, which are not read; allowed: arrays of num"):
        bring(SPEC + 'files = "b.npy"\ny = "data"\n', "other")


@pytest.mark.parametrize(
    ("array", "way_out"), [(NOISE, 'row, as in "NAME[0,:]"'), (NOISE.T, 'column, as in "NAME[:,0]"')]
)
def test_a_table_of_channels_comes_with_the_way_to_one(
    array: np.ndarray, way_out: str, bring: Bring, tmp_path: Path
) -> None:
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(BadInput) as refused:
        bring(SPEC + 'files = "a.npy"\ny = "data"\n')
    assert str(refused.value).endswith(f"allowed: one {way_out}")
