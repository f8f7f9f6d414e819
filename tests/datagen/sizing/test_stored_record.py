"""Which passes of a stored table are events of the spall."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from datagen.sizing.stored_record import StoredRecord, stored_record

LABELS = {"location": "outer", "speed_rpm": 1800.0, "bpfo": 5.0}
PERIOD = 1.0 / (30.0 * 5.0)


def test_a_ball_that_regains_contact_half_a_pass_behind_the_exit_or_later_tells_nothing_of_the_spall() -> None:
    leave = 0.01 + PERIOD * np.arange(4)
    late = np.array([-0.1, 0.49, 0.51, 4.9]) * PERIOD
    unknown = np.full(4, np.nan)
    passes = {
        "exit_time": leave,
        "release_time": leave - 0.3 * PERIOD,
        "regain_time": leave + late,
        "fall_time": unknown,
        "rise_time": unknown,
    }
    truth = StoredRecord(np.zeros((5, 1)), None, True, "", passes).truth(LABELS)
    assert truth is not None
    assert truth.last == pytest.approx((leave + late)[:2])
    assert truth.first == pytest.approx((leave - 0.3 * PERIOD)[:2])


def test_passes_of_other_records_are_left_out() -> None:
    time = np.array([0.1, 0.2, 0.3])
    columns = dict.fromkeys(("exit_time", "release_time", "regain_time", "fall_time", "rise_time"), time)
    columns |= {"pass_record": np.array([1, 2, 1]), "acceleration": np.zeros((2, 5, 1))}
    stored = stored_record(SimpleNamespace(variables=columns), 0, 1)
    assert stored.passes is not None
    assert [column.tolist() for column in stored.passes.values()] == [[0.1, 0.3]] * 5
    assert stored.text == ""
