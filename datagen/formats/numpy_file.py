"""NumPy's .npy and .npz files; Python objects in them are refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.formats.arrays import ONLY_NAME, Arrays, NumericVariables, ReadWhenAsked, as_numbers


class _Members(ReadWhenAsked):
    """The members of an .npz file, which stays open as long as this is there: to open it lists all its members anew."""

    def __init__(self, path: Path) -> None:
        self.path, self._file = path, np.load(path)
        super().__init__(tuple(self._file.files))

    def _read(self, name: str) -> NDArray[Any]:
        try:
            return as_numbers(np.asarray(self._file[name]))
        except Exception as problem:  # whatever the damaged bytes lead NumPy and zlib to
            if "allow_pickle" in str(problem):  # NumPy would have its own switch set, with which a file runs programs
                raise _of_objects(f"its array {name}", self.path) from None
            raise BadInput(f"its array {name} cannot be read: {problem}", file=str(self.path)) from None


def _of_objects(what: str, path: Path) -> BadInput:
    return BadInput(
        f"{what} holds Python objects, which are not read", file=str(path),
        allowed="arrays of numbers, one for each channel or recording",
    )  # fmt: skip


def read_npz(path: Path) -> Arrays:
    """The members of an .npz file by name; raises BadInput."""
    try:
        return _Members(path)
    except Exception as problem:  # as above
        raise BadInput(f"cannot be read as an .npz file: {problem}", file=str(path)) from None


def read_npy(path: Path) -> Arrays:
    """The one array of an .npy file, called "data", of a structured one each field, "data.FIELD"; raises BadInput."""
    try:
        array = np.asarray(np.load(path, mmap_mode="r"))
    except Exception as problem:  # as above
        if "Python objects" in str(problem):
            raise _of_objects("it", path) from None
        raise BadInput(f"cannot be read as an .npy file: {problem}", file=str(path)) from None
    found = NumericVariables()
    if array.dtype.names is None:
        found.add(ONLY_NAME, array)
    for field in array.dtype.names or ():
        found.add(f"{ONLY_NAME}.{field}", array[field])
    return found
