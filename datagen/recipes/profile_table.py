"""A measured spall: a file of angles and depths, as a recipe names it."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

from pydantic import Field, ValidationInfo, model_validator

from datagen.errors import BadInput
from datagen.files.csv_rows import read_csv_rows
from datagen.files.number_texts import number
from datagen.settings.table import Table, refuse
from physics.spall import DEEPEST

COLUMNS = ("angle_deg", "depth_um")
FOLDER = "folder"
DEEPEST_UM = DEEPEST * 1e6


class ProfileTable(Table):
    """A measured surface: a CSV file with the columns `angle_deg` (rising, along increasing angle) and `depth_um`."""

    name: str
    angle_deg: tuple[float, ...] = Field(strict=False)
    depth_um: tuple[float, ...] = Field(strict=False)

    @model_validator(mode="before")
    @classmethod
    def _read(cls, value: object, info: ValidationInfo) -> object:
        if isinstance(value, ProfileTable | dict):
            return value
        if not isinstance(value, str):
            raise refuse("", allowed=f"the name of a CSV file with the columns {' and '.join(COLUMNS)}")
        folder = (info.context or {}).get(FOLDER, Path())
        return {"name": Path(value).name} | read_table(Path(folder) / value)

    @model_validator(mode="after")
    def _is_a_surface(self) -> ProfileTable:
        if len(self.angle_deg) != len(self.depth_um) or len(self.angle_deg) < 2:
            raise refuse("angle_deg and depth_um must hold equally many numbers, at least two")
        if not all(math.isfinite(value) for value in (*self.angle_deg, *self.depth_um)):
            raise refuse("angle_deg and depth_um must be finite")
        if any(after <= before for before, after in pairwise(self.angle_deg)):
            raise refuse("angle_deg must rise")
        for depth in self.depth_um:
            if not 0.0 <= depth <= DEEPEST_UM:
                raise refuse(_wrong_depth(depth))
        if max(self.depth_um) == 0.0:
            raise refuse("depth_um is 0 throughout: this is no spall")
        if self.extent_deg > 180.0:
            raise refuse(f"the table covers {self.extent_deg:g} degrees; allowed: at most 180")
        return self

    @property
    def extent_deg(self) -> float:
        """Arc from the first to the last angle, degrees."""
        return self.angle_deg[-1] - self.angle_deg[0]

    def centred_angles(self) -> tuple[float, ...]:
        """Angles from the middle of the table, rad."""
        middle = (self.angle_deg[0] + self.angle_deg[-1]) / 2.0
        return tuple(math.radians(angle - middle) for angle in self.angle_deg)

    def depths(self) -> tuple[float, ...]:
        """Depth at each angle, m."""
        return tuple(depth / 1e6 for depth in self.depth_um)


def read_table(path: Path) -> dict[str, tuple[float, ...]]:
    """The columns of a profile file; raises PydanticCustomError naming the file and the line."""
    try:
        rows = read_csv_rows(path)
    except OSError as error:
        raise refuse(f"{path} cannot be read ({error.strerror})") from None
    except BadInput as problem:
        raise refuse(str(problem)) from None
    if not rows or tuple(cell.strip() for cell in rows[0][1]) != COLUMNS:
        raise refuse(f"{path}: the first line must be {','.join(COLUMNS)}")
    numbers = [_numbers(path, line, row) for line, row in rows[1:]]
    return {"angle_deg": tuple(angle for angle, _ in numbers), "depth_um": tuple(depth for _, depth in numbers)}


def _numbers(path: Path, line: int, row: list[str]) -> tuple[float, float]:
    found = [number(cell) for cell in row]
    if len(found) != len(COLUMNS) or not all(map(math.isfinite, found)):
        raise refuse(f"{path}, line {line}: {','.join(row)} is not two finite numbers")
    angle, depth = found
    if depth < 0.0 or depth > DEEPEST_UM:
        raise refuse(f"{path}, line {line}: {_wrong_depth(depth)}")
    return angle, depth


def _wrong_depth(depth: float) -> str:
    return f"depth_um = {depth:g}; allowed: 0 to {DEEPEST_UM:g}"
