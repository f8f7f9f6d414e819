"""The only door to numba: kernels compiled on first call, and kept on the disk.

- `decorators`: the ways to compile a kernel
- `cache`: where compiled kernels lie; importing this package points all of numba's caches there
- `stack_frame`: how a large kernel reads its arguments
- `c_callback`: a kernel as a C function, for solvers in other languages
"""

from physics._jit.cache import CACHE_FOLDER, discard_cache, fingerprint, is_cached, raised_by_cache
from physics._jit.decorators import (
    njit,
    njit_inline,
    njit_inner,
    njit_lean,
    njit_part,
    njit_pasted,
    specialise,
    uncompiled,
)
from physics._jit.stack_frame import keep_arguments_apart

__all__ = [
    "CACHE_FOLDER",
    "discard_cache",
    "fingerprint",
    "is_cached",
    "keep_arguments_apart",
    "njit",
    "njit_inline",
    "njit_inner",
    "njit_lean",
    "njit_part",
    "njit_pasted",
    "raised_by_cache",
    "specialise",
    "uncompiled",
]
