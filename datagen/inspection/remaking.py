"""Records simulated again from their stored scenarios, and held against what is stored."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from datagen.errors import BadInput

if TYPE_CHECKING:
    from datagen.corpus import Corpus

LARGEST_DIFFERENCE = 1e-3


@dataclass(frozen=True)
class Remade:
    """How far a record made again is from the stored one, RMS over its RMS (None: it could not be made), and what
    `problems` that shows."""

    difference: float | None
    problems: tuple[str, ...] = ()


def remake_record(corpus: Corpus, record: int) -> Remade:
    """Simulate a `record` of the `corpus` again from its stored scenario, for the signals that are stored of it.

    What is kept of a response has a part in how it is marched.
    """
    from datagen.records.record import OPTIONAL_SIGNALS, make_record
    from datagen.scenarios.scenario_text import scenario_of
    from physics.outcome import SimulationFailed
    from physics.rms import relative_error

    stored = corpus.waveform(record).astype(np.float64)
    kept = tuple(name for name in OPTIONAL_SIGNALS if corpus.has(record, name))
    try:
        again = make_record(scenario_of(str(corpus.waveform(record, "scenario"))), kept).acceleration
    except (BadInput, SimulationFailed) as problem:
        return Remade(None, (f"record {record} cannot be simulated again from its scenario: {problem}",))
    difference = relative_error(again.astype(np.float64), stored)
    if difference <= LARGEST_DIFFERENCE:
        return Remade(difference)
    differs = (
        f"record {record} simulated again from its scenario differs by {difference:.2g} of its RMS; "
        f"allowed: {LARGEST_DIFFERENCE:g}"
    )
    return Remade(difference, (differs,))
