"""The ways to compile a kernel."""

from __future__ import annotations

import types
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., Any])

# numba's stubs do not know all of its options.
_decorator: Any = numba.njit
USUAL: dict[str, Any] = {"cache": True, "error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}
LEAN: dict[str, Any] = {**USUAL, "_nrt": False}
# Parts have no files of their own: around one that was read from the disk, a kernel would be other machine code than
# around one compiled with it, and so depend on what was compiled before.
PART: dict[str, Any] = {**LEAN, "cache": False, "no_cpython_wrapper": True}


def njit(kernel: Kernel) -> Kernel:
    """Compile `kernel` on first call, without fast-math, so that its bits do not depend on the vector width."""
    return cast(Kernel, _decorator(**USUAL)(kernel))


def njit_lean(kernel: Kernel) -> Kernel:
    """Like `njit` for a kernel that creates no array: without reference counts, which cost more than short kernels."""
    return cast(Kernel, _decorator(**LEAN)(kernel))


def njit_inner(kernel: Kernel) -> Kernel:
    """Like `njit_lean`, but only other kernels can call it; called from Python, it raises TypeError.

    A kernel that takes dozens of arrays compiles in half the time without code that unpacks them from Python objects.
    """
    return cast(Kernel, _without_door(_decorator(**PART)(kernel)))


def njit_inline(kernel: Kernel) -> Kernel:
    """Like `njit_inner`, and inlined by the compiler, which spares passing every array as a dozen arguments."""
    return cast(Kernel, _without_door(_decorator(**PART, forceinline=True)(kernel)))


def njit_pasted(kernel: Kernel) -> Kernel:
    """A part whose code is pasted into each kernel that calls it before that is compiled at all; for few callers."""
    return cast(Kernel, _decorator(**USUAL, inline="always")(kernel))


def _without_door(compiled: Any) -> Any:
    """The compiled kernel, made to raise TypeError if it is called from Python, where it has no code to run."""

    def keep(result: Any) -> None:
        compiled.overloads[tuple(result.signature.args)] = result

    def refuse(*_: Any, **__: Any) -> None:
        raise TypeError(f"{compiled.__name__} is a part of compiled kernels; from Python call its py_func")

    compiled.add_overload, compiled._compile_for_args = keep, refuse
    return compiled


def specialise(template: Callable[..., Any], name: str, **bindings: Any) -> Callable[..., Any]:
    """Compile a copy of `template` under `name`, with `bindings` in place of its module's names.

    A compiled function given as an argument or a closure would miss the compile cache in every process.
    """
    copy = types.FunctionType(template.__code__, {**template.__globals__, **bindings}, name, template.__defaults__)
    copy.__qualname__ = name
    copy.__doc__ = template.__doc__
    return njit(copy)


def uncompiled(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """The Python function behind a compiled one, to be specialised anew."""
    compiled: Any = kernel
    # With NUMBA_DISABLE_JIT set, a kernel is its Python function.
    return cast(Callable[..., Any], getattr(compiled, "py_func", compiled))
