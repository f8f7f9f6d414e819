"""A kernel as a C function, for solvers that are not compiled with it."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numba
import numba.core.cgutils
import numba.core.registry
import numba.extending
import numpy as np
from numpy.typing import NDArray

DOUBLE = 8  # bytes
# numba's stubs do not know all of its options.
_decorator: Any = numba.njit
_c_function: Any = numba.cfunc
_intrinsic: Any = numba.extending.intrinsic


class CCallback(NamedTuple):
    """The `address` of a C function f(t, u, du, p) and what its p has to point to.

    u is (state − data[:n]) / data[n : 2n] of a state (n,), and du its rate; both parts of `data` are for the caller to
    fill. Keep `kept` as long as the function is called.
    """

    address: int
    data: NDArray[np.float64]
    kept: object


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
