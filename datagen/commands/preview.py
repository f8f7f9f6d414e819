"""`spallgen preview`: one record on one sheet."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from datagen.commands.program import JsonFile, command, complain, write_json
from datagen.exits import FAILED


@command("spallgen preview datasets/quickstart --record 3 --out record3.png")
def preview(
    source: Annotated[Path, typer.Argument(metavar="RECIPE|DIR", help="Recipe, or folder of a corpus.")],
    out: Annotated[Path, typer.Option("--out", metavar="FILE.png", help="Picture to write.")],
    record: Annotated[
        int | None, typer.Option(metavar="N", help="Number of the record. [default: the first that there is]")
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Draw one record: trace, spectrogram, envelope spectrum, stiffness and profile."""
    from datagen.drawing.preview import draw_preview, first_record
    from physics.outcome import SimulationFailed

    record = first_record(source) if record is None else record
    try:
        drawn = draw_preview(source, record, out, complain)
    except SimulationFailed as failure:
        complain(f"record {record} could not be made: {failure}")
        raise typer.Exit(FAILED) from None
    write_json(json_file, {"record": record, "picture": str(out), "facts": drawn})
    print(f"record {record} of {source} is drawn in {out}")
