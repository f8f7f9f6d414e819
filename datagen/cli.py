"""The command `spallgen`. Heavy packages are imported inside the commands, so that help comes at once."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from datagen.errors import BadInput

if TYPE_CHECKING:
    from rich.table import Table

    from datagen.corpora.check import Verdict
    from datagen.runs.run import Summary

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130

app = typer.Typer(
    name="spallgen",
    help="Simulated vibration of rolling bearings with raceway spalls, as labelled corpora.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)

JsonFile = Annotated[Path | None, typer.Option("--json", metavar="FILE", help="Write the results to this file too.")]
CorpusFolder = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a corpus.")]
Command = Callable[..., None]


def command(example: str) -> Callable[[Command], Command]:
    """Add a command to the program: bad input and Ctrl-C end it with a sentence and their exit code."""

    def register(function: Command) -> Command:
        @functools.wraps(function)
        def guarded(*args: Any, **options: Any) -> None:
            try:
                _check_json(options["json_file"])
                function(*args, **options)
            except BadInput as problem:
                _complain(f"error: {problem}")
                raise typer.Exit(BAD_INPUT) from None
            except KeyboardInterrupt:
                _complain("interrupted; nothing that was finished is lost")
                raise typer.Exit(INTERRUPTED) from None

        return app.command(epilog=f"Example: {example}")(guarded)

    return register


@command("spallgen generate datasets/quickstart --out out/quickstart")
def generate(
    recipe: Annotated[Path, typer.Argument(metavar="RECIPE", help="Recipe file, its folder, or name of a dataset.")],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the corpus.")],
    limit: Annotated[int | None, typer.Option(metavar="N", help="Make the first N records only.")] = None,
    records: Annotated[str | None, typer.Option(metavar="17,40", help="Make these records only.")] = None,
    workers: Annotated[int | None, typer.Option(metavar="N", help="Processes; all processors if not given.")] = None,
    backend: Annotated[str | None, typer.Option(metavar="loky|dask", help="Who runs the processes.")] = None,
    scheduler: Annotated[str | None, typer.Option(metavar="ADDR", help="Address of a Dask scheduler.")] = None,
    json_file: JsonFile = None,
) -> None:
    """Make the records of a recipe, or go on where an earlier run stopped."""
    from datagen.recipes.recipe import load_recipe
    from datagen.runs.generate import generate as make
    from datagen.runs.progress import reporter
    from datagen.runs.workers import Engine

    chosen = None if records is None else _numbers("--records", records)
    engine = Engine(workers=workers, backend=backend, scheduler=scheduler)
    with reporter() as told:
        run = make(load_recipe(recipe), out, limit=limit, records=chosen, engine=engine, reporter=told)
    _write_json(json_file, run)
    _tell_run(run)
    if not run.complete:
        raise typer.Exit(FAILED)


def _numbers(option: str, text: str) -> list[int]:
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise BadInput(field=option, value=text, allowed="whole numbers with commas between, such as 17,40") from None


def _tell_run(run: Summary) -> None:
    from datagen.runs.progress import for_people

    for failure in run.failed[:3]:
        _complain(f"record {failure.record} could not be made: {failure.reason.strip().splitlines()[-1]}")
    if len(run.failed) > 3:
        _complain(f"and {len(run.failed) - 3} more; failed.jsonl in {run.folder} lists all")
    if run.problem:
        _complain(run.problem)
    print(
        f"{run.made} of {run.asked} records are in {run.folder} ({run.new} new, {for_people(run.bytes)}, "
        f"{run.seconds:.1f} s)"
    )


@command("spallgen check out/quickstart")
def check(
    folder: CorpusFolder,
    remake: Annotated[int, typer.Option(metavar="N", min=0, help="Simulate N records again and compare.")] = 1,
    json_file: JsonFile = None,
) -> None:
    """Read a whole corpus and say everything that is wrong with it."""
    from datagen.corpora.check import check_corpus

    verdict = check_corpus(folder, remake)
    _write_json(json_file, verdict)
    for sentence in verdict.problems:
        _complain(sentence)
    _tell_verdict(verdict, remake)
    if not verdict.sound:
        raise typer.Exit(FAILED)


def _tell_verdict(verdict: Verdict, remake: int) -> None:
    state = "sound" if verdict.sound else f"NOT sound: {len(verdict.problems)} problems"
    print(f"{verdict.folder}: {verdict.records} records in {verdict.shards} shards, {state}")
    if not verdict.remade and verdict.sound and remake:
        print("not simulated again: this program's physics are another version than the corpus's")
    if verdict.remade:
        names = ", ".join(map(str, verdict.remade))
        print(
            f"simulated again from its scenario: record {names}; differs by {verdict.largest_difference:.2g} of its RMS"
        )


@command("spallgen info out/quickstart")
def info(folder: CorpusFolder, json_file: JsonFile = None) -> None:
    """Show what a corpus holds: counts, balance, ranges, size, cost."""
    from datagen.corpora.info import corpus_info
    from datagen.tables import info_tables

    found = corpus_info(folder)
    _write_json(json_file, found)
    _show(info_tables(found))


@command("spallgen preview datasets/quickstart --record 3 --out record3.png")
def preview(
    source: Annotated[Path, typer.Argument(metavar="RECIPE|DIR", help="Recipe, or folder of a corpus.")],
    out: Annotated[Path, typer.Option("--out", metavar="FILE.png", help="Picture to write.")],
    record: Annotated[int, typer.Option(metavar="N", help="Which record.")] = 0,
    json_file: JsonFile = None,
) -> None:
    """Draw one record: trace, spectrogram, envelope spectrum, stiffness and profile."""
    from datagen.drawing.preview import draw_preview
    from physics.outcome import SimulationFailed

    try:
        drawn = draw_preview(source, record, out)
    except SimulationFailed as failure:
        _complain(f"record {record} could not be made: {failure}")
        raise typer.Exit(FAILED) from None
    _write_json(json_file, {"record": record, "picture": str(out), "facts": drawn})
    print(f"record {record} of {source} is drawn in {out}")


@command("spallgen catalog")
def catalog(json_file: JsonFile = None) -> None:
    """List the bearings and rigs that recipes can name, with the source of their numbers."""
    from datagen.tables import catalog_data, catalog_tables

    _write_json(json_file, catalog_data())
    _show(catalog_tables())


def _show(tables: list[Table]) -> None:
    from rich.console import Console

    console = Console(width=None if sys.stdout.isatty() else 140)
    for table in tables:
        console.print(table)


def _check_json(path: Path | None) -> None:
    """Refuse a file of results that cannot be written, before any work is done."""
    if path is not None and not path.absolute().parent.is_dir():
        raise BadInput("no such folder", field="--json", value=str(path), allowed="a file in an existing folder")


def _write_json(path: Path | None, result: Any) -> None:
    """Write a dataclass or a mapping as JSON; NaN becomes null."""
    if path is None:
        return
    from datagen.plain import plain_json

    try:
        path.write_text(plain_json(result))
    except OSError as problem:
        raise BadInput(f"cannot write this file: {problem.strerror}", str(path), "--json") from None


def _complain(sentence: str) -> None:
    print(sentence, file=sys.stderr)


def main() -> None:
    """Run the command line; ends the process with 0, 1 (a check failed), 2 (bad input) or 130 (Ctrl-C)."""
    app()
