"""NetCDF files, and HDF5 files that the netCDF library can read: variables scaled by their own attributes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.files.netcdf import ONE_AT_A_TIME
from datagen.formats.arrays import Arrays

# The two formats of netCDF-3 that scipy knows too.
CLASSIC = (b"CDF\x01", b"CDF\x02")


class _Variables(Mapping[str, NDArray[Any]]):
    """The variables of a file, each read when it is asked for; missing values are NaN."""

    def __init__(self, path: Path) -> None:
        import netCDF4

        self.path = path
        with ONE_AT_A_TIME, netCDF4.Dataset(path) as file:
            self.places = dict(_numeric(file, ""))

    def __getitem__(self, name: str) -> NDArray[Any]:
        import netCDF4

        place = self.places[name]
        try:
            with ONE_AT_A_TIME, netCDF4.Dataset(self.path) as file:
                values = file[place][...]
        except Exception as problem:  # whatever the damaged bytes lead the library to
            raise BadInput(f"its variable {name} cannot be read: {problem}", str(self.path)) from None
        masked = np.ma.isMaskedArray(values) and np.ma.is_masked(values)
        return values.astype(np.float64).filled(np.nan) if masked else np.asarray(values)

    def __iter__(self) -> Iterator[str]:
        return iter(self.places)

    def __len__(self) -> int:
        return len(self.places)


def _numeric(group: Any, prefix: str) -> Iterator[tuple[str, str]]:
    """Name and place of each numeric variable of a group and of those in it."""
    for name, held in group.variables.items():
        if np.dtype(held.dtype).kind in "iufb":
            yield f"{prefix}{name}", f"{group.path.rstrip('/')}/{name}"
    for name, inner in group.groups.items():
        yield from _numeric(inner, f"{prefix}{name}.")


def read_netcdf(path: Path) -> Arrays:
    """The variables of a netCDF file by name, "GROUP.NAME" those of a group; raises BadInput."""
    _check_whole(path)
    try:
        return _Variables(path)
    except Exception as problem:  # as above
        raise BadInput(f"cannot be read as a netCDF file: {problem}", str(path)) from None


def _check_whole(path: Path) -> None:
    """Refuse a netCDF-3 file that breaks off: the netCDF library gives zeros for what is missing."""
    with path.open("rb") as file:
        if file.read(4) not in CLASSIC:
            return
    from scipy.io import netcdf_file

    try:
        netcdf_file(path, mmap=False).close()
    except ValueError:
        raise BadInput("the file is cut off: it is shorter than its variables", str(path)) from None
    except Exception:  # scipy cannot read it; whether the netCDF library can is seen later
        return
