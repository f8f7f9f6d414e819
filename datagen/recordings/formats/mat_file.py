"""MATLAB's .mat files: version 4 to 7 by scipy, 7.3 (an HDF5 file) by the netCDF library, which reads those too."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.corpora.netcdf import ONE_AT_A_TIME
from datagen.errors import BadInput
from datagen.recordings.formats.arrays import Arrays

HDF5_MARK = b"\x89HDF\r\n\x1a\n"
USER_BLOCK = 512


def read_mat(path: Path) -> Arrays:
    """Every numeric variable of a .mat file; a field F of a structure S is called "S.F"; raises BadInput."""
    with path.open("rb") as file:
        start = file.read(USER_BLOCK + len(HDF5_MARK))
    return _read_hdf5(path) if start[USER_BLOCK:] == HDF5_MARK else _read_old(path)


def _read_old(path: Path) -> Arrays:
    import scipy.io

    try:
        content = scipy.io.loadmat(path)
    except Exception as problem:  # scipy raises whatever the damaged bytes lead it to
        raise BadInput(f"cannot be read as a .mat file: {problem}", str(path)) from None
    found: dict[str, NDArray[Any]] = {}
    for name, value in content.items():
        if not name.startswith("__"):
            _collect(found, name, np.asarray(value))
    return found


def _collect(found: dict[str, NDArray[Any]], name: str, value: NDArray[Any]) -> None:
    if value.dtype.names is not None:
        if value.size == 1:
            for field in value.dtype.names:
                _collect(found, f"{name}.{field}", np.asarray(value.flat[0][field]))
    elif value.dtype.kind in "iufb":
        found[name] = value


def _read_hdf5(path: Path) -> Arrays:
    import netCDF4

    try:
        with ONE_AT_A_TIME, netCDF4.Dataset(path) as file:
            file.set_auto_mask(False)
            file.set_auto_scale(False)
            return _group(file, "")
    except (OSError, RuntimeError) as problem:
        raise BadInput(
            f"cannot be read as a .mat file of version 7.3: {problem}; save it in MATLAB with -v7", str(path)
        ) from None


def _group(group: Any, prefix: str) -> dict[str, NDArray[Any]]:
    """Variables of an HDF5 group; MATLAB writes an array's dimensions there in reverse order."""
    found = {
        f"{prefix}{name}": np.asarray(variable[...]).T
        for name, variable in group.variables.items()
        if np.dtype(variable.dtype).kind in "iufb"
    }
    for name, inner in group.groups.items():
        if not name.startswith("#"):
            found |= _group(inner, f"{prefix}{name}.")
    return found
