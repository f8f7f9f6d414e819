"""The times of an HDF5 file are taken out where they are known to lie, and nothing else is touched."""

from __future__ import annotations

import struct

import h5py
import netCDF4
import numpy as np

from datagen.files.netcdf import ONE_AT_A_TIME
from datagen.files.time_stamps import TIMES_BYTES, clear_time_stamps, lookup3


def stamped() -> bytearray:
    """A small file as netCDF makes it."""
    with ONE_AT_A_TIME:
        file = netCDF4.Dataset("a.nc", mode="w", memory=1024)
        file.title = "t"
        file.createDimension("place", 5)
        file.createVariable("number", "f8", ("place",))[...] = np.arange(5.0)
        return bytearray(file.close())


def times(image: bytearray) -> tuple[int, ...]:
    """The four times of the root group, which begin six bytes into its header."""
    (start,) = struct.unpack_from("<Q", image, 36)
    found: tuple[int, ...] = struct.unpack_from("<4I", image, start + 6)
    return found


def test_the_hash_is_that_of_its_author() -> None:
    # The driver of lookup3.c prints this one: hashlittle("Four score and seven years ago", 30, 0).
    assert lookup3(b"Four score and seven years ago") == (0x17770551).to_bytes(4, "little")


def test_a_cleared_file_has_no_times_and_reads_as_before() -> None:
    image = stamped()
    before = bytes(image)
    assert min(times(image)) > 0
    clear_time_stamps(image)
    assert times(image) == (0, 0, 0, 0)
    assert sum(old != new for old, new in zip(before, image, strict=True)) <= TIMES_BYTES + 4  # and the checksum
    with ONE_AT_A_TIME, netCDF4.Dataset("a.nc", memory=bytes(image)) as file:
        assert file["number"][...].tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
        assert file.title == "t"


def test_a_file_of_another_layout_stays_as_it_is() -> None:
    with h5py.File.in_memory(libver="earliest") as file:
        file.flush()
        old = file.id.get_file_image()
    damaged = stamped()
    damaged[struct.unpack_from("<Q", damaged, 36)[0] + 6] ^= 1  # no longer what its checksum says
    for content in (b"", b"\x89HDF\r\n\x1a\n", b"text" * 40, old, bytes(damaged)):
        image = bytearray(content)
        clear_time_stamps(image)
        assert image == content
