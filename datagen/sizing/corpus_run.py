"""A corpus scored: every record estimated, compared with its truth, summed up."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

from datagen.corpus_files.index import read_index
from datagen.judging.scored_runs import write_line
from datagen.judging.splits import ALL, TEST, require_split
from datagen.progress import Count, ignore
from datagen.sizing.aggregation import summarise
from datagen.sizing.comparison import score_record, unsized_row
from datagen.sizing.estimators import find_estimator
from datagen.sizing.flat_rows import flat_summary
from datagen.sizing.in_blocks import in_blocks
from datagen.sizing.known_sizes import KnownSize, factor_for, known_sizes, machine_of, with_effect
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_scores import SizeScores
from datagen.sizing.size_summary import StatedSizes
from datagen.sizing.sized_records import SizedRecord, count_records, sized_records, unsized_records, without_load
from datagen.sizing.stated_sizes import states_sizes, summarise_stated

NONE_KNOWN: Mapping[int, float] = MappingProxyType({})


def score_sizes(
    folder: Path,
    estimator: str | None,
    load_known: bool,
    split: str | None,
    workers: int = 1,
    sizes: Mapping[int, float] = NONE_KNOWN,
    count: Count = ignore,
) -> SizeScores:
    """Scores of the corpus in `folder`, of one split (if None is asked for: its test split, or all if it has none).

    `estimator` is that of the user, None for ours; `load_known` if it is given the load and the Hertz factor. A record
    that cannot be sized has a row that says why; raises BadInput if none can. Known `sizes` (mm by record) correct the
    other records of their machines. `count` is called with how many records are done. A run on recordings with a stated
    extent or state of health is logged beside them, before and after.
    """
    sizer = find_estimator(estimator)
    chosen = _split(folder, split)
    splits = None if chosen == ALL else (chosen,)
    unsized = [unsized_row(record) for record in unsized_records(folder, splits)]
    name, logged = estimator or "spallgen", states_sizes(folder)
    if logged:
        options = {"split": chosen, "load_known": load_known, "known_sizes": dict(sizes)}
        write_line(folder, {"began": options, "sizes_by": name})

    def told(records: Iterator[SizedRecord]) -> Iterator[SizedRecord]:
        return records if load_known else without_load(records)

    known = known_sizes(folder, sizes, told(sized_records(folder, only=sizes)), sizer)
    records = told(sized_records(folder, splits))
    total = count_records(folder, splits) - len(unsized)
    made = _counted(_scored(records, estimator, known, workers), total, count)
    scored = sorted([*made, *unsized], key=lambda record: record.truth.record)
    true = [record for record in scored if record.truth.known]
    stated = summarise_stated(scored)
    if logged:
        _log_scores(folder, name, stated)
    return SizeScores(
        folder=str(folder),
        estimator=name,
        split=chosen,
        load_known=load_known,
        records=scored,
        summary=summarise(true, load_known) if true else None,
        known_sizes=with_effect(known, scored),
        stated=stated,
        load_given=sum(record.answer.load_known for record in scored),
    )


def _counted(scored: Iterator[ScoredRecord], total: int, count: Count) -> list[ScoredRecord]:
    """All of the `total` rows, counting each as it comes."""
    rows = []
    for row in scored:
        rows.append(row)
        count(len(rows), total)
    return rows


def _log_scores(folder: Path, name: str, stated: StatedSizes | None) -> None:
    """Append the scores of the estimator of that `name` to the log beside the recordings."""
    scores = None if stated is None else flat_summary(stated)
    write_line(folder, {"sizes_by": name, "scores": scores})


def _scored(
    records: Iterator[SizedRecord], estimator: str | None, known: list[KnownSize], workers: int
) -> Iterator[ScoredRecord]:
    """Rows of the records, made by several processes."""
    from joblib import delayed

    return in_blocks((delayed(_score)(record, estimator, _factor(record, known)) for record in records), workers)


def _score(sized: SizedRecord, estimator: str | None, factor: float) -> ScoredRecord:
    return score_record(sized, find_estimator(estimator), factor)


def _factor(sized: SizedRecord, known: list[KnownSize]) -> float:
    machine = machine_of(str(sized.labels["bearing_id"]), str(sized.labels["rig"]))
    return factor_for(known, sized.record, machine)


def _split(folder: Path, asked: str | None) -> str:
    present = set(read_index(folder)["split"])
    if asked is None:
        return TEST if TEST in present else ALL
    require_split(folder, present, asked)
    return asked
