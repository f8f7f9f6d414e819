"""Writing the report of a corpus: its card, pictures, Croissant metadata and label table."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from datagen.cards.card import OVERVIEW, card_text
from datagen.cards.croissant import croissant_text, unstated
from datagen.cards.facts import Facts, Kind, corpus_facts
from datagen.cards.origin_text import origin_text
from datagen.cards.vocabulary_table import vocabulary_table
from datagen.corpus import Corpus
from datagen.corpus_files.index import no_records
from datagen.corpus_files.manifest import read_manifest
from datagen.errors import BadInput
from datagen.files.atomic import is_temporary, write_results
from datagen.files.places import OUT, from_home, require_folder

CARD, METADATA, VOCABULARY = "card.md", "croissant.json", "labels_bearing_datasets.csv"
TEXTS = {CARD, METADATA, VOCABULARY}
OF_A_RECORD = re.compile(r"record_\d{6,}\.png")
MOST_EXAMPLES = 6


@dataclass(frozen=True)
class Report:
    """What was written where, the facts that the card states, and what `unstated` terms the metadata lack."""

    folder: str
    files: tuple[str, ...]
    facts: Facts
    unstated: tuple[str, ...]


def write_report(folder: str | Path, out: str | Path | None = None) -> Report:
    """Write the report of the corpus in `folder` into `out` (by default its folder `report`); raises BadInput.

    An earlier report there is written over; any other folder that is not empty is refused. Nothing is written before
    everything is drawn.
    """
    folder = from_home(folder)
    read_manifest(folder)  # what is no corpus is told as that, and not as a place where no report can be put
    out = folder / "report" if out is None else from_home(out)
    _check_folder(out)
    # Listed before anything is drawn: what another report is just writing is no leftover.
    earlier = [path.name for path in _held(out) if _is_of_a_report(path)]
    facts = corpus_facts(folder)
    if not facts.info.records:
        raise no_records(folder)
    contents = _contents(folder, facts, out)
    write_results(out, contents, gone=[name for name in earlier if name not in contents])
    return Report(str(out), tuple(contents), facts, unstated(facts))


def _contents(folder: Path, facts: Facts, out: Path) -> dict[str, bytes]:
    """Every file of the report by name, the card first."""
    from datagen.drawing.overview import overview_png
    from datagen.drawing.preview import preview_png

    pictures = {kind.first: f"record_{kind.first:06d}.png" for kind in _shown(facts.kinds)}
    with Corpus(folder) as corpus:
        texts = {
            CARD: card_text(facts, origin_text(corpus.manifest), pictures),
            METADATA: croissant_text(folder, facts, out),
            VOCABULARY: vocabulary_table(corpus),
        }
        return (
            {name: text.encode() for name, text in texts.items()}
            | {OVERVIEW: overview_png(corpus.labels, facts.info.name)}
            | {name: preview_png(folder, record)[0] for record, name in pictures.items()}
        )


def _shown(kinds: tuple[Kind, ...]) -> tuple[Kind, ...]:
    return tuple(sorted(kinds, key=lambda kind: -kind.records)[:MOST_EXAMPLES])


def _check_folder(out: Path) -> None:
    """Raise BadInput unless `out` is new, empty, or the folder of a report, be it an unfinished one."""
    require_folder(out)
    held = _held(out)
    names = {path.name for path in held}
    # A report's card is written first, so pictures without one are somebody's own.
    foreign = [path.name for path in held if not (is_temporary(path) or (CARD in names and _is_of_a_report(path)))]
    if foreign and not names >= TEXTS:
        problem = f"this folder holds things other than a report, such as {foreign[0]}"
        raise BadInput(problem, file=str(out), field=OUT)


def _held(out: Path) -> list[Path]:
    """What is in the folder `out`, by name; nothing where there is none."""
    return sorted(out.iterdir()) if out.is_dir() else []


def _is_of_a_report(path: Path) -> bool:
    """True for a file that this module may have written, whole or not."""
    return path.name in {*TEXTS, OVERVIEW} or bool(OF_A_RECORD.fullmatch(path.name)) or is_temporary(path)
