"""Which files a part of a SPEC means: those that its patterns find, those that its table lists, or both."""

from __future__ import annotations

import os
from dataclasses import dataclass
from glob import escape
from pathlib import Path
from typing import NamedTuple

from datagen.errors import BadInput
from datagen.files.places import no_file
from datagen.recordings.file_names import FileNames, hidden
from datagen.recordings.label_table import TableRow, read_label_table
from datagen.recordings.root import MOST_NAMED, Root
from datagen.recordings.spec import Recording
from datagen.recordings.unchanged import require_unchanged


class Found(NamedTuple):
    """The files of a part, each with what a table says of it, that table by its name in the SPEC, and the listed files
    that were not there."""

    files: list[tuple[Path, TableRow | None]]
    tables: dict[str, Path]
    absent: list[str]


@dataclass(frozen=True)
class PartFiles:
    """The files of one `recording` of the SPEC in the file `spec`, looked for below `root`; `place` is for messages."""

    spec: Path
    recording: Recording
    root: Root
    place: str

    def find(self) -> Found:
        """Its files; raises BadInput."""
        name = self.recording.table
        tables = {} if name is None else {name: self._table(name)}
        rows = [row for table in tables.values() for row in read_label_table(table, self.recording.note_columns)]
        files, absent = self._globbed_files(rows) if self.recording.patterns else self._listed_files(rows)
        if self._refuses:
            self._refuse_idle_overrides([path for path, _ in files])
        return Found(files, tables, absent)

    @property
    def _refuses(self) -> bool:
        """True if no file may be absent."""
        return self.recording.absent_files == "refuse"

    def _table(self, name: str) -> Path:
        places = (self.spec.parent / name, self.root.folder / name)
        path = next((path for path in places if os.path.isfile(path)), None)
        if path is None:
            told = no_file(next(filter(os.path.exists, places), places[0]))
            raise BadInput(told, file=str(self.spec), field="table", value=name)
        require_unchanged(path)
        return path

    def _listed_files(self, rows: list[TableRow]) -> tuple[list[tuple[Path, TableRow | None]], list[str]]:
        """The file of each row, and what is absent."""
        files: list[tuple[Path, TableRow | None]] = []
        absent = []
        for row in rows:
            path = self._listed(row)
            if path is None:
                absent.append(self._absent(row))
            else:
                files.append((path, row))
        return files, absent

    def _listed(self, row: TableRow) -> Path | None:
        """The file that a row means: the one at that place below the root, or else the only one of that name anywhere
        below it; None if there is none."""
        folder = self.root.folder
        for name in row.files:
            if os.path.isfile(folder / name):  # False too for a name too long for a file
                return folder / name
            fitting = self.root.below.fitting(name)
            if len(fitting) > 1:
                known = ", ".join(self.root.name(path) for path in fitting[:MOST_NAMED])
                raise BadInput(
                    f"{len(fitting)} files below {folder} match: {known}", file=row.place, field="file", value=name
                )
            if fitting:
                return fitting[0]
        return None

    def _absent(self, row: TableRow) -> str:
        """What is absent where no file is the one of a row; raises BadInput if it must not be."""
        if self._refuses:
            folder = self.root.folder
            there = any(os.path.isdir(folder / name) for name in row.files)
            told = f"this is a folder below {folder}" if there else f"no such file below {folder}"
            raise BadInput(told, file=row.place, field="file", value="|".join(row.files))
        return row.files[0]

    def _globbed_files(self, rows: list[TableRow]) -> tuple[list[tuple[Path, TableRow | None]], list[str]]:
        """The files that the patterns mean, each with the rows about it if there is a table, and what is absent."""
        paths, absent = self._globbed()
        if not self.recording.table:
            return [(path, None) for path in paths], absent
        said, idle = self._rows_of(paths, rows)
        for path in paths:
            if path not in said:
                problem = f"{self.root.name(path)} is not in the table {self.recording.table}"
                allowed = "a row for each file that files finds, its cells empty where nothing is known, or leave_out"
                raise BadInput(problem, file=self.place, allowed=allowed)
        return [(path, row) for path in paths for row in said[path]], absent + list(map(self._absent, idle))

    def _rows_of(self, paths: list[Path], rows: list[TableRow]) -> tuple[dict[Path, list[TableRow]], list[TableRow]]:
        """The rows about each file, in order, and the rows that are about none."""
        names = FileNames({path: self.root.name(path) for path in paths})
        said: dict[Path, list[TableRow]] = {}
        idle = []
        for row in rows:
            fitting = dict.fromkeys(path for name in row.files for path in names.fitting(name))
            for path in fitting:
                said.setdefault(path, []).append(row)
            if not fitting:
                idle.append(row)
        return said, idle

    def _globbed(self) -> tuple[list[Path], list[str]]:
        """The files that the patterns mean, and what is absent: patterns without a file, links to what is not there."""
        paths: dict[Path, None] = {}
        absent = []
        for pattern in self.recording.patterns:
            fitting = self._fitting(pattern)
            if not fitting:
                absent.append(pattern)
            paths |= dict.fromkeys(fitting)
        wanted = self._wanted(list(paths))
        dead = list(filter(_leads_nowhere, wanted))
        if dead and self._refuses:
            raise BadInput(
                f"{len(dead)} of {len(wanted)} files are links to what is not there: {self.root.some(dead)}",
                file=self.place, field="files", value=" ".join(self.recording.patterns),
                allowed='the files themselves, or absent_files = "skip"',
            )  # fmt: skip
        return [path for path in wanted if path.exists()], absent + list(map(self.root.name, dead))

    def _fitting(self, pattern: str) -> list[Path]:
        """The files, and the links to what is not there, that a pattern means; none only where they may be absent."""
        try:
            # A name may hold brackets: what is called like the pattern goes before what fits it.
            found = self.root.matching(escape(pattern)) or self.root.matching(pattern)
        except (ValueError, NotImplementedError, IndexError):
            raise BadInput(field="files", file=self.place, value=pattern, allowed='as in "folder/*.mat"') from None
        fitting = [path for path in found if (path.is_file() or _leads_nowhere(path)) and not hidden(path, pattern)]
        if not fitting and self._refuses:
            raise self._unmatched(pattern, found)
        return fitting

    def _unmatched(self, pattern: str, found: list[Path]) -> BadInput:
        problem = f"no file below {self.root.folder} matches"
        if any(path.is_dir() for path in found):
            allowed = 'the files in it, as in "folder/*.mat"'
            return BadInput(f"{problem}, but a folder", file=self.place, field="files", value=pattern, allowed=allowed)
        return BadInput(problem, file=self.place, field="files", value=pattern)

    def _wanted(self, paths: list[Path]) -> list[Path]:
        """The paths without those that are to be left out."""
        for pattern in self.recording.unwanted:
            kept = [path for path in paths if not self.root.fits(path, pattern)]
            if len(kept) == len(paths) and self._refuses:
                raise BadInput(
                    "matches none of the files",
                    file=self.place,
                    field="leave_out",
                    value=pattern,
                    allowed=self.root.some(paths),
                )
            paths = kept
        return paths

    def _refuse_idle_overrides(self, paths: list[Path]) -> None:
        for number, override in enumerate(self.recording.override, start=1):
            for pattern in override.patterns:
                if not any(self.root.fits(path, pattern) for path in paths):
                    raise BadInput(
                        "matches none of these recordings",
                        file=f"{self.place}, override[{number}]",
                        field="files",
                        value=pattern,
                        allowed=f'{self.root.some(paths)}; with absent_files = "skip" there may be none',
                    )


def _leads_nowhere(path: Path) -> bool:
    return path.is_symlink() and not path.exists()
