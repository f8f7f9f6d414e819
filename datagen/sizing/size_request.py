"""What a person asks of the sizes of a corpus."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class SizeRequest:
    """The records of the corpus in `folder` of one `split` (None: its test split, or all if it has none; "all").

    `estimator` is that of the user, None for ours; `load_known` if it is given the load and the Hertz factor. Known
    `sizes` (mm by record) correct the other records of their machines.
    """

    folder: Path
    estimator: str | None = None
    load_known: bool = True
    split: str | None = None
    sizes: Mapping[int, float] = field(default_factory=dict)

    @property
    def estimator_name(self) -> str:
        """What reports and logs call the estimator."""
        return self.estimator or "spallgen"
