"""Which passes count as true events of a record, and of a part of it."""

import math

import numpy as np

from labels.spall_size.event_truth import EventTruth, event_truth


def test_a_regain_long_after_the_exit_is_no_event():
    release, regain = np.array([0.1, 0.3]), np.array([0.12, 0.39])
    nothing = np.full(2, math.nan)
    truth = event_truth(release, regain, nothing, nothing, latest=np.array([0.15, 0.35]))
    assert (truth.first.tolist(), truth.last.tolist()) == ([0.1], [0.12])


def test_where_contact_is_kept_the_load_tells_the_events():
    missing = np.array([math.nan])
    truth = event_truth(missing, missing, np.array([0.2]), np.array([0.21]), latest=np.array([0.3]))
    assert truth.kept.tolist() == [True]
    assert math.isclose(truth.lag, 0.01)


def test_a_part_of_a_record_holds_the_passes_that_lie_in_it_whole():
    first = np.array([0.1, 0.2, 0.3, 0.4])
    truth = EventTruth(first, first + np.array([0.01, 0.02, 0.03, 0.04]), np.array([True, False, True, False]))
    part = truth.within(0.15, 0.42)
    assert np.allclose(part.first, [0.05, 0.15])
    assert np.allclose(part.last, [0.07, 0.18])
    assert part.kept.tolist() == [False, True]
    assert math.isclose(part.lag, 0.025)
    assert math.isnan(truth.within(0.5, 0.6).lag)
    assert truth.within(0.205, 0.5).first.tolist() == [0.3 - 0.205, 0.4 - 0.205]  # the second begins before


def test_the_lag_of_a_record_is_the_median_over_its_passes():
    first = np.array([0.1, 0.2, 0.3])
    assert math.isclose(EventTruth(first, first + np.array([0.01, 0.02, 0.06]), np.zeros(3, dtype=bool)).lag, 0.02)
