"""Which records a SPEC asks for: files found by pattern or listed in a table, times their channels."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from glob import escape
from pathlib import Path
from typing import Any

from datagen.errors import BadInput
from datagen.files.places import no_file
from datagen.recordings.file_names import FileNames, by_number, fits, hidden, spellings
from datagen.recordings.label_table import TableRow, read_label_table
from datagen.recordings.settings import ALTERNATIVES, Channel, merged
from datagen.recordings.spec import Recording, Spec
from datagen.recordings.unchanged import require_unchanged

SPEED_SETTINGS = ALTERNATIVES[0]

NOT_SETTINGS = ("name", "files", "leave_out", "table", "note_columns", "absent_files", "override")


@dataclass(frozen=True, eq=False)
class Request:
    """One channel of one file, with everything that the SPEC says of it; `place` is for messages."""

    part: str
    path: Path
    name: str
    channel: Channel
    settings: dict[str, Any]
    place: str


@dataclass(frozen=True)
class Listing:
    """All requests of a SPEC in order, the tables they came from, and the listed files that were not there."""

    requests: tuple[Request, ...]
    tables: tuple[Path, ...]
    absent: tuple[str, ...]


def list_requests(spec: Spec, root: Path) -> Listing:
    """Every record that the SPEC asks for below `root`; raises BadInput."""
    return _Finder(spec, root).listing()


class _Finder:
    def __init__(self, spec: Spec, root: Path) -> None:
        if not root.is_dir():
            raise BadInput("no such folder", str(spec.source), "root", str(root), "the folder of the recordings")
        self.spec, self.root = spec, root
        self.tables: list[Path] = []
        self.absent: list[str] = []

    def listing(self) -> Listing:
        requests: list[Request] = []
        for number, recording in enumerate(self.spec.recording, start=1):
            place = f"{self.spec.source}: recording[{number}] ({recording.name})"
            files = list(self._files(recording, place))
            if recording.absent_files == "refuse":
                self._refuse_idle_overrides(recording, place, [path for path, _ in files])
            requests += [request for file in files for request in self._requests(recording, place, *file)]
        if not requests:
            raise BadInput(f"none of its files is below {self.root}", str(self.spec.source), "root", str(self.root))
        return Listing(tuple(requests), tuple(self.tables), tuple(self.absent))

    @cached_property
    def _below(self) -> FileNames:
        """Every file below the root, with its name from there."""
        found = (path for path in sorted(self.root.rglob("*"), key=by_number) if path.is_file())
        return FileNames({path: path.relative_to(self.root).as_posix() for path in found})

    def _files(self, recording: Recording, place: str) -> Iterator[tuple[Path, TableRow | None]]:
        rows = self._rows(recording)
        if not recording.patterns:
            for row in rows:
                path = self._listed(row, recording)
                if path is not None:
                    yield path, row
            return
        paths = self._globbed(recording, place)
        if not recording.table:
            yield from ((path, None) for path in paths)
            return
        said, idle = self._rows_of(paths, rows)
        for path in paths:
            if path not in said:
                raise BadInput(f"{self._name(path)} is not in the table {recording.table}", place)
            yield from ((path, row) for row in said[path])
        for row in idle:
            self._is_absent(row, recording)

    def _rows_of(self, paths: list[Path], rows: list[TableRow]) -> tuple[dict[Path, list[TableRow]], list[TableRow]]:
        """The rows about each file, in order, and the rows that are about none."""
        names = FileNames({path: self._name(path) for path in paths})
        said: dict[Path, list[TableRow]] = {}
        idle = []
        for row in rows:
            fitting = dict.fromkeys(path for name in row.files for path in names.fitting(name))
            for path in fitting:
                said.setdefault(path, []).append(row)
            if not fitting:
                idle.append(row)
        return said, idle

    def _rows(self, recording: Recording) -> list[TableRow]:
        if recording.table is None:
            return []
        places = (self.spec.source.parent / recording.table, self.root / recording.table)
        path = next((path for path in places if path.is_file()), None)
        if path is None:
            told = no_file(next(filter(Path.exists, places), places[0]))
            raise BadInput(told, str(self.spec.source), "table", recording.table)
        self.tables.append(path)
        require_unchanged(path)
        return read_label_table(path, recording.note_columns)

    def _globbed(self, recording: Recording, place: str) -> list[Path]:
        paths: dict[Path, None] = {}
        for pattern in recording.patterns:
            try:
                # A name may hold brackets: what is called like the pattern goes before what fits it.
                found = self._matching(escape(pattern)) or self._matching(pattern)
            except (ValueError, NotImplementedError, IndexError):
                raise BadInput(field="files", file=place, value=pattern, allowed='as in "folder/*.mat"') from None
            fitting = [path for path in found if (path.is_file() or _leads_nowhere(path)) and not hidden(path, pattern)]
            if not fitting and recording.absent_files == "skip":
                self.absent.append(pattern)
            elif not fitting:
                raise self._unmatched(pattern, found, place)
            paths |= dict.fromkeys(fitting)
        return self._present(self._wanted(list(paths), recording, place), recording, place)

    def _unmatched(self, pattern: str, found: list[Path], place: str) -> BadInput:
        problem = f"no file below {self.root} matches"
        if any(path.is_dir() for path in found):
            allowed = 'the files in it, as in "folder/*.mat"'
            return BadInput(f"{problem}, but a folder", place, "files", pattern, allowed)
        return BadInput(problem, place, "files", pattern)

    def _matching(self, pattern: str) -> list[Path]:
        return sorted({path for wish in spellings(pattern) for path in self.root.glob(wish)}, key=by_number)

    def _present(self, paths: list[Path], recording: Recording, place: str) -> list[Path]:
        """The paths without dangling links, such as those of a data set that was fetched only in part."""
        dead = list(filter(_leads_nowhere, paths))
        if dead and recording.absent_files == "refuse":
            raise BadInput(
                f"{len(dead)} of {len(paths)} files are links to what is not there: {self._some(dead)}", place, "files",
                " ".join(recording.patterns), 'the files themselves, or absent_files = "skip"',
            )  # fmt: skip
        self.absent += map(self._name, dead)
        return [path for path in paths if path.exists()]

    def _wanted(self, paths: list[Path], recording: Recording, place: str) -> list[Path]:
        """The paths without those that are to be left out."""
        for pattern in recording.unwanted:
            kept = [path for path in paths if not self._fits(path, pattern)]
            if len(kept) == len(paths) and recording.absent_files == "refuse":
                raise BadInput("matches none of the files", place, "leave_out", pattern, self._some(paths))
            paths = kept
        return paths

    def _some(self, paths: list[Path]) -> str:
        return ", ".join([self._name(path) for path in paths[:4]] + (["…"] if len(paths) > 4 else []))

    def _name(self, path: Path) -> str:
        """The file's name from the root, where it lies below it."""
        return (path.relative_to(self.root) if path.is_relative_to(self.root) else path).as_posix()

    def _fits(self, path: Path, pattern: str) -> bool:
        return fits(path, self._name(path), pattern)

    def _listed(self, row: TableRow, recording: Recording) -> Path | None:
        """The file that a row means: the one at that place below the root, or else the only one of that name anywhere
        below it; None if it is absent and may be."""
        for name in row.files:
            if (self.root / name).is_file():
                return self.root / name
            fitting = self._below.fitting(name)
            if len(fitting) > 1:
                known = ", ".join(self._name(path) for path in fitting[:4])
                raise BadInput(f"{len(fitting)} files below {self.root} match: {known}", row.place, "file", name)
            if fitting:
                return fitting[0]
        self._is_absent(row, recording)
        return None

    def _is_absent(self, row: TableRow, recording: Recording) -> None:
        if recording.absent_files == "refuse":
            there = any((self.root / name).is_dir() for name in row.files)
            told = f"this is a folder below {self.root}" if there else f"no such file below {self.root}"
            raise BadInput(told, row.place, "file", "|".join(row.files))
        self.absent.append(row.files[0])

    def _refuse_idle_overrides(self, recording: Recording, place: str, paths: list[Path]) -> None:
        for number, override in enumerate(recording.override, start=1):
            for pattern in override.patterns:
                if not any(self._fits(path, pattern) for path in paths):
                    raise BadInput(
                        "matches none of these recordings", f"{place}, override[{number}]", "files", pattern,
                        f'{self._some(paths)}; with absent_files = "skip" there may be none',
                    )  # fmt: skip

    def _requests(self, recording: Recording, place: str, path: Path, row: TableRow | None) -> Iterator[Request]:
        of_recording = {name: value for name, value in recording.given().items() if name not in NOT_SETTINGS}
        settings = merged(self.spec.defaults.given(), of_recording)
        where = row.place if row else place
        if row:
            _refuse_two_speeds(settings, row)
            settings = merged(settings, row.settings)
        for override in recording.override:
            if any(self._fits(path, pattern) for pattern in override.patterns):
                settings = merged(settings, {k: v for k, v in override.given().items() if k != "files"})
        for channel in _channels(settings, where):
            yield Request(recording.name, path, self._name(path), channel, settings, where)


def _leads_nowhere(path: Path) -> bool:
    return path.is_symlink() and not path.exists()


def _refuse_two_speeds(settings: dict[str, Any], row: TableRow) -> None:
    before = [name for name in SPEED_SETTINGS if name in settings]
    now = [name for name in SPEED_SETTINGS if name in row.settings]
    if before and now:
        raise BadInput(
            f"two sources for the speed: the SPEC also states {before[0]}",
            row.place,
            now[0],
            allowed="only one of them",
        )


def _channels(settings: dict[str, Any], place: str) -> tuple[Channel, ...]:
    if "channel" in settings:
        return tuple(settings["channel"])
    if "x" not in settings and "y" not in settings:
        raise BadInput("this setting is missing", place, "y", allowed="the name of the variable that holds the samples")
    return (Channel(name=settings.get("channel_name", ""), x=settings.get("x"), y=settings.get("y")),)
