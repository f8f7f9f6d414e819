"""`spallgen check`: whether a corpus is what it says."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from datagen.commands.program import CorpusFolder, JsonFile, command, complain, write_json
from datagen.counts import counted
from datagen.exits import FAILED

if TYPE_CHECKING:
    from datagen.inspection.check import Verdict


@command("spallgen check out/quickstart")
def check(
    folder: CorpusFolder,
    remake: Annotated[
        int, typer.Option(metavar="N", min=0, help="Simulate N records again and compare them with the stored ones.")
    ] = 1,
    json_file: JsonFile = None,
) -> None:
    """Read a whole corpus and report everything that is wrong with it."""
    from datagen.inspection.check import check_corpus

    verdict = check_corpus(folder, remake)
    write_json(json_file, verdict)
    for sentence in verdict.problems:
        complain(sentence)
    if verdict.remedy:
        complain(verdict.remedy)
    _print_verdict(verdict, remake)
    if not verdict.sound:
        raise typer.Exit(FAILED)


def _print_verdict(verdict: Verdict, remake: int) -> None:
    state = "sound" if verdict.sound else f"NOT sound: {counted(len(verdict.problems), 'problem')}"
    print(f"{verdict.folder}: {counted(verdict.records, 'record')} in {counted(verdict.shards, 'shard')}, {state}")
    if not verdict.remade and verdict.sound and remake and not verdict.imported:
        print("not simulated again: this program's version of the physics differs from the corpus's")
    if verdict.remade:
        names = ", ".join(map(str, verdict.remade))
        print(
            f"simulated again from its scenario: record {names}; differs by {verdict.largest_difference:.2g} of its RMS"
        )
