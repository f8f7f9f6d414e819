"""A dataset as the bytes of a netCDF-4 file, laid out by netCDF and, where it can be, filled with chunks made here.

netCDF hands its chunks to zlib, whose fastest level takes longer than the physics. ISA-L makes streams of the same
format many times as fast and about 6 % longer, and HDF5 takes chunks that are ready. Where h5py or isal is not
installed, or netCDF does not read what they write, netCDF does it all: the arrays that readers see are the same.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.errors import BadInput
from datagen.files.chunk import chunk_bytes

if TYPE_CHECKING:
    import netCDF4
    import xarray

COMPRESSIONS = ("zlib", "none")
NO_LZ4 = "netCDF's own lz4 filter fails on signals that do not compress and ends the process"
LONG_DIMENSIONS = ("time", "stiffness_time", "profile_angle")
IMAGE_BLOCK = 1 << 22
# The netCDF library crashes when two threads use it. Closing may happen inside writing, when memory is collected.
ONE_AT_A_TIME = threading.RLock()


def check_compression(compression: str) -> None:
    """Raise BadInput for a compression that is not offered."""
    if compression not in COMPRESSIONS:
        raise BadInput(
            NO_LZ4 if compression == "lz4" else "",
            field="store.compression",
            value=compression,
            allowed=", ".join(COMPRESSIONS),
        )


def netcdf_bytes(dataset: xarray.Dataset, compression: str) -> bytes | memoryview:
    """The bytes of a netCDF-4 file of `dataset`; raises BadInput for a compression that is not offered.

    They are made in memory: a file that netCDF fills in place and that is cut short opens cleanly and holds NaN.
    Signals are stored in checksummed chunks, one for each record and component.
    """
    check_compression(compression)
    fast = has_fast_chunks()
    with ONE_AT_A_TIME:
        image = _laid_out(dataset, compression, with_values=not fast)
        return _filled(image, dataset, compression) if fast else image


def has_fast_chunks() -> bool:
    """Whether chunks can be made outside netCDF: with h5py and isal, if netCDF reads what they write."""
    return find_spec("h5py") is not None and find_spec("isal") is not None and reads_back()


@cache
def reads_back() -> bool:
    """Whether netCDF reads a small file that h5py has filled, tried once a process.

    Each brings an HDF5 of its own: what 1.14 (h5py 3.15) has filled, 2.2 (netCDF4 1.7.5) cannot open.
    """
    import netCDF4
    import xarray

    numbers, texts = np.arange(40.0), np.array(["one", ""], dtype=object)
    sample = xarray.Dataset({"number": (("record", "time"), numbers.reshape(2, 20)), "text": ("record", texts)})
    with ONE_AT_A_TIME:
        try:
            content = _filled(_laid_out(sample, "zlib", with_values=False), sample, "zlib")
            with netCDF4.Dataset("sample.nc", memory=content) as file:
                return all(np.array_equal(file[name][...], sample[name].values) for name in ("number", "text"))
        except (OSError, RuntimeError, KeyError, ValueError):  # whichever of the two finds what it cannot read
            return False


def _is_text(variable: xarray.Variable) -> bool:
    return variable.dtype.kind in "OUT"


def _laid_out(dataset: xarray.Dataset, compression: str, with_values: bool) -> memoryview:
    """A netCDF file of all dimensions, variables and attributes, and perhaps the values."""
    import netCDF4

    file = netCDF4.Dataset("shard.nc", mode="w", format="NETCDF4", memory=IMAGE_BLOCK)
    file.setncatts(dataset.attrs)
    for name, size in dataset.sizes.items():
        file.createDimension(str(name), size)
    for name, variable in dataset.variables.items():
        target = _create(file, str(name), variable, compression)
        if with_values and variable.size:
            target[...] = _plain(variable)
    image: memoryview = file.close()
    return image


def _create(file: netCDF4.Dataset, name: str, variable: xarray.Variable, compression: str) -> Any:
    dims = tuple(map(str, variable.dims))
    target: Any
    if _is_text(variable):
        target = file.createVariable(name, str, dims)
        attributes = dict(variable.attrs)
    else:
        values = _plain(variable)
        storage = _storage(variable, compression) if variable.size else {}
        target = file.createVariable(name, values.dtype, dims, fill_value=False, **storage)
        attributes = dict(variable.attrs) | ({"dtype": "bool"} if variable.dtype.kind == "b" else {})
    target.set_auto_maskandscale(False)
    target.setncatts(attributes)
    return target


def _plain(variable: xarray.Variable) -> np.ndarray:
    """The values as netCDF knows them: texts as objects, and truth as small integers, told by an attribute."""
    values = np.asarray(variable.values)
    if _is_text(variable):
        return values.astype(object)
    return values.astype(np.int8) if values.dtype.kind == "b" else values


def _storage(variable: xarray.Variable, compression: str) -> dict[str, Any]:
    settings: dict[str, Any] = {"chunksizes": _chunk_shape(variable), "fletcher32": True}
    return settings | ({"zlib": True, "complevel": 1, "shuffle": True} if compression == "zlib" else {})


def _chunk_shape(variable: xarray.Variable) -> tuple[int, ...]:
    long = [dim in LONG_DIMENSIONS for dim in variable.dims]
    return tuple(size if keep or not any(long) else 1 for size, keep in zip(variable.shape, long, strict=True))


def _filled(image: memoryview, dataset: xarray.Dataset, compression: str) -> bytes:
    """The file `image` with the texts and the chunks of `dataset` put in."""
    import h5py

    with h5py.File.in_memory(file_image=bytes(image), block_size=IMAGE_BLOCK) as file:
        for name, variable in dataset.variables.items():
            target = h5py.h5d.open(file.id, str(name).encode())
            if not variable.size:
                continue
            if _is_text(variable):
                h5py.Dataset(target)[...] = _plain(variable)
                continue
            for start, chunk in _chunks(_plain(variable), _chunk_shape(variable)):
                target.write_direct_chunk(start, chunk_bytes(chunk, compression == "zlib"))
        file.flush()
        filled: bytes = file.id.get_file_image()
    return filled


def _chunks(values: np.ndarray, shape: tuple[int, ...]) -> Iterator[tuple[tuple[int, ...], np.ndarray]]:
    """First index and values of each chunk."""
    for start in product(*(range(0, size, step) for size, step in zip(values.shape, shape, strict=True))):
        yield start, values[tuple(slice(first, first + step) for first, step in zip(start, shape, strict=True))]
