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


def test_each_record_has_its_own_signals_and_text() -> None:
    signals = np.arange(30.0).reshape(3, 5, 2)
    columns = {"acceleration": signals, "acceleration_clean": -signals, "scenario": np.array(["a", "b", "c"])}
    stored = stored_record(SimpleNamespace(variables=columns), 1, 7)
    assert stored.clean is not None
    assert (stored.acceleration.tolist(), stored.clean.tolist()) == (signals[1].tolist(), (-signals[1]).tolist())
    assert (stored.text, stored.simulated, stored.passes, stored.speed_changes) == ("b", True, None, False)
    assert stored.truth(LABELS) is None


def test_a_recording_has_its_provenance_and_says_whether_its_speed_changes() -> None:
    columns = {"acceleration": np.zeros((2, 5, 1)), "provenance": np.array(["a", "b"]), "shaft_angle": np.zeros((2, 5))}
    stored = stored_record(SimpleNamespace(variables=columns), 1, 1)
    assert (stored.text, stored.simulated, stored.clean, stored.speed_changes) == ("b", False, None, True)


def test_where_contact_is_not_lost_the_dips_of_the_load_are_the_events() -> None:
    leave, unknown = 0.01 + PERIOD * np.arange(4), np.full(4, np.nan)
    passes = {"exit_time": leave, "release_time": unknown, "regain_time": unknown}
    passes |= {"fall_time": leave - 0.2 * PERIOD, "rise_time": leave - 0.1 * PERIOD}
    truth = StoredRecord(np.zeros((5, 1)), None, True, "", passes).truth(LABELS)
    assert truth is not None
    assert truth.first == pytest.approx(leave - 0.2 * PERIOD)
    assert truth.last == pytest.approx(leave - 0.1 * PERIOD)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('{"parameters": {"K": 6e9, "n": 1.4}}', (6e9, 1.4)),
        ('{"parameters": {"K": 6e9}}', None),
        ('{"parameters": {"K": "stiff", "n": 1.4}}', None),
        ('{"parameters": {"K": null, "n": null}}', None),
        ('{"parameters": []}', None),
        ("{}", None),
        ("[]", None),
        ("", None),
        ("of a test rig", None),
    ],
)
def test_hertz_factor_and_exponent_are_read_where_they_are_told(
    text: str, expected: tuple[float, float] | None
) -> None:
    assert StoredRecord(np.zeros((5, 1)), None, True, text, None).contact_stiffness() == expected
