"""How a large kernel reads its arguments from the stack.

A kernel of dozens of arrays has kilobytes of arguments there, and beside them kilobytes of values for which it has no
register. Usually it addresses both by the stack pointer. On a processor of AMD's Zen 5, loads then stood still for tens
of cycles where something had just been stored a multiple of 1024 bytes away: by chance of where the values lay, the
march was a quarter slower (docs/pipeline.md).
"""

from __future__ import annotations

from typing import Any

from numba.core import types
from numba.extending import intrinsic, overload

# Bytes; more than what callers keep to, so that the kernel has to align its own values.
ALIGNMENT = 64


def keep_arguments_apart() -> None:
    """Make the compiled kernel that calls this address its arguments by the frame pointer, and only its own values by
    the stack pointer."""


def _alignment(_: Any) -> Any:
    def generate(context: Any, builder: Any, *_: Any) -> Any:
        attributes = builder.function.attributes
        attributes.alignstack = ALIGNMENT
        # llvmlite writes an alignment only beside another attribute. Kernels return a status and never unwind.
        attributes.add("nounwind")
        return context.get_dummy_value()

    return types.void(), generate


_align_stack: Any = intrinsic(_alignment)


@overload(keep_arguments_apart, inline="always")
def _keep_arguments_apart() -> Any:
    return lambda: _align_stack()
