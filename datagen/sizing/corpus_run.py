"""A corpus scored: every record estimated, compared with its truth, summed up."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from datagen.corpus_files.index import read_index
from datagen.corpus_files.manifest import read_manifest
from datagen.judging.scored_runs import write_line
from datagen.judging.splits import ALL, TEST, require_split
from datagen.progress import Count, ignore
from datagen.sizing.aggregation import summarise
from datagen.sizing.comparison import score_record, unsized_row
from datagen.sizing.estimators import find_estimator, is_fitted_to
from datagen.sizing.flat_rows import flat_summary
from datagen.sizing.in_blocks import in_blocks
from datagen.sizing.known_sizes import KnownSize, factor_for, known_sizes, machine_by_labels, with_effect
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_request import SizeRequest
from datagen.sizing.size_scores import SizeScores
from datagen.sizing.size_summary import StatedSizes
from datagen.sizing.sized_records import SizedRecord, count_records, sized_records, unsized_records, without_load
from datagen.sizing.stated_sizes import states_sizes, summarise_stated


def score_sizes(asked: SizeRequest, workers: int = 1, count: Count = ignore) -> SizeScores:
    """Scores of the records asked for.

    A record that cannot be sized has a row that says why. `count` is called with how many records are done. A run on
    recordings with a stated extent or state of health is logged beside them, before and after. Raises BadInput if no
    record can be sized, or the split, a known size or the estimator cannot be used.
    """
    folder, sizer = asked.folder, find_estimator(asked.estimator)
    split = _split(folder, asked.split)
    splits = None if split == ALL else (split,)
    unsized = [unsized_row(record) for record in unsized_records(folder, splits)]
    logged = states_sizes(folder)
    if logged:
        _log_beginning(asked, split)
    known = known_sizes(folder, asked.sizes, _told(asked, sized_records(folder, only=asked.sizes)), sizer)
    sized = _scored(_told(asked, sized_records(folder, splits)), asked.estimator, known, workers)
    made = _counted(sized, count_records(folder, splits) - len(unsized), count)
    scores = _summed_up(asked, split, sorted([*made, *unsized], key=lambda record: record.truth.record), known)
    if logged:
        _log_scores(asked, scores.stated)
    return scores


def _told(asked: SizeRequest, records: Iterator[SizedRecord]) -> Iterator[SizedRecord]:
    """The records as the estimator is to see them."""
    return records if asked.load_known else without_load(records)


def _summed_up(asked: SizeRequest, split: str, scored: list[ScoredRecord], known: list[KnownSize]) -> SizeScores:
    true = [record for record in scored if record.truth.known]
    return SizeScores(
        folder=str(asked.folder),
        estimator=asked.estimator_name,
        split=split,
        load_known=asked.load_known,
        records=scored,
        summary=summarise(true, asked.load_known) if true else None,
        known_sizes=with_effect(known, scored),
        stated=summarise_stated(scored),
        load_given=sum(record.answer.load_known for record in scored),
        fitted_to=_count_fitted_to(asked, scored),
    )


def _count_fitted_to(asked: SizeRequest, scored: list[ScoredRecord]) -> int:
    manifest = read_manifest(asked.folder)
    if manifest.imported or asked.estimator is not None:
        return 0
    return sum(record.asked and is_fitted_to(manifest.recipe["seed"], record.truth.split) for record in scored)


def _counted(scored: Iterator[ScoredRecord], total: int, count: Count) -> list[ScoredRecord]:
    """All of the `total` rows, counting each as it comes."""
    rows = []
    for row in scored:
        rows.append(row)
        count(len(rows), total)
    return rows


def _log_beginning(asked: SizeRequest, split: str) -> None:
    """Note in the log beside the recordings what is about to be scored."""
    options = {"split": split, "load_known": asked.load_known, "known_sizes": dict(asked.sizes)}
    write_line(asked.folder, {"began": options, "sizes_by": asked.estimator_name})


def _log_scores(asked: SizeRequest, stated: StatedSizes | None) -> None:
    """Append the scores to the log beside the recordings."""
    scores = None if stated is None else flat_summary(stated)
    write_line(asked.folder, {"sizes_by": asked.estimator_name, "scores": scores})


def _scored(
    records: Iterator[SizedRecord], estimator: str | None, known: list[KnownSize], workers: int
) -> Iterator[ScoredRecord]:
    """Rows of the records, made by several processes."""
    from joblib import delayed

    return in_blocks((delayed(_score)(record, estimator, _factor(record, known)) for record in records), workers)


def _score(sized: SizedRecord, estimator: str | None, factor: float) -> ScoredRecord:
    return score_record(sized, find_estimator(estimator), factor)


def _factor(sized: SizedRecord, known: list[KnownSize]) -> float:
    return factor_for(known, sized.record, machine_by_labels(sized.labels))


def _split(folder: Path, asked: str | None) -> str:
    present = set(read_index(folder)["split"])
    if asked is None:
        return TEST if TEST in present else ALL
    require_split(folder, present, asked)
    return asked
