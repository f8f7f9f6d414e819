"""`spallgen features`: the feature table of corpora, to learn from with other programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from datagen.commands.program import JsonFile, command, write_json
from datagen.commands.progress_display import show_steps
from datagen.counts import counted
from datagen.processes import MOST_WORKERS

if TYPE_CHECKING:
    import pandas

Folders = Annotated[list[Path], typer.Argument(metavar="DIR", help="Folders of corpora, simulated or imported.")]
Out = Annotated[Path, typer.Option("--out", metavar="FILE.csv", help="Table to write.")]
Split = Annotated[str, typer.Option(metavar="SPLIT", help="train, validation, test or all.")]
Bandwidth = Annotated[
    float | None,
    typer.Option(metavar="HZ", help="Limit every record to this; 20000 or 0.95 of half its rate if not given."),
]
AsLearned = Annotated[
    bool,
    typer.Option(
        "--as-learned",
        help="The rows that classify learns from: at speeds and bandwidths that are off, with two noisy copies.",
    ),
]
Workers = Annotated[
    int,
    typer.Option(
        metavar="N",
        min=1,
        max=MOST_WORKERS,
        help="Processes that compute features; few by default, each holds a record.",
    ),
]


@command("spallgen features out/quickstart --out features.csv")
def features(
    folder: Folders,
    out: Out,
    split: Split = "all",
    bandwidth: Bandwidth = None,
    as_learned: AsLearned = False,
    workers: Workers = 2,
    json_file: JsonFile = None,
) -> None:
    """Write the features of every record as a CSV table: the very numbers that classify judges, beside the labels.

    It has a row for each axis of a record, and for each window of one longer than 10.5 s. A record that cannot be
    judged has one row with the reason and no features. The features and columns are explained in docs/features.md.
    """
    from datagen.benchmark.feature_table import feature_table, rejections
    from datagen.files.atomic import write_file
    from datagen.files.places import OUT, require_table

    require_table(out)
    with show_steps() as listener:
        table = feature_table(folder, split, bandwidth, as_learned, workers, listener)
    write_file(out, table.to_csv(index=False, lineterminator="\n").encode(), OUT)
    facts = {**_counts(table), "rejected": rejections(table), "columns": list(table.columns), "table": str(out)}
    write_json(json_file, facts)
    for reason, count in facts["rejected"].items():
        print(f"rejected {count}: {reason}")
    verb = "is" if facts["rows"] == 1 else "are"
    print(f"{counted(facts['rows'], 'row')} of {counted(facts['records'], 'record')} {verb} in {out}")


def _counts(table: pandas.DataFrame) -> dict[str, Any]:
    return {"rows": len(table), "records": len(table.drop_duplicates(["corpus", "record"]))}
