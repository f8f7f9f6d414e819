"""Which virtual machines two corpora have in common, so that no record is scored that was learned from."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.corpus import Corpus
from datagen.errors import BadInput

if TYPE_CHECKING:
    import pandas

TEST = "test"


def machines(corpus: Corpus) -> NDArray[np.str_]:
    """The machine of each record: the seed of the recipe and the number of the virtual bearing, "" if recorded.

    Seed and number alone set what is drawn, so copies of a corpus and corpora made again have the same machines, under
    whatever name.
    """
    names = corpus.labels["bearing_id"].astype(str)
    if corpus.manifest.imported:
        return np.full(len(names), "", dtype=np.str_)
    seed = corpus.manifest.recipe["seed"]
    return np.array([f"{seed}-{name.rpartition('-')[2]}" for name in names], dtype=np.str_)


def share_machines(one: Corpus, other: Corpus) -> bool:
    """True if a machine has records in both."""
    return bool((set(machines(one).tolist()) & set(machines(other).tolist())) - {""})


def unseen_records(tested: Corpus, trained: Corpus, learned: NDArray[np.int64]) -> pandas.DataFrame:
    """Labels of the records of `tested` to score, none of a machine of the `learned` records of `trained`.

    Those of other machines of `trained` count if their split is "test". Raises BadInput if none is left.
    """
    labels = tested.labels
    own, known = machines(tested), machines(trained)
    seen = known[trained.labels["record"].isin(learned)]
    kept = ~np.isin(own, seen) & (~np.isin(own, known) | (labels["split"] == TEST))
    chosen = labels[kept | (own == "")]
    if chosen.empty:
        problem = "all its virtual bearings, or all outside its split test, are those of --train"
        allowed = "a corpus of a recipe with another seed, or one with a split test"
        raise BadInput(problem, str(tested.folder), "--test", None, allowed)
    return chosen
