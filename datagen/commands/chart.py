"""`spallgen chart`: speed against accuracy, measured and drawn."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from datagen.commands.program import JsonFile, command, write_json
from datagen.commands.progress_display import show_steps
from datagen.errors import BadInput

SOURCE_HELP = (
    "Recipe file, its folder or name of a dataset; or reference scene G0 to F2r, gearbox or fan "
    "(G1@3: three times faster; G1~1: 1 % random slip; G1@3~1: both)."
)


@command("spallgen chart G1 --out out/charts")
def chart(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of picture, CSV and JSON.")],
    source: Annotated[str, typer.Argument(metavar="RECIPE|SCENE", help=SOURCE_HELP)] = "",
    record: Annotated[
        int | None, typer.Option(metavar="N", help="Number of the record, if a recipe is given. [default: 0]")
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Few settings, 0.2 s of signal, no slow reference: one or two minutes.")
    ] = False,
    rounds: Annotated[
        int,
        typer.Option(
            metavar="N", min=1, help="How often runs below half a second are repeated, at least; the median counts."
        ),
    ] = 5,
    stability: Annotated[
        bool, typer.Option("--stability", help="Map where the methods fail, instead of a scene.")
    ] = False,
    json_file: JsonFile = None,
) -> None:
    """Measure methods, models and general-purpose solvers on one scene and draw error against speed."""
    if bool(source) == stability:
        raise BadInput("give either a scene or recipe, or --stability", field="RECIPE|SCENE", value=source)
    if stability and record is not None:
        raise BadInput("the maps are of no record", field="--record", value=record, allowed="with a recipe only")
    written, result = _stability(out) if stability else _work_precision(source, record, quick, rounds, out)
    write_json(json_file, result)
    print("written: " + ", ".join(str(path) for path in written))


def _work_precision(source: str, record: int | None, quick: bool, rounds: int, out: Path) -> tuple[list[Path], object]:
    from datagen.charts.measure import measure
    from datagen.charts.scenes import find_subject
    from datagen.charts.table import chart_table
    from datagen.files.results import results_folder, write_files

    subject = find_subject(source, record)
    folder = results_folder(out)
    with show_steps() as listener:
        measured = measure(subject, quick, rounds, listener.step)
    from datagen.drawing.work_precision import work_precision_png

    return write_files(folder, subject.name, work_precision_png(measured), measured, chart_table(measured)), measured


def _stability(out: Path) -> tuple[list[Path], object]:
    from datagen.charts.stability import facts, stability_maps
    from datagen.drawing.stability_map import stability_sheets
    from datagen.files.results import results_folder, write_files

    folder = results_folder(out)
    with show_steps() as listener:
        maps = stability_maps(listener.step)
    found = facts(maps)
    return write_files(folder, "stability_maps", stability_sheets(maps), found), found
