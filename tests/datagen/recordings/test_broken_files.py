"""Files that break off, as copies that were interrupted do, are refused in every format; groups of netCDF files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import h5py
import netCDF4
import numpy as np
import pytest
import scipy.io
from scipy.io import wavfile

from datagen.errors import BadInput
from datagen.formats.arrays import choose
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import read_arrays

SAMPLES = np.random.default_rng(2).standard_normal(2000)


def netcdf(model: str) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        with netCDF4.Dataset(path, "w", format=model) as file:
            file.createDimension("time", SAMPLES.size)
            file.createVariable("data", "f4", ("time",))[...] = SAMPLES

    return write


WRITERS: dict[str, Callable[[Path], object]] = {
    "short.wav": lambda path: wavfile.write(path, 8000, (SAMPLES * 1000.0).astype(np.int16)),
    "float.wav": lambda path: wavfile.write(path, 8000, SAMPLES.astype(np.float32)),
    "classic.nc": netcdf("NETCDF3_CLASSIC"),
    "offset.nc": netcdf("NETCDF3_64BIT_OFFSET"),
    "four.nc": netcdf("NETCDF4"),
    "a.npy": lambda path: np.save(path, SAMPLES),
    "a.npz": lambda path: np.savez(path, data=SAMPLES),
    "packed.npz": lambda path: np.savez_compressed(path, data=SAMPLES),
    "five.mat": lambda path: scipy.io.savemat(path, {"data": SAMPLES}),
    "four.mat": lambda path: scipy.io.savemat(path, {"data": SAMPLES}, format="4"),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_that_breaks_off_is_refused_with_its_name(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    WRITERS[name](path)
    assert choose(read_arrays(path, None, CsvLayout()), "data", path, "y").size == SAMPLES.size
    whole = path.read_bytes()
    for share in (0.6, 0.99):
        path.write_bytes(whole[: int(share * len(whole)) // 8 * 8])
        with pytest.raises(BadInput) as problem:
            read_arrays(path, None, CsvLayout())
        assert str(problem.value).startswith(f"{path}: ")
        assert "cannot be read as " in str(problem.value) or "the file is cut off: " in str(problem.value)


def test_a_wave_file_that_breaks_off_within_a_sample_of_its_channels_is_called_cut_off(tmp_path: Path) -> None:
    path = tmp_path / "stereo.wav"
    scipy.io.wavfile.write(path, 8000, np.zeros((500, 2), np.int16))
    path.write_bytes(path.read_bytes()[:-10])  # two samples and a half
    with pytest.raises(BadInput, match="the file is cut off: its last sample lacks channels"):
        read_arrays(path, None, CsvLayout())


@pytest.mark.parametrize("name", ["a.mat", "a.csv", "a.wav", "a.npz", "a.h5"])
def test_a_pointer_of_git_lfs_is_not_taken_for_a_damaged_file(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n")
    with pytest.raises(BadInput, match=r"holds no data but where Git LFS keeps it; allowed: .*git lfs pull"):
        read_arrays(tmp_path / name, None, CsvLayout())


@pytest.mark.parametrize("name", ["a.mat", "a.csv", "a.wav", "a.npz", "a.h5"])
def test_a_web_page_is_not_taken_for_a_damaged_file(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("\n<!DOCTYPE html>\n<html><body>404</body></html>\n")
    with pytest.raises(BadInput, match="is a web page, as of a download that failed; allowed: the data itself"):
        read_arrays(tmp_path / name, None, CsvLayout())


@pytest.mark.parametrize("name", ["short.wav", "float.wav", "classic.nc", "a.npy", "a.npz", "packed.npz"])
def test_whatever_bytes_are_damaged_a_file_is_read_or_refused_with_its_name(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    WRITERS[name](path)
    whole = path.read_bytes()
    refused = 0
    for seed in range(120):
        generator = np.random.default_rng(seed)
        damaged = bytearray(whole)
        for place in generator.integers(min(len(whole), 200 if seed % 2 else 20_000), size=4):
            damaged[place] = generator.integers(256)
        path.write_bytes(damaged)
        try:
            choose(read_arrays(path, None, CsvLayout()), "data", path, "y")
        except BadInput as problem:
            refused += str(problem).startswith(f"{path}: ")
    assert refused > 10


@pytest.mark.parametrize("ending", ["nc", "h5", "hdf5"])
def test_variables_in_groups_come_by_the_names_of_their_groups(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a.{ending}"
    if ending == "nc":
        netcdf("NETCDF4")(path)
        with netCDF4.Dataset(path, "a") as file:
            file.createVariable("run/first/acc", "f8", ("time",))[...] = SAMPLES
    else:
        with h5py.File(path, "w") as file:
            file["data"] = file["run/first/acc"] = SAMPLES
            file["operator"] = "nobody"
    arrays = read_arrays(path, None, CsvLayout())
    assert sorted(arrays) == ["data", "run.first.acc"]
    assert np.array_equal(choose(arrays, "run.first.acc", path, "y"), SAMPLES)


def test_a_netcdf_file_of_64_bit_data_is_refused_with_what_to_do(tmp_path: Path) -> None:
    path = tmp_path / "a.nc"
    netcdf("NETCDF3_64BIT_DATA")(path)
    with pytest.raises(BadInput, match=r"a\.nc: .*CDF-5.* cannot be told; allowed: netCDF-4, as `nccopy -k nc4"):
        read_arrays(path, None, CsvLayout())
