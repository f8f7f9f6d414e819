"""The SPEC of an import: which files hold which recordings, and what is known of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from datagen.errors import BadInput
from datagen.recordings.label_table import FILE_COLUMN
from datagen.recordings.settings import RecordingSettings
from datagen.recordings.spec_files import find_spec
from datagen.recordings.values import word
from datagen.settings.problems import bad_settings
from datagen.settings.table import CorpusName, PartName, Prose, Table, named_differently, refuse
from datagen.settings.toml_file import read_toml

Patterns = Annotated[tuple[str, ...], Field(min_length=1, strict=False)]


def _each(patterns: str | tuple[str, ...] | None) -> tuple[str, ...]:
    return () if patterns is None else (patterns,) if isinstance(patterns, str) else patterns


class Override(RecordingSettings):
    """Settings of some of the files, which go before everything else said of them."""

    files: str | Patterns
    """Names or patterns, such as "30*.mat"."""

    @property
    def patterns(self) -> tuple[str, ...]:
        """The names or patterns."""
        return _each(self.files)


class Recording(RecordingSettings):
    """Files laid out alike. They are found by pattern, or listed in a table, or both."""

    name: PartName
    """Name of this part of the corpus, stored with each of its records."""
    files: str | Patterns | None = None
    """Patterns of files below the root; ** is any number of folders."""
    leave_out: str | Patterns | None = None
    """Patterns of files that `files` would find and that are not wanted."""
    table: str | None = None
    """CSV table beside the SPEC or below the root: a column `file`, other columns named like settings."""
    note_columns: tuple[str, ...] = Field(default=(), strict=False)
    """Columns of the table that are kept as notes."""
    absent_files: Annotated[str, word("refuse", "skip")] = "refuse"
    """What to do where a file of the table is not there, and where a pattern of `files`, `leave_out` or an override
    fits none."""
    override: tuple[Override, ...] = Field(default=(), strict=False)
    """Exceptions for some of the files, in order; later ones go before earlier ones."""

    @model_validator(mode="after")
    def _names_files(self) -> Recording:
        if self.files is None and self.table is None:
            raise refuse("no files are named", "files", 'a pattern such as "*.mat", or a table of files')
        if self.leave_out is not None and self.files is None:
            raise refuse("the table alone says which files are meant", "leave_out", "with files only")
        return self

    @model_validator(mode="after")
    def _notes_are_no_settings(self) -> Recording:
        for column in self.note_columns:
            if column == FILE_COLUMN or column in RecordingSettings.model_fields:
                problem = f'"{column}" is a column that says something else, and is never a note'
                raise refuse(problem, "note_columns", "columns that are not called like a setting")
        return self

    @property
    def patterns(self) -> tuple[str, ...]:
        """The patterns of files, none if a table lists them."""
        return _each(self.files)

    @property
    def unwanted(self) -> tuple[str, ...]:
        """The patterns of files that are left out."""
        return _each(self.leave_out)


class Spec(Table):
    """An import before any file is opened: `load_spec` reads one from a TOML file."""

    name: CorpusName
    """Name of the corpus: letters, digits, - and _."""
    title: Prose = ""
    """One line for people."""
    summary: Prose = ""
    """A few sentences for people."""
    licence: Prose = ""
    """Terms of use of the recordings."""
    citation: Prose = ""
    """How their makers want to be cited."""
    url: Prose = ""
    """Where they come from."""
    root: str = "."
    """Folder of the files, from the folder of the SPEC."""
    same_samples: Annotated[str, word("refuse", "skip", "keep")] = "refuse"
    """What to do with a recording whose samples are exactly those of an earlier one."""
    defaults: RecordingSettings = RecordingSettings()
    """Settings of all recordings that do not say otherwise."""
    recording: tuple[Recording, ...] = Field(min_length=1, strict=False)
    """The parts of the corpus, in order."""

    _source: Path = PrivateAttr(default=Path())

    @model_validator(mode="after")
    def _distinct_names(self) -> Spec:
        named_differently(self.recording, "recording")
        return self

    @property
    def source(self) -> Path:
        """The file it was read from."""
        return self._source


def load_spec(path_or_name: str | Path) -> Spec:
    """The SPEC in a file, or the one that comes with spallgen under that name; raises BadInput."""
    path = find_spec(path_or_name)
    content, text = read_toml(path)
    if "part" in content and "recording" not in content:
        problem = "this is a recipe, for `spallgen generate`, not a SPEC of recordings"
        raise BadInput(problem, file=str(path), field="part", allowed="[[recording]]")
    return parse_spec(content, path, text)


def parse_spec(content: dict[str, Any], path: Path, text: str = "") -> Spec:
    """The SPEC of parsed TOML read from `path`; raises BadInput, with line numbers where `text` is given."""
    try:
        spec = Spec.model_validate(content)
    except ValidationError as error:
        raise bad_settings(error, Spec, path, text) from None
    spec._source = path
    return spec
