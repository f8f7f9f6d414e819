"""NetCDF files, and HDF5 files that the netCDF library can read: variables scaled by their own attributes, and the
numbers among the attributes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.files.netcdf import ONE_AT_A_TIME
from datagen.formats.arrays import Arrays, ReadWhenAsked, as_numbers

# The two formats of netCDF-3 that scipy knows too, and the one that it does not.
CLASSIC, LARGE = (b"CDF\x01", b"CDF\x02"), b"CDF\x05"
# What parts the name of a variable from that of its attribute.
ATTRIBUTE = "@"
Place = tuple[str, str]


class _Variables(ReadWhenAsked):
    """The variables of a file; missing values are NaN.

    Attributes come by their names too, but are not among those that are listed, nor fit a pattern.
    """

    def __init__(self, path: Path) -> None:
        import netCDF4

        self.path = path
        with ONE_AT_A_TIME, netCDF4.Dataset(path) as file:
            self.places = dict(_numeric(file, ""))
        super().__init__(tuple(name for name, (_, attribute) in self.places.items() if not attribute))

    def __contains__(self, name: object) -> bool:
        return name in self.places

    def _read(self, name: str) -> NDArray[Any]:
        import netCDF4

        place, attribute = self.places[name]
        try:
            with ONE_AT_A_TIME, netCDF4.Dataset(self.path) as file:
                held: Any = file[place] if place else file
                if attribute:
                    return _attribute(held, attribute)
                values = held[...]
        except Exception as problem:  # whatever the damaged bytes lead the library to
            raise BadInput(f"its variable {name} cannot be read: {problem}", file=str(self.path)) from None
        masked = np.ma.isMaskedArray(values) and np.ma.is_masked(values)
        return values.astype(np.float64).filled(np.nan) if masked else np.asarray(values)


def _numeric(group: Any, prefix: str) -> Iterator[tuple[str, Place]]:
    """Name and place of each numeric variable and attribute of a group and of those in it."""
    above = group.path.rstrip("/")
    yield from _attributes(group, prefix.removesuffix("."), above)
    for name, held in group.variables.items():
        if np.dtype(held.dtype).kind in "iufb":
            yield f"{prefix}{name}", (f"{above}/{name}", "")
        yield from _attributes(held, f"{prefix}{name}", f"{above}/{name}")
    for name, inner in group.groups.items():
        yield from _numeric(inner, f"{prefix}{name}.")


def _attributes(held: Any, name: str, place: str) -> Iterator[tuple[str, Place]]:
    """Name and place of each attribute of a group or variable that is a number, or a text that is one."""
    for attribute in held.ncattrs():
        if _attribute(held, attribute).dtype.kind in "iuf":
            yield f"{name}{ATTRIBUTE}{attribute}", (place, attribute)


def _attribute(held: Any, attribute: str) -> NDArray[Any]:
    return as_numbers(np.asarray(held.getncattr(attribute)))


def read_netcdf(path: Path) -> Arrays:
    """The variables of a netCDF file by name, "GROUP.NAME" those of a group; raises BadInput.

    An attribute that is a number is called "NAME@ATTRIBUTE" or "GROUP@ATTRIBUTE", one of the whole file "@ATTRIBUTE".
    """
    _check_whole(path)
    try:
        return _Variables(path)
    except Exception as problem:  # as above
        raise BadInput(f"cannot be read as a netCDF file: {problem}", file=str(path)) from None


def _check_whole(path: Path) -> None:
    """Refuse a netCDF-3 file that breaks off, or may: the netCDF library makes up what is missing."""
    with path.open("rb") as file:
        kind = file.read(4)
    if kind == LARGE:
        raise BadInput(
            "whether a netCDF-3 file of 64-bit data (CDF-5) is whole cannot be told", file=str(path),
            allowed="netCDF-4, as `nccopy -k nc4 OLD NEW` makes of it",
        )  # fmt: skip
    if kind not in CLASSIC:
        return
    from scipy.io import netcdf_file

    try:
        netcdf_file(path, mmap=False).close()
    except ValueError:
        raise BadInput("the file is cut off: it is shorter than its variables", file=str(path)) from None
    except Exception:  # scipy cannot read it; whether the netCDF library can is seen later
        return
