"""One chunk of an HDF5 dataset as its filters leave it: checksum (Fletcher 32), then perhaps shuffle and deflate."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

# ISA-L's third level: streams about 3 % longer than those of zlib's first, made in a fifth of the time.
ISAL_LEVEL = 3
MODULUS = 65535
SUMMED_AT_ONCE = 1 << 18
SIZES_KEPT = 8


def chunk_bytes(values: np.ndarray, compressed: bool) -> bytes:
    """The bytes of a chunk of `values` (any shape) that HDF5 reads through Fletcher 32, shuffle and deflate.

    Without the last two unless it is `compressed`.
    """
    raw = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<")).reshape(-1).view(np.uint8)
    content = np.concatenate([raw, np.frombuffer(checksum(raw), np.uint8)])
    return deflated(shuffled(content, values.itemsize)) if compressed else content.tobytes()


def deflated(content: bytes) -> bytes:
    """A zlib stream of the `content`."""
    from isal import isal_zlib

    stream: bytes = isal_zlib.compress(content, ISAL_LEVEL)
    return stream


def checksum(raw: NDArray[np.uint8]) -> bytes:
    """The four bytes that HDF5 appends to a chunk `raw` (N,): two sums over its big-endian words of 16 bits.

    Both are kept modulo 65535, where a multiple of it is told as 65535, and as 0 only if every word is 0.
    """
    words = np.concatenate([raw, np.zeros(1, np.uint8)]) if raw.size % 2 else raw
    words = words.view("<u2")
    first = second = 0
    for start in range(0, words.size, SUMMED_AT_ONCE):
        # Floats add whole numbers below 2^53 exactly, in any order, and faster than integers are added.
        part = words[start : start + SUMMED_AT_ONCE].astype(np.float64)
        total = int(part.sum())
        first += total
        second += int(np.einsum("i,i->", part, _falling(part.size))) + (words.size - start - part.size) * total
    # Swapping the bytes of a word is multiplying it by 256 modulo 65535.
    first, second = ((256 * value - 1) % MODULUS + 1 if value else 0 for value in (first, second))
    return ((second << 16) | first).to_bytes(4, "little")


@lru_cache(maxsize=SIZES_KEPT)
def _falling(size: int) -> NDArray[np.float64]:
    return np.arange(size, 0.0, -1.0)


def shuffled(content: NDArray[np.uint8], itemsize: int) -> bytes:
    """Bytes (N,) with all first bytes of the items first, then all second ones …; what is no whole item stays last."""
    whole = content.size - content.size % itemsize
    return content[:whole].reshape(-1, itemsize).T.tobytes() + content[whole:].tobytes()
