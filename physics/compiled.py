"""What other packages need of the compiler: kernels of their own, compiled and cached like those of the physics, and
the fingerprint that records name.

Importing it, or any module with a kernel, points all of numba's caches to the folder of the physics (`_jit.cache`).
"""

from physics._jit import fingerprint, njit, njit_inline, njit_lean

__all__ = ["fingerprint", "njit", "njit_inline", "njit_lean"]
