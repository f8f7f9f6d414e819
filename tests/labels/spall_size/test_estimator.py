"""What the estimator tells of the pair of events that it found."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from labels.spall_size.estimator import _told
from labels.spall_size.situation import Situation

GEARBOX = Situation(12, 2, 38.75e-3, 7.12e-3, 2.0 * math.pi * 30.0)


def test_no_lag_is_longer_than_a_pass_and_no_spall_than_half_the_race():
    place = np.array([200.0, 300.0, 400.0])
    evidence: Any = SimpleNamespace(race="outer", rate=1000.0, mean=SimpleNamespace(period=100.0))
    evidence.alignment = SimpleNamespace(place=place, weight=np.ones(3))
    measured: Any = SimpleNamespace(lag=95.0, lag_arc=3.0, entry=0.0, exit=95.0, row=np.zeros(1))
    longer: Any = SimpleNamespace(correction=lambda row: (1.2, 1.5))
    judgement: Any = SimpleNamespace(lag=longer, arc=longer)
    told = _told(evidence, measured, judgement, GEARBOX, 0.5)
    assert told.lag == pytest.approx(0.1)
    assert told.lag_interval == pytest.approx((0.1 / 1.5, 0.15))
    assert told.extent == pytest.approx(math.pi)
    assert told.candidates == pytest.approx((math.pi,))
