"""One chunk of an HDF5 dataset as its filters leave it: checksum (Fletcher 32), then perhaps shuffle and deflate."""

from __future__ import annotations

import zlib

import numpy as np
from numpy.typing import NDArray

# ISA-L's first level: streams about 6 % longer than those of zlib's first, made in a tenth of the time. Its third one
# takes twice as long for 3.5 % fewer bytes, a twentieth of what a record costs.
ISAL_LEVEL = 1
# Content of fewer bytes is compressed by zlib: of the 20 bytes of a column of labels ISA-L makes one stream in most
# processes and another, equally right, in some (why was not found). In 8 runs of two workers 10 of 72 shards differed
# from those of one worker, with zlib for short chunks none of as many.
FEWEST_FOR_ISAL = 4096
ZLIB_LEVEL = 1
MODULUS = 65535
CHECKSUM_BYTES = 4
# Sums of so many words lie below 2^24: single floats, whose sums are the fastest, add them exactly and in any order.
SIDE = 256
PLACES, ONES = np.arange(float(SIDE)), np.ones(SIDE, np.float32)


def chunk_bytes(values: np.ndarray, compressed: bool) -> bytes:
    """The bytes of a chunk of `values` (any shape) that HDF5 reads through Fletcher 32, shuffle and deflate.

    Without the last two unless it is `compressed`.
    """
    content = np.empty(values.nbytes + CHECKSUM_BYTES, np.uint8)
    raw, end = content[: values.nbytes], content[values.nbytes :]
    raw.view(values.dtype.newbyteorder("<")).reshape(values.shape)[...] = values
    end[:] = np.frombuffer(checksum(raw), np.uint8)
    return deflated(shuffled(content, values.itemsize)) if compressed else content.tobytes()


def deflated(content: bytes | NDArray[np.uint8]) -> bytes:
    """A zlib stream of the `content`: ISA-L's, or zlib's own if it is short."""
    from isal import isal_zlib

    if len(content) < FEWEST_FOR_ISAL:
        return zlib.compress(bytes(content), ZLIB_LEVEL)
    stream: bytes = isal_zlib.compress(content, ISAL_LEVEL)
    return stream


def checksum(raw: NDArray[np.uint8]) -> bytes:
    """The four bytes that HDF5 appends to a chunk `raw` (N,): two sums over its big-endian words of 16 bits.

    Both are kept modulo 65535, where a multiple of it is told as 65535, and as 0 only if every word is 0.
    """
    words = np.concatenate([raw, np.zeros(1, np.uint8)]) if raw.size % 2 else raw
    words = words.view("<u2")
    first = second = 0
    for start in range(0, words.size, SIDE * SIDE):
        part = words[start : start + SIDE * SIDE]
        square = np.zeros((-(-part.size // SIDE), SIDE), np.float32)
        square.reshape(-1)[: part.size] = part
        rows, columns = square @ ONES, ONES[: len(square)] @ square
        total = int(rows.sum(dtype=np.float64))
        # The second sum adds up the first after every word, so that word k of n counts n - k times: n less the start,
        # less its place in the part. `before` is the sum of place times word.
        before = SIDE * (PLACES[: len(square)] @ rows) + PLACES @ columns
        first += total
        second += (words.size - start) * total - int(before)
    # Swapping the bytes of a word is multiplying it by 256 modulo 65535.
    first, second = ((256 * value - 1) % MODULUS + 1 if value else 0 for value in (first, second))
    return ((second << 16) | first).to_bytes(CHECKSUM_BYTES, "little")


def shuffled(content: NDArray[np.uint8], itemsize: int) -> NDArray[np.uint8]:
    """Bytes (N,) with all first bytes of the items first, then all second ones …; what is no whole item stays last."""
    whole = content.size - content.size % itemsize
    result = np.empty_like(content)
    result[:whole].reshape(itemsize, -1)[...] = content[:whole].reshape(-1, itemsize).T
    result[whole:] = content[whole:]
    return result
