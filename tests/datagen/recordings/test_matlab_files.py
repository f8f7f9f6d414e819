"""Arrays of structures and cell arrays, as data acquisition saves its channels, from .mat files old and new."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.io
from imports import Bring, refusal

from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.formats.arrays import Arrays, choose
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import read_arrays

SPEED, VIBRATION = np.full(80, 900.0), np.random.default_rng(3).standard_normal(320)
CHANNELS = [("speed", SPEED), ("vibration_1", VIBRATION)]


def old_file(path: Path) -> None:
    """A structure of an array of structures, and a cell array, as MATLAB saves them by default."""
    channels = np.empty((1, 2), dtype=[("Name", object), ("Data", object)])
    cells = np.empty((2, 1), dtype=object)
    for place, (name, data) in enumerate(CHANNELS):
        channels[0, place] = (name, data[None, :])
        cells[place, 0] = data
    scipy.io.savemat(path, {"run_1": {"Y": channels, "note": "none"}, "parts": cells})


def new_file(path: Path) -> None:
    """The same as MATLAB saves it with -v7.3: the elements lie apart and are referred to."""
    with h5py.File(path, "w", userblock_size=512) as file:
        fields = file.create_group("run_1/Y")
        parts = labelled(file.create_dataset("parts", (1, 2), h5py.ref_dtype), "cell")
        for field in ("Name", "Data"):
            fields.create_dataset(field, (2, 1), h5py.ref_dtype)
        for place, (name, data) in enumerate(CHANNELS):
            text = np.array([[ord(letter)] for letter in name], dtype="u2")
            fields["Name"][place, 0] = labelled(file.create_dataset(f"#refs#/n{place}", data=text), "char").ref
            numbers = labelled(file.create_dataset(f"#refs#/d{place}", data=data[:, None]), "double")
            fields["Data"][place, 0] = parts[0, place] = numbers.ref
        empty = labelled(file.create_dataset("empty", data=np.array([0, 0], dtype="u8")), "double")
        empty.attrs["MATLAB_empty"] = np.uint8(1)
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(512, b"\0") + path.read_bytes()[512:])


def labelled(dataset: Any, kind: str) -> Any:
    dataset.attrs["MATLAB_class"] = np.bytes_(kind)
    return dataset


def read(path: Path) -> Arrays:
    return read_arrays(path, None, CsvLayout())


@pytest.mark.parametrize("write", [old_file, new_file])
def test_elements_of_arrays_of_structures_and_of_cell_arrays_are_counted_from_0(
    write: Callable[[Path], None], tmp_path: Path
) -> None:
    path = tmp_path / "run_1.mat"
    write(path)
    arrays = read(path)
    assert set(arrays) - {"empty"} == {"run_1.Y[0].Data", "run_1.Y[1].Data", "parts[0]", "parts[1]"}
    for wish in ("run_1.Y[1].Data", "{stem}.Y[1].Data", "*.Y[1].Data", "parts[1]", "parts[1][0,:]|parts[1][:,0]"):
        assert np.array_equal(choose(arrays, wish, path, "y"), VIBRATION)


def test_elements_of_a_table_of_them_are_counted_column_by_column(tmp_path: Path) -> None:
    structures, cells = np.empty((2, 3), dtype=[("Data", object)]), np.empty((2, 3), dtype=object)
    for row, column in np.ndindex(2, 3):
        structures[row, column] = cells[row, column] = np.array([[10.0 * row + column]])
    scipy.io.savemat(tmp_path / "a.mat", {"S": structures, "C": cells})
    arrays = read(tmp_path / "a.mat")
    for names in ("S[{}].Data", "C[{}]"):
        found = [arrays[names.format(place)].item() for place in range(6)]
        assert found == [0.0, 10.0, 1.0, 11.0, 2.0, 12.0]


def test_an_empty_array_of_version_7_3_is_empty(tmp_path: Path) -> None:
    new_file(tmp_path / "run_1.mat")
    assert read(tmp_path / "run_1.mat")["empty"].size == 0


def test_a_text_of_several_lines_of_version_7_3_is_no_number(tmp_path: Path) -> None:
    path = tmp_path / "a.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, lines in (("one", ["12"]), ("two", ["12", "34"])):
            letters = np.array([[ord(letter) for letter in line] for line in lines], dtype="u2")
            labelled(file.create_dataset(name, data=letters.T), "char")
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(512, b"\0") + path.read_bytes()[512:])
    arrays: Any = read(path)
    assert {name: float(array[0]) for name, array in arrays.items()} == {"one": 12.0}
    assert arrays.unread == ["two"]


def test_a_file_of_version_7_3_that_breaks_off_is_refused_with_its_name(tmp_path: Path) -> None:
    path = tmp_path / "run_1.mat"
    new_file(path)
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(BadInput, match=r"run_1\.mat: cannot be read as a \.mat file of version 7\.3: "):
        read(path)


def test_a_file_without_numbers_is_told_so(tmp_path: Path) -> None:
    scipy.io.savemat(tmp_path / "a.mat", {"sig": "only words"})
    with pytest.raises(BadInput, match=r'a\.mat: y = "sig": the file holds no numbers$'):
        choose(read(tmp_path / "a.mat"), "sig", tmp_path / "a.mat", "y")


@pytest.mark.parametrize("write", [old_file, new_file])
def test_a_text_is_told_from_what_is_not_there(write: Callable[[Path], None], tmp_path: Path) -> None:
    path = tmp_path / "run_1.mat"
    write(path)
    told = (
        r'y = "{}": is a text, a table or a sparse matrix, which are not read; allowed: the number itself, or .*parts'
    )
    with pytest.raises(BadInput, match=told.format(r"run_1\.Y\[0\]\.Name")):
        choose(read(path), "run_1.Y[0].Name", path, "y")
    with pytest.raises(BadInput, match="the file has no such variable"):
        choose(read(path), "run_1.Y[0].Named", path, "y")


def test_a_vibration_comes_in_with_the_speed_of_a_slower_channel_beside_it(
    bring: Callable[..., Corpus], tmp_path: Path
) -> None:
    old_file(tmp_path / "run_1.mat")
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "m/s2"\nrate_hz = 64000\n'
        'y = "{stem}.Y[1].Data"\nspeed_rpm = {variable = "{stem}.Y[0].Data"}\n'
    )
    assert np.array_equal(corpus.signal(0), VIBRATION.astype(np.float32))
    assert corpus.labels["speed_rpm"].tolist() == [900.0]


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        (np.ones(40) + 1j, "holds complex128, not real numbers"),
        (np.zeros((0, 0)), "holds 0 samples; allowed: at least"),
    ],
)
def test_what_cannot_be_a_signal_is_called_by_what_it_is(
    value: np.ndarray, problem: str, bring: Bring, tmp_path: Path
) -> None:
    scipy.io.savemat(tmp_path / "a.mat", {"acc": value, "fs": 1000.0})
    message = refusal(
        bring, '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "acc"\n', tmp_path
    )
    assert f'y = "acc": {problem}' in message
