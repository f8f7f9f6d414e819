"""A record's signal, read by h5py from a shard that is open for this alone.

netCDF reads all that a file says of its variables when it opens one, which takes longer than to read the signals of a
record: 25 ms for a shard, which h5py opens in a quarter of a millisecond.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from datagen.files.netcdf import ONE_AT_A_TIME
from labels.variables import VARIABLES

SIGNALS = {one.name for one in VARIABLES if one.dims[0] == "record" and len(one.dims) > 1}
# A stored number is what it says unless one of these attributes is there, which netCDF heeds.
SCALES = ("scale_factor", "add_offset")


def quick_signal(path: Path, variable: str, record: int, position: int) -> NDArray[Any] | None:
    """What netCDF reads of a `variable` of the `record` at a `position` of the shard at `path`.

    None where netCDF has to be asked, which says what is wrong if something is: of all but the numbers of signals, and
    where h5py is missing.
    """
    if variable not in SIGNALS:
        return None
    try:
        import h5py

        with ONE_AT_A_TIME, h5py.File(path, "r") as file:
            held = file[variable]
            plain = held.dtype.kind == "f" and not any(name in held.attrs for name in SCALES)
            if plain and int(file["record"][position]) == record:
                found: NDArray[Any] = held[position]
                return found
    except (ImportError, OSError, RuntimeError, ValueError, KeyError, IndexError, MemoryError):
        pass
    return None
