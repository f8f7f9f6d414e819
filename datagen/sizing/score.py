"""A corpus scored: every record estimated, compared with its truth, summed up."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from datagen.corpora.index import read_index
from datagen.errors import BadInput
from datagen.sizing.estimators import find_estimator
from datagen.sizing.scored_record import ScoredRecord, score_record
from datagen.sizing.sized_records import sized_records
from datagen.sizing.summary import summarise
from labels.schema import SPLITS

ALL = "all"


@dataclass(frozen=True)
class SizeScores:
    """`summary` is None where no record's ball passes are known, as in imported recordings."""

    folder: str
    estimator: str
    split: str
    load_known: bool
    records: list[ScoredRecord]
    summary: dict[str, Any] | None


def score_sizes(
    folder: Path, estimator: str | None, load_known: bool, split: str | None, workers: int = 1
) -> SizeScores:
    """Scores of the corpus in `folder`, of one split (its test split if it has one and none is asked for)."""
    from joblib import Parallel, delayed

    find_estimator(estimator)
    chosen = _split(folder, split)
    splits = None if chosen == ALL else (chosen,)
    records = sized_records(folder, load_known=load_known, splits=splits)
    made = Parallel(n_jobs=workers, pre_dispatch=2 * workers)(delayed(_score)(one, estimator) for one in records)
    scored = sorted(made, key=lambda one: one.record)
    known = [one for one in scored if one.known_truth]
    summary = summarise(known, load_known) if known else None
    return SizeScores(str(folder), estimator or "spallgen", chosen, load_known, scored, summary)


def _score(sized: Any, estimator: str | None) -> ScoredRecord:
    return score_record(sized, find_estimator(estimator))


def _split(folder: Path, asked: str | None) -> str:
    present = set(read_index(folder)["split"])
    if asked is None:
        return "test" if "test" in present else ALL
    if asked != ALL and asked not in present:
        allowed = ", ".join([ALL, *(name for name in SPLITS if name in present)])
        raise BadInput("no records of this split", str(folder), "--split", asked, allowed)
    return asked
