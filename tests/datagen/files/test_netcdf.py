"""Files whose chunks are made here are, for every reader, the files that netCDF would have made."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import h5py
import netCDF4
import numpy as np
import pytest
import xarray

from datagen.corpus_files.format import content_hash, to_dataset
from datagen.errors import BadInput
from datagen.files import netcdf
from datagen.files.chunk import checksum, chunk_bytes, deflated, shuffled
from datagen.files.netcdf import COMPRESSIONS, netcdf_bytes
from datagen.files.temporary import NoTemporaryRoom
from datagen.records.record import Record


@pytest.fixture
def dataset(make_plain_record: Callable[..., Record]) -> xarray.Dataset:
    return to_dataset([make_plain_record(index, healthy=index == 1, full=True) for index in range(3)], {"title": "t"})


def both(dataset: xarray.Dataset, compression: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    """The file with chunks made here, and the one that netCDF makes alone."""
    ours, theirs = folder / "ours.nc", folder / "theirs.nc"
    assert netcdf.has_fast_chunks()
    ours.write_bytes(netcdf_bytes(dataset, compression))
    monkeypatch.setattr(netcdf, "has_fast_chunks", lambda: False)
    theirs.write_bytes(netcdf_bytes(dataset, compression))
    return ours, theirs


def test_a_lack_of_room_for_temporary_files_is_told_with_their_folder(
    dataset: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise RuntimeError("NetCDF: HDF error")  # as netCDF has it on a full disk

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with monkeypatch.context() as patched:
        patched.setattr(netCDF4, "Dataset", full)
        with pytest.raises(BadInput, match=rf"^{tmp_path}: TMPDIR: .* are free \(NetCDF: HDF error\); a") as refused:
            netcdf_bytes(dataset, "zlib")
        # As others may still be laid out there, the fault is the file's.
        assert not isinstance(refused.value, NoTemporaryRoom)
        patched.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=1000))
        with pytest.raises(NoTemporaryRoom, match=r"0\.0 MB are free"):
            netcdf_bytes(dataset, "zlib")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    with pytest.raises(NoTemporaryRoom, match=r"TMPDIR: .*No such file or directory"):
        netcdf_bytes(dataset, "zlib")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_xarray_reads_the_same_from_both(
    dataset: xarray.Dataset, compression: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours, theirs = both(dataset, compression, tmp_path, monkeypatch)
    with xarray.open_dataset(ours) as first, xarray.open_dataset(theirs) as second:
        xarray.testing.assert_identical(first.load(), second.load())
        assert content_hash(first) == content_hash(second) == content_hash(dataset)


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_names_types_attributes_chunks_and_filters_are_the_same(
    dataset: xarray.Dataset, compression: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours, theirs = both(dataset, compression, tmp_path, monkeypatch)

    def layout(file: netCDF4.Dataset) -> object:
        variables = {
            name: (one.dtype, one.dimensions, one.chunking(), one.filters(), one.__dict__)
            for name, one in file.variables.items()
        }
        return variables, {name: len(one) for name, one in file.dimensions.items()}, file.__dict__

    with netCDF4.Dataset(ours) as first, netCDF4.Dataset(theirs) as second:
        assert layout(first) == layout(second)


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_others_can_add_variables_and_change_attributes(
    dataset: xarray.Dataset, compression: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for path in both(dataset, compression, tmp_path, monkeypatch):
        said = xarray.Dataset({"said": ("record", np.array([0.5, 0.25, 1.0]))})
        said.to_netcdf(path, mode="a")
        with netCDF4.Dataset(path, "a") as file:
            file.title = "another"
        with xarray.open_dataset(path) as found:
            assert found.said.values.tolist() == said.said.values.tolist()
            xarray.testing.assert_identical(found.drop_vars("said").load(), dataset.assign_attrs(title="another"))


@pytest.mark.parametrize("fast", [True, False])
@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_files_made_in_different_seconds_have_the_same_bytes(
    dataset: xarray.Dataset, compression: str, fast: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(netcdf, "has_fast_chunks", lambda: fast)
    first, began = bytes(netcdf_bytes(dataset, compression)), int(time.time())
    while int(time.time()) == began:
        time.sleep(0.02)
    assert bytes(netcdf_bytes(dataset, compression)) == first


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_the_layout_is_that_of_xarray(dataset: xarray.Dataset, compression: str, tmp_path: Path) -> None:
    path, plain = tmp_path / "ours.nc", tmp_path / "xarray.nc"
    path.write_bytes(netcdf_bytes(dataset, compression))
    encoding: dict[Any, dict[str, Any]] = {
        name: {"dtype": "S1"} if variable.dtype.kind in "OU" else {"_FillValue": None}
        for name, variable in dataset.variables.items()
    }
    dataset.to_netcdf(plain, engine="netcdf4", encoding=encoding)
    with netCDF4.Dataset(path) as ours, netCDF4.Dataset(plain) as theirs:
        assert set(ours.variables) == set(theirs.variables)
        for name, variable in theirs.variables.items():
            assert ours[name].dtype == variable.dtype
            assert ours[name].__dict__ == variable.__dict__


def test_h5py_reads_every_number_too(dataset: xarray.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "a.nc"
    path.write_bytes(netcdf_bytes(dataset, "zlib"))
    with h5py.File(path) as file:
        for name in ("acceleration", "cage_angle", "loaded", "record", "stiffness", "pass_row"):
            assert np.array_equal(file[name][...], dataset[name].values)


@pytest.mark.parametrize("size", [1, 2, 3, 719, 720, 721, 70_000, 600_001])
@pytest.mark.parametrize("fill", ["random", "zero", "all ones"])
def test_the_checksum_is_the_one_that_hdf5_computes(size: int, fill: str, tmp_path: Path) -> None:
    values = np.random.default_rng(size).integers(0, 256, size, dtype=np.uint8)
    values = {"random": values, "zero": values * 0, "all ones": values * 0 + 255}[fill]
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        target = file.create_dataset("a", data=values, chunks=values.shape, fletcher32=True)
        assert target.id.read_direct_chunk((0,))[1] == values.tobytes() + checksum(values)


@pytest.mark.parametrize("dtype", ["int8", "int16", "float32", "float64"])
def test_a_chunk_has_the_filters_of_hdf5_before_its_deflate_stream(dtype: str, tmp_path: Path) -> None:
    values = np.random.default_rng(1).normal(0.0, 40.0, (7, 13)).astype(dtype)
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        settings = {"chunks": values.shape, "fletcher32": True, "shuffle": True, "compression": "gzip"}
        target = file.create_dataset("a", shape=values.shape, dtype=dtype, **settings)
        order = [target.id.get_create_plist().get_filter(place)[0] for place in range(3)]
        content = chunk_bytes(values, True)
        if order[0] != h5py.h5z.FILTER_FLETCHER32:  # h5py puts the checksum last, netCDF first
            raw = np.frombuffer(values.tobytes(), np.uint8)
            stream = deflated(shuffled(raw, values.itemsize))
            content = stream + checksum(np.frombuffer(stream, np.uint8))
        target.id.write_direct_chunk((0, 0), content)
    with h5py.File(path) as file:
        assert np.array_equal(file["a"][...], values)


def test_without_the_fast_libraries_netcdf_does_it_all(monkeypatch: pytest.MonkeyPatch) -> None:
    assert netcdf.has_fast_chunks()
    monkeypatch.setattr(netcdf, "find_spec", lambda name: None if name == "isal" else object())
    assert not netcdf.has_fast_chunks()


@pytest.fixture
def asked_anew() -> Iterator[None]:
    """Whether netCDF reads what h5py writes, else found out once a process, is asked in this test and after it."""
    netcdf.reads_back.cache_clear()
    yield
    netcdf.reads_back.cache_clear()


@pytest.mark.parametrize("found", [b"", b"CDF", OSError("no file"), KeyError("no object"), "half"])
@pytest.mark.usefixtures("asked_anew")
def test_where_netcdf_does_not_read_what_h5py_writes_it_does_it_all(
    found: object, dataset: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = netCDF4.Dataset

    def not_at_home(name: str, mode: str = "r", **given: Any) -> netCDF4.Dataset:
        """netCDF4, to which a file that it did not write itself is another or none."""
        if mode == "r" and isinstance(found, Exception):
            raise found
        if mode == "r":
            content = given["memory"]
            given["memory"] = found if isinstance(found, bytes) else content[: len(content) // 2]
        return plain(name, mode, **given)

    path = tmp_path / "a.nc"
    with monkeypatch.context() as patched:
        patched.setattr(netCDF4, "Dataset", not_at_home)
        assert not netcdf.has_fast_chunks()
        path.write_bytes(netcdf_bytes(dataset, "zlib"))
    with xarray.open_dataset(path) as opened:
        assert content_hash(opened.load()) == content_hash(dataset)
