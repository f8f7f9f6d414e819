"""MATLAB's .mat files: version 4 to 7 by scipy, 7.3, which is an HDF5 file, by h5py.

HDF5 files of other programs that are called so lack MATLAB's own beginning, and its order of dimensions.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.files.time_stamps import HDF5_SIGNATURE
from datagen.formats.arrays import TEXTS, Arrays, NumericVariables
from datagen.formats.netcdf_file import read_netcdf

USER_BLOCK = 512
NUMBERS, COMPLEX = "iufb", "c"


def read_mat(path: Path) -> Arrays:
    """Every numeric variable of a .mat file, texts that are numbers too; raises BadInput.

    A field F of a structure S is called "S.F". Of an array of structures, and of a cell array C, the elements are
    counted from 0, column by column: "S[2].F", "C[2]".
    """
    with path.open("rb") as file:
        start = file.read(USER_BLOCK + len(HDF5_SIGNATURE))
    if start.startswith(HDF5_SIGNATURE):
        return read_netcdf(path)
    return _read_hdf5(path) if start[USER_BLOCK:] == HDF5_SIGNATURE else _read_old(path)


def _element(name: str, index: int, size: int) -> str:
    return name if size == 1 else f"{name}[{index}]"


def _read_old(path: Path) -> Arrays:
    import scipy.io

    try:
        content = scipy.io.loadmat(path)
    except Exception as problem:  # scipy raises whatever the damaged bytes lead it to
        raise BadInput(f"cannot be read as a .mat file: {problem}", file=str(path)) from None
    found = NumericVariables()
    for name, value in content.items():
        if not name.startswith("__"):
            _collect(found, name, np.asarray(value))
    return found


def _collect(found: NumericVariables, name: str, value: NDArray[Any]) -> None:
    if value.dtype.names is not None:
        for index, element in enumerate(value.ravel(order="F")):
            for field in value.dtype.names:
                _collect(found, f"{_element(name, index, value.size)}.{field}", np.asarray(element[field]))
    elif value.dtype.kind == "O":
        for index, element in enumerate(value.ravel(order="F")):
            if isinstance(element, np.ndarray):
                _collect(found, _element(name, index, value.size), element)
            else:
                found.unread.append(_element(name, index, value.size))
    elif value.dtype.kind in NUMBERS + COMPLEX + TEXTS:
        found.add(name, value)


def _read_hdf5(path: Path) -> Arrays:
    import h5py

    try:
        with h5py.File(path) as file:
            return _sorted_out(_of_group(file, ""))
    except Exception as problem:  # h5py too
        raise BadInput(
            f"cannot be read as a .mat file of version 7.3: {problem}; save it in MATLAB with -v7", file=str(path)
        ) from None


def _sorted_out(variables: Iterator[tuple[str, NDArray[Any] | None]]) -> NumericVariables:
    found = NumericVariables()
    for name, value in variables:
        found.add(name, value)
    return found


def _of_group(group: Any, name: str) -> Iterator[tuple[str, NDArray[Any] | None]]:
    """The variables of a structure, or of the whole file, by name; None for those that hold neither numbers nor a text.

    Each field of an array of structures is a list of references, as a cell array is, but is of no class.
    """
    import h5py

    for field, item in group.items():
        inner = f"{name}.{field}" if name else field
        if field.startswith("#"):
            continue
        if name and _refers(item) and "MATLAB_class" not in item.attrs:
            for index, target in enumerate(item[...].ravel()):
                yield from _of_item(group.file[target], f"{name}[{index}].{field}")
        elif isinstance(item, h5py.Group):
            yield from _of_group(item, inner)
        else:
            yield from _of_item(item, inner)


def _of_item(item: Any, name: str) -> Iterator[tuple[str, NDArray[Any] | None]]:
    """The numbers of a variable or cell array, or its text of one line; None if it holds neither.

    MATLAB writes an array's dimensions in reverse order, and a text as the codes of its letters.
    """
    import h5py

    if isinstance(item, h5py.Group):
        yield from _of_group(item, name)
    elif _refers(item):
        for index, target in enumerate(item[...].ravel()):
            yield from _of_item(item.file[target], _element(name, index, item.size))
    elif item.attrs.get("MATLAB_class") == b"char":
        is_line = item.ndim == 2 and item.shape[1] == 1 and not item.attrs.get("MATLAB_empty", 0)
        yield name, np.array(["".join(map(chr, item[:, 0]))]) if is_line else None
    elif item.dtype.kind in NUMBERS:
        # Of an empty array the file holds the dimensions instead.
        empty = bool(item.attrs.get("MATLAB_empty", 0))
        yield name, np.zeros(0) if empty else np.asarray(item[...]).T
    else:
        yield name, None


def _refers(item: Any) -> bool:
    import h5py

    return isinstance(item, h5py.Dataset) and h5py.check_ref_dtype(item.dtype) is not None
