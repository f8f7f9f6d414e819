"""Where SPECs are found: as a file first, then among those that come with spallgen."""

from __future__ import annotations

from pathlib import Path

from datagen.errors import BadInput, unreadable
from datagen.files.places import dataset_folders, refuse_other_than_file
from physics.spelling import suggestion


def shipped_specs() -> dict[str, Path]:
    """SPEC of each public collection of recordings that spallgen knows the layout of, by name."""
    found = [path for folder in reversed(dataset_folders()) for path in sorted(folder.glob("recordings/*.toml"))]
    return {path.stem: path for path in found}


def find_spec(path_or_name: str | Path) -> Path:
    """File of a SPEC given as a file or by name ("cwru"); raises BadInput."""
    path = Path(path_or_name)
    try:
        if path.is_file():
            return path
    except OSError as problem:
        raise unreadable(path, problem) from None
    shipped = shipped_specs()
    if path.name in shipped and path.parent == Path():
        return shipped[path.name]
    refuse_other_than_file(path, "the file of a SPEC, or the name of one")
    known = ", ".join(shipped) or "(none)"
    raise BadInput(f"no such file, and no SPEC of that name ({known}){suggestion(path.name, shipped)}", file=str(path))
