"""NetCDF files: variables of the root group, scaled by their own attributes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.corpora.netcdf import ONE_AT_A_TIME
from datagen.errors import BadInput
from datagen.recordings.formats.arrays import Arrays


class _Variables(Mapping[str, NDArray[Any]]):
    """The variables of a file, each read when it is asked for; missing values are NaN."""

    def __init__(self, path: Path) -> None:
        import netCDF4

        self.path = path
        with ONE_AT_A_TIME, netCDF4.Dataset(path) as file:
            self.names = tuple(name for name, held in file.variables.items() if np.dtype(held.dtype).kind in "iufb")

    def __getitem__(self, name: str) -> NDArray[Any]:
        import netCDF4

        if name not in self.names:
            raise KeyError(name)
        try:
            with ONE_AT_A_TIME, netCDF4.Dataset(self.path) as file:
                values = file.variables[name][...]
        except (OSError, RuntimeError) as problem:
            raise BadInput(f"its variable {name} cannot be read: {problem}", str(self.path)) from None
        masked = np.ma.isMaskedArray(values) and np.ma.is_masked(values)
        return values.astype(np.float64).filled(np.nan) if masked else np.asarray(values)

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)


def read_netcdf(path: Path) -> Arrays:
    """The variables of a netCDF file by name; raises BadInput."""
    try:
        return _Variables(path)
    except (OSError, RuntimeError, TypeError) as problem:
        raise BadInput(f"cannot be read as a netCDF file: {problem}", str(path)) from None
