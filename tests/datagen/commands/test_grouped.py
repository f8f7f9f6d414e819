"""Options in groups: a command takes the fields of a dataclass as options of its own."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from datagen.commands.grouped import grouped


@dataclass(frozen=True)
class Drawing:
    """Two options that belong together."""

    seed: int = 7
    note: str | None = None


OPTIONS = {"seed": typer.Option(metavar="N", min=1, help="Begin here."), "note": typer.Option("--note", help="Words.")}


def run(*arguments: str) -> tuple[int, list[object], str]:
    """Exit code, what the command was called with, and what it printed."""
    app, called = typer.Typer(rich_markup_mode=None), list[object]()

    @app.command()
    @grouped(OPTIONS)
    def draw(folder: Path, drawing: Drawing = Drawing(), quiet: bool = False) -> None:
        """Draw."""
        called.extend((folder, drawing, quiet))

    done = CliRunner().invoke(app, arguments)
    return done.exit_code, called, done.output


def test_the_fields_are_options_with_their_defaults() -> None:
    assert run("here")[1] == [Path("here"), Drawing(7, None), False]
    assert run("here", "--note", "a", "--seed", "3", "--quiet")[1] == [Path("here"), Drawing(3, "a"), True]


def test_they_stand_in_the_help_where_the_group_does() -> None:
    code, _, shown = run("--help")
    assert code == 0
    assert 0 < shown.index("--seed N") < shown.index("--note") < shown.index("--quiet")
    assert "Begin here." in shown


def test_a_value_that_an_option_does_not_take_is_refused() -> None:
    assert run("here", "--seed", "0")[:2] == (2, [])


def test_a_field_that_no_option_tells_of_is_refused_when_the_command_is_made() -> None:
    def draw(drawing: Drawing) -> None:
        """Draw."""

    with pytest.raises(KeyError, match="note"):
        grouped({"seed": OPTIONS["seed"]})(draw)
