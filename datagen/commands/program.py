"""The program `spallgen`: how a command is added, ends, complains and writes its results."""

from __future__ import annotations

import functools
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from datagen.commands.termination import Terminated, terminable
from datagen.commands.usage import Program
from datagen.errors import BadInput
from datagen.exits import BAD_INPUT, FAILED, INTERRUPTED, TERMINATED, print_error
from datagen.files.places import from_home, refuse_file_of_corpus, require_file
from physics.outcome import SimulationFailed

if TYPE_CHECKING:
    from rich.table import Table

app = typer.Typer(
    name="spallgen",
    cls=Program,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)

# Characters a table is wide without a terminal, and how many of these a usual name of a recording takes.
WIDTH, USUAL_NAME = 140, 40
# Heading of the column that holds such names.
NAMES = "recording"

JsonFile = Annotated[Path | None, typer.Option("--json", metavar="FILE", help="Write the results to this file too.")]
CorpusFolder = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a corpus.")]
Command = Callable[..., None]


def _show_version(asked: bool) -> None:
    if asked:
        from datagen.versions import program_versions

        print(f"spallgen {program_versions()['spallgen']}")
        raise typer.Exit


@app.callback()
def spallgen(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Simulated vibration of rolling bearings with raceway spalls, as labelled corpora."""


def command(
    example: str, name: str | None = None, *, kept: str = "what had not been written is lost"
) -> Callable[[Command], Command]:
    """Decorator that adds a command to the program, under `name` or the name of its function.

    Bad input, a scene that cannot be simulated, Ctrl-C and SIGTERM end the command with one sentence and the exit code
    of each. `kept` says what an interruption leaves behind; `example` is shown by `--help`.
    """

    def register(function: Command) -> Command:
        @functools.wraps(function)
        def guarded(*args: Any, **options: Any) -> None:
            try:
                options = {name: _from_home(value) for name, value in options.items()}
                _check_json(**options)
                with terminable():
                    function(*args, **options)
                sys.stdout.flush()
            except BadInput as problem:
                print_error(problem)
                raise typer.Exit(BAD_INPUT) from None
            except SimulationFailed as problem:
                print_error(f"this cannot be simulated: {problem}")
                raise typer.Exit(FAILED) from None
            except PermissionError as problem:
                print_error(f"{problem.filename}: {problem.strerror}; allowed: a path that you may read and write")
                raise typer.Exit(BAD_INPUT) from None
            except BrokenPipeError:  # the program's to handle
                raise
            except OSError as problem:
                # When one file replaces another, `filename` is the temporary one and `filename2` the user's.
                print_error(f"{problem.filename2 or problem.filename or 'the output'}: {problem.strerror}")
                raise typer.Exit(BAD_INPUT) from None
            except KeyboardInterrupt as stop:
                complain(f"interrupted; {kept}")
                raise typer.Exit(TERMINATED if isinstance(stop, Terminated) else INTERRUPTED) from None

        return app.command(name, epilog=f"Example: {example}")(guarded)

    return register


def show_tables(tables: list[Table]) -> None:
    """Print tables as wide as the terminal; texts are printed as they are, even if they look like rich's markup.

    Without a terminal the tables are wide enough to keep each name on one line.
    """
    from rich.console import Console

    console = Console(width=None if sys.stdout.isatty() else _width(tables), markup=False, emoji=False)
    with console.capture() as shown:  # if nobody reads the output, rich would end the process with its own exit code
        for table in tables:
            console.print(table)
    print(shown.get(), end="")


def _width(tables: list[Table]) -> int:
    """Columns for tables in which names of records are kept on one line."""
    longest = 0
    for column in (column for table in tables for column in table.columns if column.header == NAMES):
        column.no_wrap = True
        longest = max([longest, *(len(str(cell)) for cell in column.cells)])
    return WIDTH + max(longest - USUAL_NAME, 0)


def _from_home(value: Any) -> Any:
    """The value of an option or argument; paths begin at somebody's home if they begin with ~."""
    if isinstance(value, list):
        return [_from_home(part) for part in value]
    return from_home(value) if isinstance(value, Path) else value


def _check_json(json_file: Path | None, **others: Any) -> None:
    """Refuse a file of results that cannot be written, or that would be lost or destroy another: one that the `others`
    name too, one of the corpus in a folder that they name, or one that holds anything but JSON. Before any work is
    done."""
    if json_file is None:
        return
    require_file(json_file, "--json")
    refuse_file_of_corpus(json_file, "--json", (named for named in others.values() if isinstance(named, Path)))
    known = {os.path.realpath(named) for named in others.values() if _is_place(named)}
    if os.path.realpath(json_file) in known and (json_file.is_file() or not json_file.exists()):
        problem = "the results would replace what another option or argument names"
        raise BadInput(problem, field="--json", value=str(json_file), allowed="a file of its own")
    if json_file.is_file() and not _may_be_json(json_file):
        problem = "this file holds something else than JSON, which would be lost"
        raise BadInput(problem, field="--json", value=str(json_file), allowed="a new file, or one of earlier results")


def _may_be_json(path: Path) -> bool:
    """Whether a file is empty or holds JSON; also if it cannot be read, as writing it tells."""
    try:
        content = path.read_bytes()
        return not content.strip() or isinstance(json.loads(content), dict | list)
    except (ValueError, RecursionError):
        return False
    except OSError:
        return True


def _is_place(named: Any) -> bool:
    """Whether the value of an option or argument is a path, as a text may be that can also be the name of a scene."""
    return isinstance(named, Path) or (isinstance(named, str) and os.path.isfile(named))


def write_json(path: Path | None, result: Any) -> None:
    """Write a dataclass or a mapping as JSON; NaN becomes null."""
    if path is None:
        return
    from datagen.files.atomic import write_file
    from datagen.files.plain import plain_json

    write_file(path, plain_json(result).encode(), "--json")


def complain(sentence: str) -> None:
    """Say a sentence on standard error."""
    print(sentence, file=sys.stderr)
