"""`spallgen paper`: the counterparts of the founding paper's figures, with tables."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from datagen.commands.program import JsonFile, command, write_json
from datagen.commands.progress_display import show_steps


@command("spallgen paper --out paper-figures --figures 5,6,q2")
def paper(
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Folder for the pictures, the tables and README.md.")
    ],
    figures: Annotated[
        str | None,
        typer.Option(metavar="LIST", help="Which: 5 to 11 and q1 to q3, separated by commas; all if not given."),
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Draw Figures 5 to 11 of Petersen (2014) from simulations, beside its numbers, and answer three questions."""
    from datagen.paper.book import chosen, write_book

    names = chosen(figures)
    with show_steps() as listener:
        results = write_book(out, names, listener.say)
    write_json(json_file, results)
    print(f"pictures, tables and README.md are in {out}")
