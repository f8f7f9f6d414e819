"""The facts that a card states of a corpus."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from datagen.corpus import Corpus
from datagen.corpus_files.manifest import Manifest
from datagen.inspection.info import Info, corpus_info
from labels.schema import SPLITS, UNKNOWN

if TYPE_CHECKING:
    import pandas

SPLIT_ORDER = (*SPLITS, UNKNOWN)


@dataclass(frozen=True)
class Kind:
    """Records of one condition and location: how many in each split, the first of them and the shard that holds it."""

    condition: str
    location: str
    records: int
    by_split: dict[str, int]
    first: int
    shard: str


@dataclass(frozen=True)
class Solved:
    """How records were made by one model and method: range of `step` (s), spread of `error_estimate`.

    Quantities without a known value are None; `errors_unknown` counts the records whose error was not estimated.
    """

    model: str
    method: str
    records: int
    shortest_step: float | None
    longest_step: float | None
    median_error: float | None
    error_95_percent: float | None
    largest_error: float | None
    errors_unknown: int


@dataclass(frozen=True)
class Terms:
    """Licence, citation and address, as the recipe or SPEC states them; empty if it does not."""

    licence: str
    citation: str
    url: str


@dataclass(frozen=True)
class Facts:
    """Everything a card states."""

    info: Info
    summary: str
    terms: Terms
    kinds: tuple[Kind, ...]
    solved: tuple[Solved, ...]
    rates_hz: tuple[float, ...]
    durations_s: tuple[float, float]
    splits: dict[str, int]


def corpus_facts(folder: Path) -> Facts:
    """The facts of the corpus in `folder`; raises BadInput if there is none. One record at least must be made."""
    corpus = Corpus(folder)
    manifest, table = corpus.manifest, corpus.labels
    return Facts(
        info=corpus_info(folder),
        summary=str(_stated(manifest, "summary")),
        terms=Terms(*(str(_stated(manifest, name)) for name in ("licence", "citation", "url"))),
        kinds=tuple(_kinds(table)),
        solved=tuple(solved(table)),
        rates_hz=tuple(sorted(set(table["rate_hz"].tolist()))),
        durations_s=(float(table["duration_s"].min()), float(table["duration_s"].max())),
        splits={name: int((table["split"] == name).sum()) for name in SPLIT_ORDER if (table["split"] == name).any()},
    )


def _stated(manifest: Manifest, name: str) -> object:
    return manifest.written.get(name) or ""


def _kinds(table: pandas.DataFrame) -> list[Kind]:
    return [
        Kind(
            condition=str(condition),
            location=str(location),
            records=len(rows),
            by_split={str(split): int(count) for split, count in rows["split"].value_counts().items()},
            first=int(rows["record"].min()),
            shard=str(rows.loc[rows["record"].idxmin(), "shard"]),
        )
        for (condition, location), rows in table.groupby(["condition", "location"])
    ]


def solved(table: pandas.DataFrame) -> list[Solved]:
    """Steps and error estimates of the records of each model and method."""
    return [_solved(str(model), str(method), rows) for (model, method), rows in table.groupby(["model", "method"])]


def _solved(model: str, method: str, rows: pandas.DataFrame) -> Solved:
    estimates = rows["error_estimate"].dropna()
    return Solved(
        model=model,
        method=method,
        records=len(rows),
        shortest_step=_known(rows["step"].min()),
        longest_step=_known(rows["step"].max()),
        median_error=_known(estimates.median()),
        error_95_percent=_known(estimates.quantile(0.95)),
        largest_error=_known(estimates.max()),
        errors_unknown=len(rows) - len(estimates),
    )


def _known(value: float) -> float | None:
    return None if value != value else float(value)
