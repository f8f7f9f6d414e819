"""`spallgen size`: how long the spalls of a corpus are, from vibration alone, scored where the truth is known."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from datagen.commands.program import CorpusFolder, JsonFile, command, show_tables, write_json
from datagen.commands.progress_display import show_steps
from datagen.counts import counted
from datagen.files.places import require_results_folder
from datagen.processes import MOST_WORKERS

if TYPE_CHECKING:
    from datagen.sizing.size_scores import SizeScores

Estimator = Annotated[
    str | None, typer.Option("--estimator", metavar="MODULE:NAME", help="Another estimator: a class or a function.")
]
LoadKnown = Annotated[
    bool, typer.Option("--load-known/--blind", help="Whether the estimator is given the load and the Hertz factor.")
]
Split = Annotated[
    str | None,
    typer.Option(metavar="SPLIT", help="train, validation, test or all; if not given, test if the corpus has one."),
]
KnownSizes = Annotated[
    list[str] | None,
    typer.Option("--known-size", metavar="RECORD=MM", help="Measured spall length of a record; may be given again."),
]
Workers = Annotated[
    int,
    typer.Option(
        metavar="N",
        min=1,
        max=MOST_WORKERS,
        help="Processes; one by default, as each further one loads the estimator again.",
    ),
]
OutFolder = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Folder for report, table and, with truth, picture.")
]


@command("spallgen size out/size_ladder --out out/size_report")
def size(
    folder: CorpusFolder,
    estimator: Estimator = None,
    load_known: LoadKnown = True,
    split: Split = None,
    known_size: KnownSizes = None,
    workers: Workers = 1,
    out: OutFolder = None,
    json_file: JsonFile = None,
) -> None:
    """Estimate the size of the spall in every record; score lag, arc, abstention and intervals.

    Recordings are scored against the extents stated for them, and such a run is logged in their folder, in
    scored_runs.jsonl.
    """
    from datagen.sizing.corpus_run import score_sizes
    from datagen.sizing.flat_rows import flat_scores
    from datagen.sizing.known_sizes import parse_known_sizes
    from datagen.sizing.report_files import write_report
    from datagen.sizing.size_request import SizeRequest

    if out is not None:
        require_results_folder(out)
    asked = SizeRequest(folder, estimator, load_known, split, parse_known_sizes(known_size or ()))
    with show_steps() as listener:
        scores = score_sizes(asked, workers, listener.counting("sizes"))
    write_json(json_file, flat_scores(scores))
    if out is None:
        _print_result(scores)
        return
    from datagen.drawing.size_report import size_report_png

    written = write_report(scores, out, size_report_png(scores) if scores.summary is not None else None)
    _print_result(scores)
    print(f"{', '.join(written[:-1])} and {written[-1]} are in {out}")


def _print_result(scores: SizeScores) -> None:
    from datagen.commands.size_tables import estimates_table, known_size_sentence, stated_sentence, summary_table

    answered, asked = sum(record.found for record in scores.records), sum(record.asked for record in scores.records)
    silent = (
        "" if asked == len(scores.records) else f", {len(scores.records) - asked} could not be given to the estimator"
    )
    records = counted(len(scores.records), "record")
    print(f"{scores.folder}, split {scores.split}: {records}, {answered} with an estimate{silent}")
    if scores.load_known and not scores.load_given:
        print("blind: the load or the Hertz factor of these records is unknown")
    if scores.fitted_to:
        print(f"no fair score: {counted(scores.fitted_to, 'record')} of machines that the estimator was fitted to")
    if scores.stated is not None:
        print(stated_sentence(scores.stated))
    for known in scores.known_sizes:
        print(known_size_sentence(known))
    if scores.summary is None:
        show_tables([estimates_table(scores.records)])
        return
    for record in scores.records:
        if not record.asked:
            print(f"record {record.truth.record}: no estimate, {record.answer.reason}")
    show_tables([summary_table(scores.summary)])
