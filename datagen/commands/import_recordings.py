"""`spallgen import`: recordings of real machines brought into the schema of simulated ones."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from datagen.commands.program import JsonFile, command, complain, write_json
from datagen.commands.progress_display import show_steps
from datagen.counts import bytes_text, counted

if TYPE_CHECKING:
    from datagen.recordings.importing import Imported


@command("spallgen import cwru --root ~/cwru --out out/cwru", name="import")
def import_recordings(
    spec: Annotated[
        Path, typer.Argument(metavar="SPEC.toml", help="SPEC file, or the name of a shipped one: cwru, mfpt.")
    ],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the corpus; it must be new or empty.")],
    root: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder of the recordings; where the SPEC says if not given.")
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Import recordings (.mat, .npz, .npy, .csv, .wav, .nc, .h5) as a corpus; nothing is written if any file is bad."""
    from datagen.recordings.importing import import_recordings as bring
    from datagen.recordings.spec import load_spec

    with show_steps() as listener:
        done = bring(load_spec(spec), out, root, listener.step)
    write_json(json_file, done)
    _print_result(done)


def _print_result(done: Imported) -> None:
    for problem, names in (
        ("not found", done.absent),
        ("left out as repeats", done.skipped),
        ("without a signal, as if the sensor were not connected", done.dead),
        *done.doubts.items(),
    ):
        if names:
            shown = ", ".join(names[:6]) + (" …" if len(names) > 6 else "")
            complain(f"{len(names)} {problem}: {shown}")
    if done.few_turns:
        complain(done.few_turns)
    print(
        f"{done.folder}: {counted(done.records, 'record')} of {counted(done.files, 'file')} "
        f"({counted(done.shards, 'shard')}, {bytes_text(done.bytes)}, {done.seconds:.1f} s)"
    )
    for reason, count in _unjudged(Path(done.folder)).items():
        print(f"`classify` will reject {count} of them: {reason}")


def _unjudged(folder: Path) -> Counter[str]:
    """How many records of a corpus say too little of their bearing or speed to be judged, by what is missing."""
    from datagen.corpus import Corpus
    from datagen.judging.known import known_kinematics, what_is_missing

    with Corpus(folder) as corpus:
        rows = corpus.labels.to_dict("records")
    return Counter(what_is_missing(row) for row in rows if known_kinematics(row) is None)
