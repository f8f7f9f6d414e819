"""`spallgen generate`: a recipe made into a corpus."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from datagen.commands.program import JsonFile, command, complain, write_json
from datagen.commands.progress_display import show_records
from datagen.counts import bytes_text, counted
from datagen.errors import BadInput
from datagen.exits import FAILED
from datagen.files.number_texts import whole_number
from datagen.files.places import FAILURES

if TYPE_CHECKING:
    from datagen.runs.run import Summary


@command(
    "spallgen generate datasets/quickstart --out out/quickstart",
    kept="finished records are kept, and the same command continues from there",
)
def generate(
    recipe: Annotated[Path, typer.Argument(metavar="RECIPE", help="Recipe file, its folder, or name of a dataset.")],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the corpus.")],
    limit: Annotated[int | None, typer.Option(metavar="N", help="Make only the first N records.")] = None,
    records: Annotated[str | None, typer.Option(metavar="17,40", help="Make only these records.")] = None,
    workers: Annotated[
        int | None, typer.Option(metavar="N", help="Processes; one for each processor if not given.")
    ] = None,
    backend: Annotated[
        str | None, typer.Option(metavar="loky|dask", help="What runs the processes; loky if not given.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDR", help="Address of a running Dask scheduler; needs --backend dask.")
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Make the records of a recipe, or continue where an earlier run stopped."""
    from datagen.recipes.recipe import load_recipe
    from datagen.runs.generate import generate as make
    from datagen.runs.workers import Engine

    chosen = None if records is None else _numbers("--records", records)
    engine = Engine(workers=workers, backend=backend, scheduler=scheduler)
    settings = load_recipe(recipe)
    with show_records() as listener:
        run = make(settings, out, limit=limit, records=chosen, engine=engine, listener=listener)
    write_json(json_file, run)
    _print_run(run)
    if limit is not None and limit > settings.count:
        complain(f"--limit {limit}: the recipe has no more than {counted(settings.count, 'record')}")
    if not run.complete:
        raise typer.Exit(FAILED)


def _numbers(option: str, text: str) -> list[int]:
    try:
        numbers = [whole_number(part) for part in text.split(",")]
    except ValueError:
        raise BadInput(field=option, value=text, allowed="whole numbers separated by commas, such as 17,40") from None
    twice = next((number for number, times in Counter(numbers).items() if times > 1), None)
    if twice is not None:
        raise BadInput(f"{twice} is listed more than once", field=option, value=text, allowed="each record once")
    return numbers


def _print_run(run: Summary) -> None:
    for failure in run.failed[:3]:
        complain(f"record {failure.record} could not be made: {failure.reason.strip().splitlines()[-1]}")
    if len(run.failed) > 3:
        complain(f"and {len(run.failed) - 3} more; {FAILURES} in {run.folder} lists all")
    if run.problem:
        complain(run.problem)
    print(
        f"{run.made} of {run.asked} records are in {run.folder} ({run.new} new, {bytes_text(run.bytes)}, "
        f"{run.seconds:.1f} s)"
    )
