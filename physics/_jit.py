"""The only door to numba: compiled kernels, cached in a folder named by the content of every physics source file.

numba notices edits in a cached function's own file only, so a kernel that calls into another file could go on serving
old physics. A cache folder per content hash cannot.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import tempfile
import traceback
import types
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, TypeVar, cast

import numba
import numba.core.caching
import numba.core.cgutils
import numba.core.registry
import numba.extending
import numpy as np
from numpy.typing import NDArray

DOUBLE = 8  # bytes
Kernel = TypeVar("Kernel", bound=Callable[..., Any])


def fingerprint() -> str:
    """Hash of the text of every Python file of the physics package, 16 hexadecimal digits."""
    root = Path(__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> Path:
    chosen = os.environ.get("SPALLGEN_CACHE") or os.environ.get("XDG_CACHE_HOME")
    try:
        folder = Path(chosen or Path.home() / ".cache") / "spallgen" / f"{fingerprint()}-numba{numba.__version__}"
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder):
            return folder
    except (OSError, RuntimeError):  # a user without a home, as in containers
        made = tempfile.mkdtemp(prefix="spallgen-cache-")
        atexit.register(shutil.rmtree, made, ignore_errors=True)
        os.environ["SPALLGEN_CACHE"] = made  # for the workers that this process starts
        return _cache_folder()


class CCallback(NamedTuple):
    """The `address` of a C function f(t, u, du, p) and what its p has to point to.

    u is (state − data[:n]) / data[n : 2n] of a state (n,), and du its rate; both parts of `data` are for the caller to
    fill. Keep `kept` as long as the function is called.
    """

    address: int
    data: NDArray[np.float64]
    kept: object


CACHE_FOLDER = _cache_folder()
# For all of numba, and before anything is decorated: a kernel of somebody else's that calls one of these would go on
# serving old physics from a folder of its own.
setattr(numba.config, "CACHE_DIR", str(CACHE_FOLDER))


# numba's stubs do not know all of its options.
_decorator: Any = numba.njit
_c_function: Any = numba.cfunc
_intrinsic: Any = numba.extending.intrinsic
USUAL: dict[str, Any] = {"cache": True, "error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}
LEAN: dict[str, Any] = {**USUAL, "_nrt": False}


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
    return cast(Kernel, _without_door(_decorator(**LEAN, no_cpython_wrapper=True)(kernel)))


def njit_inline(kernel: Kernel) -> Kernel:
    """Like `njit_inner`, and inlined by the compiler, which spares passing every array as a dozen arguments."""
    return cast(Kernel, _without_door(_decorator(**LEAN, no_cpython_wrapper=True, forceinline=True)(kernel)))


def njit_pasted(kernel: Kernel) -> Kernel:
    """Like `njit_inline` for a part that only one kernel calls: pasted into it before it is compiled at all."""
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


def c_callback(slope: Callable[..., Any], model: Any, size: int) -> CCallback:
    """`slope(model, t, state)` → rate of the state (`size`,), for solvers in other languages; compiled once a process.

    The model lies behind the state's offset and scale, as kernels know it.
    """
    function, put = _c_door(slope, numba.typeof(model), size)
    context = numba.core.registry.cpu_target.target_context
    model_bytes = context.get_abi_sizeof(context.get_value_type(numba.typeof(model)))
    data = np.zeros(2 * size + -(-model_bytes // DOUBLE))
    put(data.ctypes.data + 2 * size * DOUBLE, model)
    return CCallback(function.address, data, (function, model))


@cache
def _c_door(slope: Callable[..., Any], kind: Any, size: int) -> tuple[Any, Callable[[int, Any], None]]:
    """The C function that calls `slope` with a model of `kind`, and what puts such a model at an address."""

    @_intrinsic
    def store(typing: Any, address: Any, value: Any) -> Any:
        def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            value = _without_owner(context, builder, kind, arguments[1])
            builder.store(value, builder.inttoptr(arguments[0], value.type.as_pointer()))
            return context.get_dummy_value()

        return numba.types.void(address, value), build

    @_intrinsic
    def load(typing: Any, address: Any) -> Any:
        def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return builder.load(builder.inttoptr(arguments[0], context.get_value_type(kind).as_pointer()))

        return kind(address), build

    @_decorator(error_model="numpy")
    def put(address: int, value: Any) -> None:
        store(address, value)

    doubles, behind = numba.types.CPointer(numba.float64), 2 * size * DOUBLE

    @_c_function(numba.types.void(numba.float64, doubles, doubles, doubles), error_model="numpy")
    def function(time: float, values: Any, result: Any, data: Any) -> None:
        scaled, rate, given = numba.carray(values, size), numba.carray(result, size), numba.carray(data, 2 * size)
        rate[:] = slope(load(given.ctypes.data + behind), time, given[:size] + given[size:] * scaled) / given[size:]

    return function, put


def _without_owner(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """The compiled `value` with arrays that belong to nobody: their owners are gone when Python's call has ended."""
    if isinstance(kind, numba.types.Array):
        array = context.make_array(kind)(context, builder, value)
        array.meminfo = array.parent = numba.core.cgutils.get_null_value(array.meminfo.type)
        return array._getvalue()
    for place, part in enumerate(getattr(kind, "types", ())):
        inner = _without_owner(context, builder, part, builder.extract_value(value, place))
        value = builder.insert_value(value, inner, place)
    return value


def uncompiled(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """The Python function behind a compiled one, to be specialised anew."""
    compiled: Any = kernel
    # With NUMBA_DISABLE_JIT set, a kernel is its Python function.
    return cast(Callable[..., Any], getattr(compiled, "py_func", compiled))


def nothing_cached() -> bool:
    """Whether no kernel has been compiled yet; the folders of kernels are there as soon as they are defined."""
    return not any(CACHE_FOLDER.rglob("*.nbi"))


def raised_by_cache(error: BaseException | None) -> bool:
    """Whether `error`, or one that led to it, arose while a compiled kernel was read back: what a cut file raises.

    A file that is missing, locked or does not fit on the disk is not damaged.
    """
    while error is not None and not isinstance(error, OSError):
        met = (frame.f_code.co_filename for frame, _ in traceback.walk_tb(error.__traceback__))
        if numba.core.caching.__file__ in met:
            return True
        error = error.__cause__ or error.__context__
    return False


def discard_cache() -> None:
    """Delete the compiled kernels: the cure for a cache file cut short by a crash."""
    shutil.rmtree(CACHE_FOLDER, ignore_errors=True)
    CACHE_FOLDER.mkdir(parents=True, exist_ok=True)
