"""Results as files: picture, table and JSON of one name."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from datagen.files.atomic import write_results
from datagen.files.places import require_results_folder
from datagen.files.plain import plain_json


def results_folder(folder: Path) -> Path:
    """The folder to write into, made if need be; raises BadInput if that cannot be."""
    require_results_folder(folder)
    write_results(folder, {})
    return folder


def write_files(
    folder: Path, name: str, pictures: bytes | Sequence[bytes], facts: object, table: str | None = None
) -> list[Path]:
    """Write NAME.png, of several pictures also NAME_2.png and so on, NAME.json and, if there is a table, NAME.csv.

    Gives their paths; raises BadInput where they cannot be written, as on a full disk.
    """
    sheets = [pictures] if isinstance(pictures, bytes) else pictures
    contents = {f"{name}.png" if k == 1 else f"{name}_{k}.png": sheet for k, sheet in enumerate(sheets, 1)}
    contents[f"{name}.json"] = plain_json(facts).encode()
    if table is not None:
        contents[f"{name}.csv"] = table.encode()
    write_results(folder, contents)
    return [folder / file for file in contents]
