"""One record beside its truth: what the plain rule is told of the race."""

from __future__ import annotations

import math

import numpy as np
import pytest

from datagen.sizing.record_scores import score_record
from datagen.sizing.sized_records import SizedRecord
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome

RATE = 65536.0
LAG = 100.0 / RATE
MACHINE = Situation(12, 2, 38.75e-3, 7.12e-3, 2.0 * math.pi * 30.0)
NAMES = ("recording", "channel", "bearing_id", "rig", "profile", "split")
TOLD = SizeEstimate(SizeOutcome.ESTIMATED, "constant", "inner", lag=LAG, lag_arc=0.1, extent=0.1, extent_mm=1.0)


class Says:
    """An estimator that gives a stated answer."""

    def __init__(self, answer: SizeEstimate) -> None:
        self.answer = answer

    def estimate(self, acceleration: np.ndarray, rate: float, situation: Situation) -> SizeEstimate:
        return self.answer


def record_at(location: str) -> SizedRecord:
    """Bursts of 6 kHz, two a pass of the inner race, LAG apart; the labels say `location`."""
    period = MACHINE.pass_periods()["inner"]
    time, signal = np.arange(32768) / RATE, np.zeros(32768)
    for start in np.arange(0.001, 0.49, period):
        for burst in (start, start + LAG):
            since = np.maximum(time - burst, 0.0)
            signal += np.exp(-since / 2e-4) * np.sin(2.0 * math.pi * 6000.0 * since)
    labels = dict.fromkeys(NAMES, "") | dict.fromkeys(("snr_db", "load_n", "extent_mm", "extent_spacing"), 1.0)
    labels |= {"record": 0, "location": location, "rate_hz": RATE, "extent": 0.1, "speed_rpm": 1800.0}
    labels |= {"bpfo": MACHINE.bearing().bpfo, "bpfi": MACHINE.bearing().bpfi}
    return SizedRecord(0, RATE, np.column_stack([signal, signal]), None, labels, MACHINE, None)


@pytest.mark.parametrize(
    ("told", "location", "race"),
    [
        (TOLD, "inner", "inner"),
        (TOLD, "outer", "inner"),  # as wrong as what was told
        (SizeEstimate(SizeOutcome.NO_PASSES, ""), "inner", "inner"),
        (SizeEstimate(SizeOutcome.NO_PASSES, ""), "none", "outer"),
    ],
)
def test_the_plain_rule_divides_by_the_pass_of_the_race_that_was_told_or_else_of_the_true_one(
    told: SizeEstimate, location: str, race: str
) -> None:
    scored = score_record(record_at(location), Says(told))
    # A ball covers one spacing (30 degrees) of a race in a pass; a burst's peak lies within a few samples of its start.
    expected = math.radians(30.0) * LAG / MACHINE.pass_periods()[race]
    assert scored.envelope_arc == pytest.approx(expected, rel=0.05)
