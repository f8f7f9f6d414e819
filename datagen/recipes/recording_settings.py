"""Somebody's recording of a healthy machine, as a recipe names it."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError, ValidationInfo, model_validator
from pydantic.json_schema import SkipJsonSchema

from datagen.distributions.kinds import Distribution, Fixed
from datagen.errors import BadInput
from datagen.files.digest import file_hash
from datagen.formats.csv_layout import CsvLayout
from datagen.recipes.profile_table import FOLDER
from datagen.recipes.recording_file import read_background
from datagen.settings.table import Between, Table, refuse

Channel = Annotated[str, Field(min_length=1)]
LEARNT = ("sha256", "samples", "rate_hz")


def _without_default(schema: dict[str, Any]) -> None:
    """Take the default away, which only stands for what is found on reading, and which no recipe may state."""
    schema.pop("default", None)


class RecordedLayerSettings(Table):
    """A file in the recipe's folder (.mat, .npz, .npy, .csv, .wav, .nc), sampled at the rate of the records.

    One channel goes to both axes, each from its own place in the recording; two go to x and y from one place.
    """

    file: Annotated[str, Field(min_length=1)]
    """Name of the file, as seen from the recipe's folder."""
    rate_hz: Annotated[float, Field(gt=0.0, json_schema_extra=_without_default)] = 0.0
    """Sampling rate of the recording, Hz; needed unless the file states it (.wav, or a variable rate_hz)."""
    channels: tuple[Channel, ...] | None = Field(default=None, min_length=1, max_length=2, strict=False)
    """Variable of the one channel, or of x and y, written as in the SPEC of an import; the only one if not given."""
    csv: CsvLayout = CsvLayout()
    """Layout of a text table."""
    gain_m_s2: Annotated[Distribution, Between(0.0, 1e9)] = Fixed(1.0)
    """Acceleration for one unit of the file, m/s²; of whole numbers in .wav, for the full scale."""
    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$", json_schema_extra=_without_default)] = ""
    """SHA-256 of the file, found on reading; a recipe that states it accepts no other file."""
    samples: Annotated[int, Field(ge=1, json_schema_extra=_without_default)] = 0
    """Samples of the recording, found on reading."""
    path: SkipJsonSchema[str] = Field(default="", exclude=True)
    """Where the file was found, not part of the recipe; empty where only what was learnt of it is at hand."""

    @model_validator(mode="before")
    @classmethod
    def _read(cls, value: object, info: ValidationInfo) -> object:
        if not isinstance(value, dict) or not isinstance(value.get("file"), str):
            return value
        if "path" in value:
            raise refuse("unknown key", "path")
        if not _are_channels(value.get("channels")):
            return value
        path = Path((info.context or {}).get(FOLDER, Path())).absolute() / value["file"]
        try:
            found = path.is_file()
        except OSError as problem:  # such as a name too long
            raise refuse(f"it cannot be read ({problem.strerror})", "file") from None
        return value if not found and all(name in value for name in LEARNT) else _learnt(value, path)

    @property
    def at_hand(self) -> bool:
        """True if the file itself can be read, and not only what was learnt of it."""
        return bool(self.path) and Path(self.path).is_file()

    def load(self) -> NDArray[np.float32]:
        """The recording (N, C) in units of the file; BadInput if the file is gone or another than was described."""
        if not self.at_hand:
            raise BadInput(f"the recording (SHA-256 {self.sha256}) is not at hand", file=self.path or self.file)
        return _loaded(self.path, self.sha256, self.channels, self.csv)


def _are_channels(value: object) -> bool:
    """Whether the names of channels, if there are any, are written as they must be."""
    if value is None:
        return True
    return isinstance(value, list | tuple) and len(value) in (1, 2) and all(isinstance(name, str) for name in value)


def _learnt(value: dict[str, Any], path: Path) -> dict[str, Any]:
    """The recipe's table with what the file itself says; raises PydanticCustomError."""
    channels = value.get("channels")
    try:
        layout = CsvLayout.model_validate(value.get("csv", {}))
        read = read_background(path, None if channels is None else tuple(channels), layout)
    except ValidationError:
        return value
    except BadInput as problem:
        field = problem.field if problem.field in ("channels", "file") else "file"
        where = Path(problem.file).name if problem.file else path.name  # its line, where that is known, is in it
        raise refuse(f"{where}: {problem.problem}", field, problem.allowed) from None
    stated = value.get("rate_hz", read.rate)
    if stated is None:
        raise refuse(f"{path.name} does not state its sampling rate", "rate_hz", "a number of Hz")
    if read.rate is not None and stated != read.rate:
        raise refuse(f"{path.name} says {read.rate:g} Hz", "rate_hz", f"{read.rate:g}")
    sha256 = file_hash(path)
    if value.get("sha256", sha256) != sha256:
        raise refuse(f"{path.name} is another file: its SHA-256 is {sha256}", "sha256")
    rate = float(stated) if type(stated) is int else stated
    return value | {"rate_hz": rate, "sha256": sha256, "samples": read.samples.shape[0], "path": str(path)}


@lru_cache(maxsize=4)
def _loaded(path: str, sha256: str, channels: tuple[str, ...] | None, layout: CsvLayout) -> NDArray[np.float32]:
    """The recording (N, C) in the file with these bytes; BadInput if it has others by now."""
    samples, found = read_background(Path(path), channels, layout).samples, file_hash(Path(path))
    if found != sha256:
        raise BadInput("the recording has changed since the recipe was read", file=path, field="sha256", value=found)
    return samples
