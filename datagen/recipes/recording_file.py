"""Reading a recording from .npy, .npz, .csv or .wav."""

from __future__ import annotations

import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput

SUFFIXES = (".npy", ".npz", ".csv", ".wav")
MOST_COLUMNS = 2


@dataclass(frozen=True)
class RecordingFile:
    """`samples` (N, C), C = 1 or 2, rounded to float32, and the sampling `rate` (Hz), None where the file has none."""

    samples: NDArray[np.float32]
    rate: float | None


def read_recording(path: Path, variable: str | None, columns: tuple[int, ...] | None) -> RecordingFile:
    """The recording in `path`: the array `variable` of an .npz file, the `columns` (from 1) of a table.

    Raises BadInput if the file cannot be read, is no table of numbers, or holds a number that is not finite.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise BadInput("not a kind of file that can be read", str(path), "file", path.name, ", ".join(SUFFIXES))
    try:
        table, rate = _read(path, variable)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error) or "cut short"
        raise BadInput(f"{path} cannot be read ({reason})", field="file") from None
    return RecordingFile(_chosen(path, table, columns), rate)


def _read(path: Path, variable: str | None) -> tuple[NDArray[np.float64], float | None]:
    suffix = path.suffix.lower()
    if suffix == ".wav":
        return _read_wav(path)
    if suffix == ".npz":
        return _read_npz(path, variable)
    return (_read_csv(path) if suffix == ".csv" else _numbers(path, np.load(path, allow_pickle=False))), None


def _read_wav(path: Path) -> tuple[NDArray[np.float64], float]:
    from scipy.io import wavfile

    rate, found = wavfile.read(path)
    if found.dtype == np.uint8:
        return _numbers(path, (found.astype(np.float64) - 128.0) / 128.0), float(rate)
    full_scale = 1.0 if found.dtype.kind == "f" else float(-np.iinfo(found.dtype).min)
    return _numbers(path, found / full_scale), float(rate)


def _read_npz(path: Path, variable: str | None) -> tuple[NDArray[np.float64], float | None]:
    with np.load(path, allow_pickle=False) as archive:
        rate = float(archive["rate_hz"]) if "rate_hz" in archive else None
        names = [name for name in archive.files if name != "rate_hz"]
        if variable is None and len(names) != 1:
            raise BadInput(f"{path.name} holds several arrays", field="variable", allowed=", ".join(names))
        if variable is not None and variable not in names:
            raise BadInput(f"{path.name} has no such array", field="variable", allowed=", ".join(names))
        return _numbers(path, archive[variable or names[0]]), rate


def _read_csv(path: Path) -> NDArray[np.float64]:
    lines = path.read_text(encoding="utf-8").splitlines()
    heading = 0 if lines and _is_row(lines[0]) else 1
    return np.loadtxt(lines[heading:], delimiter=",", ndmin=2, dtype=np.float64)


def _is_row(line: str) -> bool:
    try:
        return bool([float(cell) for cell in line.split(",")])
    except ValueError:
        return False


def _numbers(path: Path, found: NDArray[np.generic]) -> NDArray[np.float64]:
    if found.dtype.kind not in "iuf" or found.ndim not in (1, 2) or not found.size:
        raise BadInput(f"{path.name} is no table of numbers (samples along its first dimension)", field="file")
    table = found.astype(np.float64)
    return table[:, None] if table.ndim == 1 else table


def _chosen(path: Path, table: NDArray[np.float64], columns: tuple[int, ...] | None) -> NDArray[np.float32]:
    width = table.shape[1]
    if columns is None and width > MOST_COLUMNS:
        raise BadInput(f"{path.name} has {width} columns", field="columns", allowed="one or two of them")
    if columns is not None and max(columns) > width:
        raise BadInput(f"{path.name} has {width} columns", field="columns", allowed=f"1 to {width}")
    chosen = table if columns is None else table[:, [column - 1 for column in columns]]
    with np.errstate(over="ignore"):
        rounded = chosen.astype(np.float32)
    bad = ~np.isfinite(rounded)
    if bad.any():
        first = int(np.flatnonzero(bad.any(axis=1))[0])
        problem = f"{path.name} holds {int(bad.sum())} numbers that are not finite, the first at sample {first}"
        raise BadInput(problem, field="file")
    return rounded
