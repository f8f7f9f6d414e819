"""The folder of the recordings: which files below it a name or a pattern means, and what messages call them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from datagen.recordings.file_names import FileNames, by_number, fits, spellings

MOST_NAMED = 4


@dataclass(frozen=True)
class Root:
    """The `folder` of the recordings."""

    folder: Path

    @cached_property
    def below(self) -> FileNames:
        """Every file below the folder, with its name from there."""
        found = (path for path in sorted(self.folder.rglob("*"), key=by_number) if path.is_file())
        return FileNames({path: path.relative_to(self.folder).as_posix() for path in found})

    def matching(self, pattern: str) -> list[Path]:
        """Whatever below the folder matches the `pattern`, in order; raises what Path.glob raises."""
        return sorted({path for wish in spellings(pattern) for path in self.folder.glob(wish)}, key=by_number)

    def name(self, path: Path) -> str:
        """The file's name from the folder, where it lies below it."""
        return (path.relative_to(self.folder) if path.is_relative_to(self.folder) else path).as_posix()

    def some(self, paths: Sequence[Path]) -> str:
        """The names of the first few files."""
        return ", ".join([self.name(path) for path in paths[:MOST_NAMED]] + ["…"] * (len(paths) > MOST_NAMED))

    def fits(self, path: Path, pattern: str) -> bool:
        """True if a file equals or matches the `pattern` (see `file_names.fits`)."""
        return fits(path, self.name(path), pattern)
