"""When an HDF5 file was made, taken out of its bytes: netCDF stamps the root group, and has no switch for that.

Places and sizes are those of the HDF5 File Format Specification, version 3.0: superblock (II.A), version 2 object
header (IV.A.1.b). Groups that netCDF adds, and variables, carry no times.
"""

from __future__ import annotations

import struct

HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
SUPERBLOCKS = (2, 3)
SUPERBLOCK_BYTES = 48  # with addresses of 8 bytes
ROOT_ADDRESS = 36
HEADER_START = b"OHDR\x02"
HEADER_FLAGS = len(HEADER_START)
SIZE_OF_SIZE, STATES_PHASES, STATES_TIMES = 0b11, 1 << 4, 1 << 5
PHASES_BYTES, TIMES_BYTES, CHECKSUM_BYTES = 4, 16, 4
WORD = 0xFFFFFFFF


def clear_time_stamps(image: bytearray) -> None:
    """Set the four times of the root group of the HDF5 file `image` to zero, in place, and mend its checksum.

    A file that is laid out in another way, or whose header does not have the checksum that it should, stays as it is.
    """
    if len(image) < SUPERBLOCK_BYTES or not image.startswith(HDF5_SIGNATURE):
        return
    if image[8] not in SUPERBLOCKS or image[9] != 8:
        return
    (start,) = struct.unpack_from("<Q", image, ROOT_ADDRESS)
    flags = image[start + HEADER_FLAGS] if image.startswith(HEADER_START, start) else 0
    if not flags & STATES_TIMES:
        return
    times = start + HEADER_FLAGS + 1
    size_place = times + TIMES_BYTES + (PHASES_BYTES if flags & STATES_PHASES else 0)
    messages = size_place + (1 << (flags & SIZE_OF_SIZE))
    end = messages + int.from_bytes(image[size_place:messages], "little")
    if image[end : end + CHECKSUM_BYTES] != lookup3(image[start:end]):
        return
    image[times : times + TIMES_BYTES] = bytes(TIMES_BYTES)
    image[end : end + CHECKSUM_BYTES] = lookup3(image[start:end])


def lookup3(content: bytes | bytearray) -> bytes:
    """The four bytes that HDF5 appends to its own structures: Bob Jenkins's hash of at least one byte, lookup3.c."""
    words = struct.unpack(f"<{-(-len(content) // 12) * 3}I", content + bytes(-len(content) % 12))
    a = b = c = (0xDEADBEEF + len(content)) & WORD
    for place in range(0, len(words), 3):
        a, b, c = (a + words[place]) & WORD, (b + words[place + 1]) & WORD, (c + words[place + 2]) & WORD
        if place + 3 < len(words):
            a, b, c = _mixed(a, b, c)
    return _final(a, b, c).to_bytes(CHECKSUM_BYTES, "little")


def _mixed(a: int, b: int, c: int) -> tuple[int, int, int]:
    for turn in (4, 6, 8, 16, 19, 4):
        a = ((a - c) & WORD) ^ _turned(c, turn)
        a, b, c = b, (c + b) & WORD, a  # the next of the three is next in line
    return a, b, c


def _final(a: int, b: int, c: int) -> int:
    for turn in (14, 11, 25, 16, 4, 14, 24):
        c = ((c ^ b) - _turned(b, turn)) & WORD
        a, b, c = b, c, a
    return b


def _turned(word: int, bits: int) -> int:
    return ((word << bits) | (word >> (32 - bits))) & WORD
