"""A dataset as the bytes of a netCDF-4 file, laid out by netCDF and, where it can be, filled with chunks made here.

netCDF hands its chunks to zlib, whose fastest level takes longer than the physics. ISA-L makes streams of the same
format many times as fast and about 6 % longer, and HDF5 takes chunks that are ready. Where h5py or isal is not
installed, or netCDF does not read what they write, netCDF does it all: the arrays that readers see are the same.

Texts are characters of a fixed length, which xarray and netCDF4 read as texts again. Those of any length lie in a heap
of the file, and HDF5 2.2.0 crashes when it reads them from a file that was opened twice, once its first handle is
closed.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from datagen.errors import BadInput
from datagen.files.chunk import chunk_bytes
from datagen.files.temporary import no_temporary_file
from datagen.files.time_stamps import clear_time_stamps

if TYPE_CHECKING:
    import netCDF4
    import xarray

Compression = Literal["zlib", "none"]
COMPRESSIONS = get_args(Compression)
NO_LZ4 = "netCDF's own lz4 filter fails on signals that do not compress and ends the process"
LONG_DIMENSIONS = ("time", "stiffness_time", "profile_angle")
# Texts of more bytes are stored in a chunk each.
LONG_TEXT = 1024
IMAGE_BLOCK = 1 << 22
# More than a file takes besides its values.
LAYOUT_BYTES = 1 << 20
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


def netcdf_bytes(dataset: xarray.Dataset, compression: str) -> bytes | bytearray:
    """The bytes of a netCDF-4 file of `dataset`; raises BadInput for a compression that is not offered, and
    NoTemporaryRoom where no temporary file can be written.

    Nothing in them says when they were made. They are whole before any is written where it is to stay: a file that
    netCDF fills in place and that is cut short opens cleanly and holds NaN. Other programs may add variables to the
    file. Signals are stored in checksummed chunks, one for each record and component.
    """
    check_compression(compression)
    fast, stored = has_fast_chunks(), _stored(dataset)
    with ONE_AT_A_TIME:
        image = _laid_out(stored, dataset.attrs, compression, with_values=not fast)
        return _filled(image, stored, compression) if fast else image


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
            stored = _stored(sample)
            content = _filled(_laid_out(stored, {}, "zlib", with_values=False), stored, "zlib")
            with netCDF4.Dataset("sample.nc", memory=content) as file:
                return all(np.array_equal(file[name][...], sample[name].values) for name in ("number", "text"))
        except (OSError, RuntimeError, KeyError, ValueError):  # whichever of the two finds what it cannot read
            return False


@dataclass(frozen=True)
class _Stored:
    """A variable as the file has it: names of its dimensions, values and attributes."""

    dims: tuple[str, ...]
    values: np.ndarray
    attributes: dict[str, Any]

    @property
    def chunk_shape(self) -> tuple[int, ...]:
        """A chunk for each record and component of what is long, else one for all."""
        keeps = [dim in LONG_DIMENSIONS for dim in self.dims]
        if self.values.dtype.kind == "S":
            keeps[-1] = self.values.shape[-1] > LONG_TEXT
        return tuple(size if keep or not any(keeps) else 1 for size, keep in zip(self.values.shape, keeps, strict=True))


def _stored(dataset: xarray.Dataset) -> dict[str, _Stored]:
    return {str(name): _as_stored(variable) for name, variable in dataset.variables.items()}


def _as_stored(variable: xarray.Variable) -> _Stored:
    """Texts become characters, and truth small integers; an attribute tells what they are."""
    dims, values, attributes = tuple(map(str, variable.dims)), np.asarray(variable.values), dict(variable.attrs)
    if values.dtype.kind in "OUT":
        texts = np.array([str(text).encode() for text in values.ravel()], dtype=np.bytes_)
        length = texts.dtype.itemsize
        characters = texts.view("S1").reshape(*values.shape, length)
        return _Stored((*dims, f"string{length}"), characters, attributes | {"_Encoding": "utf-8"})
    if values.dtype.kind == "b":
        return _Stored(dims, values.astype(np.int8), attributes | {"dtype": "bool"})
    return _Stored(dims, values, attributes)


def _laid_out(stored: dict[str, _Stored], attributes: dict[str, Any], compression: str, with_values: bool) -> bytearray:
    """A netCDF file of all dimensions, variables and attributes, and perhaps the values; without time stamps.

    Raises BadInput if it cannot be laid out; NoTemporaryRoom where there is no room for temporary files.
    """
    # On the disk: what netCDF lays out in memory lacks the order of creation without which it writes to no file again.
    try:
        with TemporaryDirectory(prefix="spallgen-") as folder:
            path = Path(folder) / "shard.nc"
            _lay_out(path, stored, attributes, compression, with_values)
            image = bytearray(path.read_bytes())
    except (OSError, RuntimeError) as problem:  # netCDF calls a full disk an HDF error, or a lack of permission
        values = sum(one.values.nbytes for one in stored.values()) if with_values else 0
        raise no_temporary_file(problem, LAYOUT_BYTES + values, "a folder with room for a shard") from None
    clear_time_stamps(image)
    return image


def _lay_out(
    path: Path, stored: dict[str, _Stored], attributes: dict[str, Any], compression: str, with_values: bool
) -> None:
    import netCDF4

    file = netCDF4.Dataset(path, mode="w", format="NETCDF4")
    try:
        file.setncatts(attributes)
        sizes = {dim: size for one in stored.values() for dim, size in zip(one.dims, one.values.shape, strict=True)}
        for dim, size in sizes.items():
            file.createDimension(dim, size)
        for name, one in stored.items():
            target = _create(file, name, one, compression)
            target.setncatts(one.attributes)
            if with_values and one.values.size:
                target[...] = one.values
    finally:
        # Left open, it would be closed by whichever thread the collector runs in.
        file.close()


def _create(file: netCDF4.Dataset, name: str, stored: _Stored, compression: str) -> Any:
    storage: dict[str, Any] = {}
    if stored.values.size:
        storage = {"chunksizes": stored.chunk_shape, "fletcher32": True}
        storage |= {"zlib": True, "complevel": 1, "shuffle": True} if compression == "zlib" else {}
    target = file.createVariable(name, stored.values.dtype, stored.dims, fill_value=False, **storage)
    target.set_auto_maskandscale(False)
    target.set_auto_chartostring(False)
    return target


def _filled(image: bytearray, stored: dict[str, _Stored], compression: str) -> bytes:
    """The file `image` with the chunks of what is `stored` put in."""
    import h5py

    with h5py.File.in_memory(file_image=bytes(image), block_size=IMAGE_BLOCK) as file:
        for name, one in stored.items():
            if not one.values.size:
                continue
            target = h5py.h5d.open(file.id, name.encode())
            for start, chunk in _chunks(one.values, one.chunk_shape):
                target.write_direct_chunk(start, chunk_bytes(chunk, compression == "zlib"))
        file.flush()
        filled: bytes = file.id.get_file_image()
    return filled


def _chunks(values: np.ndarray, shape: tuple[int, ...]) -> Iterator[tuple[tuple[int, ...], np.ndarray]]:
    """First index and values of each chunk."""
    for start in product(*(range(0, size, step) for size, step in zip(values.shape, shape, strict=True))):
        yield start, values[tuple(slice(first, first + step) for first, step in zip(start, shape, strict=True))]
