"""Which records a SPEC asks for: the files of its parts times their channels, with what is said of each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from datagen.errors import BadInput
from datagen.recordings.label_table import TableRow
from datagen.recordings.part_files import PartFiles
from datagen.recordings.root import Root
from datagen.recordings.settings import Channel, merged
from datagen.recordings.spec import Spec

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
    """All requests of a SPEC in order, the tables they came from by their names in it, and the listed files that were
    not there."""

    requests: tuple[Request, ...]
    tables: dict[str, Path]
    absent: tuple[str, ...]


def list_requests(spec: Spec, root: Path) -> Listing:
    """Every record that the SPEC asks for below `root`; raises BadInput."""
    if not root.is_dir():
        raise BadInput(
            "no such folder",
            file=str(spec.source),
            field="root",
            value=str(root),
            allowed="the folder of the recordings",
        )
    folder = Root(root)
    requests: list[Request] = []
    tables: dict[str, Path] = {}
    absent: list[str] = []
    for number, recording in enumerate(spec.recording, start=1):
        part = PartFiles(spec.source, recording, folder, f"{spec.source}: recording[{number}] ({recording.name})")
        found = part.find()
        requests += [request for path, row in found.files for request in _requests(spec, part, path, row)]
        tables |= found.tables
        absent += found.absent
    if not requests:
        problem = f"none of its files is below {root}, or all are left out"
        raise BadInput(
            problem, file=str(spec.source), field="recording", allowed="files of which one at least is there"
        )
    return Listing(tuple(requests), tables, tuple(absent))


def _requests(spec: Spec, part: PartFiles, path: Path, row: TableRow | None) -> Iterator[Request]:
    """What is asked of one file of a part, of which a table says the `row`; raises BadInput."""
    recording, where = part.recording, row.place if row else part.place
    _require_text(path, where)
    of_recording = {name: value for name, value in recording.given().items() if name not in NOT_SETTINGS}
    settings = merged(spec.defaults.given(), of_recording)
    if row:
        settings = merged(settings, row.settings)
    for override in recording.override:
        if any(part.root.fits(path, pattern) for pattern in override.patterns):
            settings = merged(settings, {k: v for k, v in override.given().items() if k != "files"})
    for channel in _channels(settings, where):
        yield Request(recording.name, path, part.root.name(path), channel, settings, where)


def _require_text(path: Path, place: str) -> None:
    """Raise BadInput for a file whose name is no text, as in archives unpacked in another encoding than they have: no
    table nor shard can hold it."""
    name = str(path)
    shown = name.encode("utf-8", "backslashreplace").decode()
    if shown != name:
        raise BadInput(
            "the name of this file is not UTF-8", file=place, field="file", value=shown, allowed="the file renamed"
        )


def _channels(settings: dict[str, Any], place: str) -> tuple[Channel, ...]:
    channels = tuple(settings.get("channel", ()))
    if not channels:
        if "x" not in settings and "y" not in settings:
            allowed = "the name of the variable that holds the samples"
            raise BadInput("this setting is missing", file=place, field="y", allowed=allowed)
        channels = (Channel(name=settings.get("channel_name", ""), x=settings.get("x"), y=settings.get("y")),)
    for channel in channels:
        if channel.x == channel.y:
            problem, allowed = "is the variable of the axis x too", "another one; of a sensor with one axis y alone"
            raise BadInput(problem, file=place, field="y", value=channel.y, allowed=allowed)
    return channels
