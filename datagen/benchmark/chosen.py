"""The records of a corpus that are judged."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.machines import LearnedMachines, unseen_records
from datagen.corpus import Corpus

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class ChosenRecords:
    """Records of the corpus in `folder`, `imported` or simulated, by their `labels`, a row each."""

    folder: Path
    labels: pandas.DataFrame
    imported: bool

    @property
    def numbers(self) -> NDArray[np.int64]:
        """The index (R,) of each record."""
        return self.labels["record"].to_numpy(np.int64)


def chosen_records(folder: Path, learned: LearnedMachines | None) -> ChosenRecords:
    """The records of `folder` that are judged: none of the machines that were `learned` from, all if that is None.

    Raises BadInput if none is left.
    """
    corpus = Corpus(folder)
    labels = corpus.labels if learned is None else unseen_records(corpus, learned)
    return ChosenRecords(folder, labels, bool(corpus.manifest.imported))
