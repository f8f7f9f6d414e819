"""How far a response is from another."""

import dataclasses
import math

import numpy as np
import pytest

from datagen.charts.response import of_trace
from datagen.charts.response_errors import ResponseErrors, response_errors
from physics.reference_scenes import reference_scene
from physics.request import FixedSteps
from physics.simulate import simulate
from physics.trace import Kept

RATE = 65536.0


@pytest.fixture(scope="module")
def response():
    """The fan rig's line spall over 0.2 s with its states."""
    scene = reference_scene("F1", 0.2)
    trace = simulate(scene, RATE, FixedSteps(2), keep=Kept(state=True))
    return scene, trace


def test_a_response_scored_against_itself_has_no_error(response):
    scene, trace = response
    found = response_errors(scene, RATE, of_trace(trace), of_trace(trace))
    assert found == ResponseErrors(0.0, 0.0, 0.0, 0.0, 0.0, 0, 0.0)


def test_a_response_one_percent_too_large_is_one_percent_and_a_sixth_of_a_decibel_off(response):
    scene, trace = response
    larger = dataclasses.replace(of_trace(trace), acceleration=1.01 * trace.acceleration)
    found = response_errors(scene, RATE, larger, of_trace(trace))
    assert found.acceleration == pytest.approx(0.01, rel=1e-9)
    assert found.envelope_db == pytest.approx(20.0 * math.log10(1.01), rel=1e-6)  # a squared envelope
    assert found.stiffness == 0.0


def test_late_contact_changes_are_late_by_as_much(response):
    scene, trace = response
    late = dataclasses.replace(trace.changes, time=trace.changes.time + 3e-6)
    found = response_errors(scene, RATE, dataclasses.replace(of_trace(trace), changes=late), of_trace(trace))
    assert found.release_us == pytest.approx(3.0, rel=1e-6)
    assert found.regain_us == pytest.approx(3.0, rel=1e-6)
    assert found.worst_event_us == pytest.approx(3.0, rel=1e-6)


def test_what_is_not_finite_is_infinitely_wrong(response):
    scene, trace = response
    broken = dataclasses.replace(of_trace(trace), acceleration=np.full_like(trace.acceleration, np.nan))
    assert response_errors(scene, RATE, broken, of_trace(trace)).acceleration == math.inf
