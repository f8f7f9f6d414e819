"""Which virtual machines two corpora share, so that no record of a machine that was learned from is scored."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.options import TEST_ON
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.judging.splits import TEST

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class LearnedMachines:
    """The machines that were learned from, `seen` (S,), and all machines of their corpus, `known` (K,)."""

    seen: NDArray[np.str_]
    known: NDArray[np.str_]


def machines(corpus: Corpus) -> NDArray[np.str_]:
    """The machine (R,) of each record: the recipe's seed and the number of the virtual bearing, "" if it was recorded.

    So copies of a corpus, and corpora made again under another name or with small changes, have the same machines. For
    safety's sake all recipes of one seed count as having the same, also those that draw other machines from it.
    """
    names = corpus.labels["bearing_id"].astype(str)
    if corpus.manifest.imported:
        return np.full(len(names), "", dtype=np.str_)
    seed = corpus.manifest.recipe["seed"]
    return np.array([f"{seed}-{name.rpartition('-')[2]}" for name in names], dtype=np.str_)


def share_machines(one: Corpus, other: Corpus) -> bool:
    """True if a machine has records in both."""
    return bool((set(machines(one).tolist()) & set(machines(other).tolist())) - {""})


def learned_machines(trained: Corpus, records: NDArray[np.int64]) -> LearnedMachines:
    """The machines of those `records` of a corpus that were learned from."""
    known = machines(trained)
    return LearnedMachines(known[trained.labels["record"].isin(records)], known)


def unseen_records(tested: Corpus, learned: LearnedMachines) -> pandas.DataFrame:
    """Labels of the records of `tested` to score: none of a machine that was learned from.

    Records of other machines of the same corpus are kept if their split is "test". Raises BadInput if none is left.
    """
    labels, of_records = tested.labels, machines(tested)
    kept = ~np.isin(of_records, learned.seen) & (~np.isin(of_records, learned.known) | (labels["split"] == TEST))
    chosen = labels[kept | (of_records == "")]
    if chosen.empty:
        problem = "all its virtual bearings, or all outside its split test, were learned from"
        allowed = "a corpus of a recipe with another seed, or one with a split test"
        raise BadInput(problem, file=str(tested.folder), field=TEST_ON, allowed=allowed)
    return chosen
