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
PART: dict[str, Any] = {**USUAL, "cache": False, "no_cpython_wrapper": True}
LEAN_PART: dict[str, Any] = {**PART, "_nrt": False}


def njit(kernel: Kernel) -> Kernel:
    """Compile `kernel` on first call, without fast-math, so that its bits do not depend on the vector width."""
    return cast(Kernel, _decorator(**USUAL)(kernel))


def njit_lean(kernel: Kernel) -> Kernel:
    """Like `njit` for a kernel that creates no array: without reference counts, which cost more than short kernels."""
    return cast(Kernel, _decorator(**LEAN)(kernel))


def njit_part(kernel: Kernel) -> Kernel:
    """Like `njit`, but only other kernels can call it; called from Python, it raises TypeError.

    A kernel that takes dozens of arrays compiles in half the time without code that unpacks them from Python objects.
    """
    return cast(Kernel, _without_door(_decorator(**PART)(kernel)))


def njit_inner(kernel: Kernel) -> Kernel:
    """Like `njit_part` for a kernel that creates no array, as `njit_lean` is like `njit`."""
    return cast(Kernel, _without_door(_decorator(**LEAN_PART)(kernel)))


def njit_inline(kernel: Kernel) -> Kernel:
    """Like `njit_inner`, and inlined by the compiler, which spares passing every array as a dozen arguments."""
    return cast(Kernel, _without_door(_decorator(**LEAN_PART, forceinline=True)(kernel)))


def njit_pasted(kernel: Kernel) -> Kernel:
    """A part whose code is pasted into each kernel that calls it before that is compiled at all; for few callers."""
    return cast(Kernel, _decorator(**USUAL, inline="always")(kernel))


def _without_door(compiled: Any) -> Any:
    """The compiled kernel, made to raise TypeError if it is called from Python, where it has no code to run.

    It is compiled once for all numbers of a kind, and not anew for each that callers write out.
    """

    def keep(result: Any) -> None:
        compiled.overloads[tuple(result.signature.args)] = result

    def refuse(*_: Any, **__: Any) -> None:
        raise TypeError(f"{compiled.__name__} is a part of compiled kernels; from Python call its py_func")

    def of_kinds(args: tuple[Any, ...], named: dict[str, Any]) -> Any:
        kinds = {name: numba.types.unliteral(kind) for name, kind in named.items()}
        return type(compiled).get_call_template(compiled, tuple(map(numba.types.unliteral, args)), kinds)

    compiled.add_overload, compiled._compile_for_args, compiled.get_call_template = keep, refuse, of_kinds
    return compiled


def specialise(
    template: Callable[..., Any], name: str, compiled_by: Callable[..., Any] = njit, **bindings: Any
) -> Callable[..., Any]:
    """Compile a copy of `template` under `name`, in one of the ways above, with `bindings` in place of its module's
    names.

    A compiled function given as an argument or a closure would miss the compile cache in every process.
    """
    copy = types.FunctionType(template.__code__, {**template.__globals__, **bindings}, name, template.__defaults__)
    copy.__qualname__ = name
    copy.__doc__ = template.__doc__
    return compiled_by(copy)


def uncompiled(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """The Python function behind a compiled one, to be specialised anew."""
    compiled: Any = kernel
    # With NUMBA_DISABLE_JIT set, a kernel is its Python function.
    return cast(Callable[..., Any], getattr(compiled, "py_func", compiled))
