"""`spallgen report`: the card of a corpus."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from datagen.commands.program import CorpusFolder, JsonFile, command, write_json


@command("spallgen report out/quickstart --out out/quickstart-card")
def report(
    folder: CorpusFolder,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder to write into; DIR/report if not given.")
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Write the card of a corpus: what it holds, how it was made, pictures, and its labels in another vocabulary."""
    from datagen.cards.corpus_report import write_report

    written = write_report(folder, out)
    write_json(json_file, written)
    print(f"{len(written.files)} files are in {written.folder}: {', '.join(written.files[:4])} and pictures")
    if written.unstated:
        print(f"croissant.json lacks: {', '.join(written.unstated)}; add them to it before publishing")
