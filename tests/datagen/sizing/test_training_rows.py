"""The noise in which the calibration hears the records."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from datagen.sizing.training_rows import LEVELS_DB, Heard, _with_noise, trial
from labels.spall_size.event_truth import EventTruth


def test_records_are_heard_in_noise_of_the_levels_of_the_ladder() -> None:
    clean = 3.0 * np.random.default_rng(0).standard_normal(20_000)
    ratios = [clean.std() / (_with_noise(clean, record) - clean).std() for record in range(40)]
    levels = np.array([20.0 * math.log10(ratio) for ratio in ratios])
    nearest = np.abs(levels[:, None] - np.array(LEVELS_DB)).argmin(axis=1)
    # The deviation of 20 000 draws is known to 0.5 %, 0.04 dB.
    assert levels == pytest.approx(np.array(LEVELS_DB)[nearest], abs=0.2)
    assert set(nearest.tolist()) == set(range(len(LEVELS_DB)))


@pytest.mark.parametrize(("extent", "lag", "arc"), [(0.2, 30.0, 0.2), (0.2 + math.pi / 6.0, 30.0, 0.2)])
def test_whole_passes_are_taken_off_the_lag_and_as_many_spacings_off_the_arc(
    monkeypatch: pytest.MonkeyPatch, extent: float, lag: float, arc: float
) -> None:
    # Twelve balls; a pass lasts 100 samples, so a spall a spacing longer shows its exit 100 samples later.
    monkeypatch.setattr("datagen.sizing.training_rows._quality", lambda *_: np.zeros(1))
    late = 0.130 if extent > math.pi / 6.0 else 0.030
    first = 0.1 * np.arange(1.0, 6.0)
    labels = {"location": "outer", "extent": extent, "bearing_id": "b", "extent_spacing": 6.0 * extent / math.pi}
    labels |= {"speed_rpm": 600.0, "bpfo": 1.0}
    machine: Any = SimpleNamespace(bearing=lambda: SimpleNamespace(spacing=math.pi / 6.0))
    truth = EventTruth(first, first + late, np.zeros(5, dtype=np.bool_))
    sized: Any = SimpleNamespace(record=0, rate=1000.0, truth=truth, labels=labels, situation=machine)
    seen: Any = SimpleNamespace(race="outer", mean=SimpleNamespace(period=100.0), pairs=SimpleNamespace(lag=first))
    made = trial(sized, seen, Heard(np.zeros(1000), 0, True, True))
    assert (made.lag, made.arc) == (pytest.approx(lag), pytest.approx(arc))
