"""`spallgen check`: whether a corpus is what it says, or a recipe can be made."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from datagen.commands.program import JsonFile, command, complain, write_json
from datagen.commands.progress_display import show_records
from datagen.counts import bytes_text, counted
from datagen.exits import FAILED

if TYPE_CHECKING:
    from datagen.inspection.check import Verdict
    from datagen.inspection.recipe_check import RecipeFacts


@command("spallgen check out/quickstart")
def check(
    source: Annotated[
        Path,
        typer.Argument(metavar="DIR|RECIPE", help="Folder of a corpus; or a recipe's file or folder, or its name."),
    ],
    remake: Annotated[
        int,
        typer.Option(
            metavar="N", min=0, help="Simulate N records of a corpus again and compare them with the stored ones."
        ),
    ] = 1,
    json_file: JsonFile = None,
) -> None:
    """Read a whole corpus and report everything that is wrong with it; or say what a recipe would make.

    Checking a recipe makes no records and writes nothing; mistakes in it are reported as generate would report them. A
    folder that holds a corpus is checked as a corpus, even if there is a recipe in it too.
    """
    from datagen.inspection.recipe_check import is_recipe

    if is_recipe(source):
        _check_recipe(source, json_file)
    else:
        _check_corpus(source, remake, json_file)


def _check_recipe(source: Path, json_file: Path | None) -> None:
    from datagen.inspection.recipe_check import check_recipe

    with show_records() as listener:
        facts = check_recipe(source, listener.say)
    write_json(json_file, facts)
    _print_recipe(facts)


def _print_recipe(facts: RecipeFacts) -> None:
    parts = f" in {len(facts.parts)} parts" if len(facts.parts) > 1 else ""
    print(f"{facts.recipe}: a sound recipe")
    made = f"{counted(facts.records, 'record')} of {counted(facts.machines, 'virtual machine')}"
    print(f"it makes {made}{parts}, in {counted(facts.shards, 'shard')}")
    print(f"they last {_span(facts.durations_s)} s each, {facts.signal_seconds:.6g} s together")
    print(f"sampled at {_span(facts.rates_hz)} Hz, about {bytes_text(facts.bytes)} on the disk")


def _span(values: Sequence[float]) -> str:
    """The value, or the smallest and the largest of several."""
    return f"{values[0]:.6g}" if len(values) == 1 else f"{values[0]:.6g} to {values[-1]:.6g}"


def _check_corpus(folder: Path, remake: int, json_file: Path | None) -> None:
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
