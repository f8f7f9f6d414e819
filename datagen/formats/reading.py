"""Opening a recording's file by its format."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from datagen.errors import BadInput, unreadable
from datagen.formats.arrays import Arrays
from datagen.formats.csv_file import read_csv
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.mat_file import read_mat
from datagen.formats.netcdf_file import read_netcdf
from datagen.formats.numpy_file import read_npy, read_npz
from datagen.formats.wav_file import read_wav

FORMATS = ("mat", "npz", "npy", "csv", "wav", "nc")
ENDINGS = {"txt": "csv", "tsv": "csv", "cdf": "nc", "nc4": "nc", "h5": "nc", "hdf5": "nc", "wave": "wav"}
READERS: dict[str, Callable[[Path], Arrays]] = {
    "mat": read_mat,
    "npz": read_npz,
    "npy": read_npy,
    "wav": read_wav,
    "nc": read_netcdf,
}
GZIP = "gz"
PACKED = (GZIP, "bz2", "xz", "zst", "zip", "7z", "rar", "tar", "tgz")

# How a text begins that Git LFS leaves where the data itself was not fetched.
POINTER = b"version https://git-lfs"
# How a web page begins that a failed download left in place of the file.
PAGES = (b"<!doctype html", b"<html")


def file_format(path: Path, stated: str | None) -> str:
    """The format that is `stated`, or that the file's ending says; raises BadInput if it says none.

    Of a table of text .gz may stand behind its own ending.
    """
    ending = path.suffix.lower().removeprefix(".")
    inner = Path(path.stem).suffix.lower().removeprefix(".")
    if ending == GZIP and ENDINGS.get(inner, inner) == "csv":
        ending = inner
    if ending in PACKED and stated is None:
        known = f"the file unpacked, of a known format ({', '.join(FORMATS)}); only tables of text may stay .{GZIP}"
        raise BadInput("is packed", file=str(path), allowed=known)
    kind = stated or ENDINGS.get(ending, ending)
    if kind not in FORMATS:
        problem, allowed = "the file's name does not end like that of a known format", ", ".join(FORMATS)
        raise BadInput(
            problem, file=str(path), field="format", value=ending, allowed=f"{allowed}; csv is any table of text"
        )
    return kind


def _refuse_stand_in(path: Path) -> None:
    with path.open("rb") as file:
        begin = file.read(64)
    if begin.startswith(POINTER):
        raise BadInput(
            "holds no data but where Git LFS keeps it",
            file=str(path),
            allowed="the data, as `git lfs pull` fetches it",
        )
    if begin.lstrip().lower().startswith(PAGES):
        raise BadInput("is a web page, as of a download that failed", file=str(path), allowed="the data itself")


def read_arrays(path: Path, stated: str | None, layout: CsvLayout) -> Arrays:
    """The arrays of a file whose format is `stated` or follows from its ending; raises BadInput."""
    kind = file_format(path, stated)
    try:
        _refuse_stand_in(path)
        return read_csv(path, layout) if kind == "csv" else READERS[kind](path)
    except OSError as problem:
        raise unreadable(path, problem) from None
