"""A scored record made of plain numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from datagen.sizing.scored_record import Answer, ScoredRecord, Truth

RATE = 65_536.0
NOTHING: Mapping[str, object] = MappingProxyType({})


@pytest.fixture
def scored() -> Callable[..., ScoredRecord]:
    """Function (**changes) → a record sized exactly, 10 dB, with these changes."""
    return exactly_sized


def exactly_sized(
    truth: Mapping[str, object] = NOTHING, answer: Mapping[str, object] = NOTHING, **changes: object
) -> ScoredRecord:
    """A record sized exactly, 10 dB, with what the test changes in its truth, in the answer and in the rest."""
    exact = Truth(
        record=0, recording="", channel="", bearing_id="b", rig="r", race="outer", profile="tukey", split="test",
        snr_db=10.2, speed_rpm=600.0, load_n=100.0, extent_mm=2.0, extent_spacing=0.2, rate=RATE, pass_period=0.02,
        lag=0.004, extent=0.1, known=True,
    )  # fmt: skip
    same = Answer(
        outcome="estimated", reason="", method="m", race="outer", trust=0.9, lag=0.004, lag_interval=(0.003, 0.005),
        lag_arc=0.08, extent=0.1, extent_interval=(0.09, 0.12), extent_mm=2.0, extent_mm_interval=(1.8, 2.4),
        candidates=(0.1, 0.6), candidates_mm=(2.0, 12.0), event_times=np.zeros((0, 2)), seconds=0.1,
    )  # fmt: skip
    whole = ScoredRecord(replace(exact, **truth), replace(same, **answer), static_arc=0.1, envelope_arc=0.05)  # type: ignore[arg-type]
    return replace(whole, **changes)  # type: ignore[arg-type]
