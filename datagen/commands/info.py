"""`spallgen info`: what a corpus holds."""

from __future__ import annotations

from datagen.commands.program import CorpusFolder, JsonFile, command, show_tables, write_json


@command("spallgen info out/quickstart")
def info(folder: CorpusFolder, json_file: JsonFile = None) -> None:
    """Show what a corpus holds: counts, balance, ranges, size, cost."""
    from datagen.commands.tables import info_tables
    from datagen.inspection.info import corpus_info

    found = corpus_info(folder)
    write_json(json_file, found)
    show_tables(info_tables(found))
