"""The one or two channels of a healthy machine's recording, read by the readers of imported recordings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.files.places import no_file
from datagen.formats.arrays import Arrays, choose
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import read_arrays
from datagen.formats.wav_file import RATE_NAME

MOST_CHANNELS = 2


@dataclass(frozen=True)
class RecordingFile:
    """`samples` (N, C), C = 1 or 2, rounded to float32, and the sampling `rate` (Hz), None where the file has none."""

    samples: NDArray[np.float32]
    rate: float | None


def read_background(path: Path, channels: tuple[str, ...] | None, layout: CsvLayout) -> RecordingFile:
    """The recording in `path`: the variables named by `channels`, or the only one that there is.

    Raises BadInput if the file cannot be read, is no table of numbers, or holds a number that is not finite.
    """
    if not path.is_file():
        raise BadInput(no_file(path), file=str(path), field="file")
    arrays = read_arrays(path, None, layout)
    rate = _rate(arrays[RATE_NAME], path) if RATE_NAME in arrays else None
    table = _named(arrays, channels, path) if channels else _only(arrays, path)
    if table.dtype.kind not in "iuf" or table.ndim != 2 or not table.size:
        raise _no_table(path)
    if table.shape[1] > MOST_CHANNELS:
        raise BadInput(
            f"it has {table.shape[1]} columns",
            file=str(path),
            field="channels",
            allowed='one or two, as in "data[:,0]"',
        )
    return RecordingFile(_finite(table, path), rate)


def _rate(said: NDArray[np.generic], path: Path) -> float:
    if said.size != 1 or said.dtype.kind not in "iuf":
        number = f"{said.size} values" if said.dtype.kind in "iuf" else "no number"
        raise BadInput(
            f"it holds {number}", file=str(path), field=RATE_NAME, allowed="one number, the sampling rate in Hz"
        )
    return float(said.reshape(()))


def _named(arrays: Arrays, channels: tuple[str, ...], path: Path) -> NDArray[np.generic]:
    found = [choose(arrays, wish, path, "channels") for wish in channels]
    if len({axis.shape for axis in found}) > 1 or any(axis.ndim != 1 for axis in found if len(found) > 1):
        raise BadInput("the two channels are not equally long", file=str(path), field="channels", value=list(channels))
    return np.stack(found, axis=1) if found[0].ndim == 1 else found[0]


def _only(arrays: Arrays, path: Path) -> NDArray[np.generic]:
    names = [name for name in arrays if name != RATE_NAME]
    if not names:
        raise _no_table(path)
    if len(names) != 1:
        raise BadInput(
            f"it has {len(names)} variables", file=str(path), field="channels", allowed=f"one or two of {names}"
        )
    found = np.asarray(arrays[names[0]])
    return found[:, None] if found.ndim == 1 else found


def _no_table(path: Path) -> BadInput:
    return BadInput("no table of numbers, samples along its first dimension", file=str(path), field="file")


def _finite(table: NDArray[np.generic], path: Path) -> NDArray[np.float32]:
    with np.errstate(over="ignore"):
        rounded = table.astype(np.float32)
    bad = ~np.isfinite(rounded).all(axis=1)
    if bad.any():
        first = int(np.flatnonzero(bad)[0])
        found = "NaN" if np.isnan(rounded[first]).any() else "a number that is not finite"
        problem = f"it holds {found} at sample {first} ({int(bad.sum())} such of {bad.size} samples)"
        raise BadInput(problem, file=str(path), field="file", value=path.name, allowed="finite numbers")
    return rounded
