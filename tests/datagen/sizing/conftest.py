"""A scored record made of plain numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from datagen.sizing.scored_record import NO_SCORES, ScoredRecord

RATE = 65_536.0


@pytest.fixture
def scored() -> Callable[..., ScoredRecord]:
    """Function (**changes) → the row of a record told exactly, 10 dB, with these changes."""
    return exactly_told


def exactly_told(**changes: object) -> ScoredRecord:
    """A record told exactly, 10 dB, with what the test changes."""
    exact = ScoredRecord(
        record=0, recording="", channel="", bearing_id="b", rig="r", race="outer", profile="tukey", split="test",
        snr_db=10.2, speed_rpm=600.0, load_n=100.0,
        extent_mm=2.0, extent_spacing=0.2, rate=RATE, pass_period=0.02, true_lag=0.004, true_extent=0.1,
        outcome="estimated", reason="", method="m", found_race="outer", trust=0.9,
        lag=0.004, lag_low=0.003, lag_high=0.005, lag_arc=0.08,
        extent=0.1, extent_low=0.09, extent_high=0.12, estimated_deg=5.73, estimated_deg_low=5.16,
        estimated_deg_high=6.88, estimated_mm=2.0, estimated_mm_low=1.8, estimated_mm_high=2.4, candidates=(0.1, 0.6),
        candidates_deg=(5.73, 34.4), candidates_mm=(2.0, 12.0), static_arc=0.1, envelope_arc=0.05,
        known_size_factor=1.0, seconds=0.1, event_times=np.zeros((0, 2)),
        events_in_time=NO_SCORES, events_in_arc=NO_SCORES, known_truth=True,
    )  # fmt: skip
    return replace(exact, **changes)  # type: ignore[arg-type]
