"""Writing the report of a corpus: its card, pictures, Croissant metadata and label table."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from datagen.cards.card import OVERVIEW, card_text
from datagen.cards.croissant import croissant_text
from datagen.cards.facts import Facts, Kind, corpus_facts
from datagen.cards.origin_text import origin_text
from datagen.cards.vocabulary_table import vocabulary_table
from datagen.corpora.atomic import write_atomically
from datagen.corpus import Corpus
from datagen.errors import BadInput

CARD, METADATA, VOCABULARY = "card.md", "croissant.json", "labels_bearing_datasets.csv"
MOST_EXAMPLES = 6


@dataclass(frozen=True)
class Report:
    """What was written where, and the facts that the card tells."""

    folder: str
    files: tuple[str, ...]
    facts: Facts


def write_report(folder: Path, out: Path | None = None) -> Report:
    """Write the report of the corpus in `folder` into `out` (by default its folder `report`); raises BadInput.

    An earlier report there is written over; any other folder that is not empty is refused.
    """
    from datagen.drawing.overview import overview_png
    from datagen.drawing.preview import draw_preview

    out = folder / "report" if out is None else out
    facts = corpus_facts(folder)
    if not facts.info.records:
        raise BadInput("this corpus holds no record yet", str(folder))
    _make_folder(out)
    corpus = Corpus(folder)
    pictures = {kind.first: f"record_{kind.first:06d}.png" for kind in _shown(facts.kinds)}
    try:
        for record, name in pictures.items():
            draw_preview(folder, record, out / name)
        write_atomically(out / OVERVIEW, overview_png(corpus.labels, facts.info.name))
        texts = {
            METADATA: croissant_text(folder, facts),
            VOCABULARY: vocabulary_table(corpus),
            CARD: card_text(facts, origin_text(corpus.manifest), pictures),
        }
        for name, text in texts.items():
            write_atomically(out / name, text.encode())
    except OSError as problem:
        raise BadInput(f"cannot write here: {problem.strerror}", str(out), "--out") from None
    finally:
        corpus.close()
    return Report(str(out), (CARD, METADATA, VOCABULARY, OVERVIEW, *pictures.values()), facts)


def _shown(kinds: tuple[Kind, ...]) -> tuple[Kind, ...]:
    return tuple(sorted(kinds, key=lambda kind: -kind.records)[:MOST_EXAMPLES])


def _make_folder(out: Path) -> None:
    if out.is_dir() and any(out.iterdir()) and not (out / CARD).is_file():
        raise BadInput("this folder holds other things than a report", str(out), "--out")
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise BadInput(f"cannot make this folder: {problem.strerror}", str(out), "--out") from None
