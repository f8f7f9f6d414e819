"""`spallgen info`: what a corpus holds."""

from __future__ import annotations

import typer

from datagen.commands.program import CorpusFolder, JsonFile, command, complain, show_tables, write_json
from datagen.exits import FAILED


@command("spallgen info out/quickstart")
def info(folder: CorpusFolder, json_file: JsonFile = None) -> None:
    """Show what a corpus holds: counts, balance, ranges, size, cost, and any shards that are evidently damaged."""
    from datagen.commands.tables import info_tables
    from datagen.inspection.info import corpus_info

    found = corpus_info(folder)
    write_json(json_file, found)
    show_tables(info_tables(found))
    if found.readable < found.shards:
        lost = found.shards - found.readable
        complain(f"{lost} of {found.shards} shards cannot be read: run `spallgen check {folder}`")
        if not found.readable:
            raise typer.Exit(FAILED)
