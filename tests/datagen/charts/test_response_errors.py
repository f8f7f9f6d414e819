"""How far a response is from another."""

import dataclasses
import math

import numpy as np
import pytest

from datagen.charts.response import Response, of_trace
from datagen.charts.response_errors import ResponseErrors, response_errors
from labels.envelope import default_band
from labels.truth import ball_passes
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


def cut(trace, stop):
    """The response as it is known until `stop` (s)."""
    samples, whole = round(stop * RATE), of_trace(trace)
    return Response(whole.acceleration[:samples], whole.displacement[:samples], trace.changes.before(stop))


def test_events_that_a_response_lacks_are_counted(response):
    scene, trace = response
    none = dataclasses.replace(of_trace(trace), changes=trace.changes.before(0.0))
    table = ball_passes(scene, trace.changes, 0.2)
    scored = np.sum((table.entry_time > 0.1) & (table.exit_time < 0.2))
    found = response_errors(scene, RATE, none, of_trace(trace))
    assert found.events_missed == 2 * scored > 0  # a release and a regain in each pass
    assert math.isnan(found.worst_event_us)


def test_events_behind_the_end_of_a_short_response_are_not_missed(response):
    scene, trace = response
    table = ball_passes(scene, trace.changes, 0.2)
    late = np.flatnonzero(table.release_time > 0.15)[0]
    middle = 0.5 * (table.release_time[late] + table.regain_time[late])
    assert response_errors(scene, RATE, cut(trace, middle), of_trace(trace)).events_missed == 0


@pytest.mark.parametrize(("race", "level"), [("inner", 0.0), ("outer", 3.01)])
def test_the_line_of_the_envelope_is_that_of_the_defective_race(race, level):
    """The balls' passes of both races modulate a tone; those of the outer one are twice as deep as in the reference."""
    scene = reference_scene("F1", 0.5)
    scene = dataclasses.replace(scene, spalls=(dataclasses.replace(scene.spalls[0], race=race),))
    turned = scene.operation.shaft_speed * np.arange(round(0.5 * RATE)) / RATE
    carrier = np.cos(np.pi * sum(default_band(scene.rig, RATE)) * np.arange(turned.size) / RATE)
    inner, outer = (0.01 * np.cos(order * turned) for order in (scene.rig.bearing.bpfi, scene.rig.bearing.bpfo))
    found, exact = (
        Response(np.column_stack([carrier, (1.0 + inner + depth * outer) * carrier]), None, None)
        for depth in (2.0, 1.0)
    )
    assert response_errors(scene, RATE, found, exact).envelope_db == pytest.approx(level, abs=0.05)


def test_the_error_of_the_stiffness_is_that_along_the_load():
    scene = reference_scene("G0", 0.2)
    bearing, samples = scene.rig.bearing, round(0.2 * RATE)
    balls = np.arange(bearing.balls) * bearing.spacing
    place = np.concatenate([balls, balls + bearing.stagger]) + scene.cage.angle(np.arange(samples) / RATE)[:, None]

    def along(x, y):  # the sum of 3/2 K √δ sin² over the balls [P14 Eq. 26], without clearance
        compression = np.maximum(x * np.cos(place) + y * np.sin(place), 0.0)
        return np.sum(1.5 * bearing.load_deflection * np.sqrt(compression) * np.sin(place) ** 2, axis=1)

    still = np.zeros((samples, 2))
    found, exact = (Response(still, still + moved, None) for moved in ((2e-6, -6e-6), (0.0, -6e-6)))
    scored, true = along(2e-6, -6e-6)[round(0.1 * RATE) :], along(0.0, -6e-6)[round(0.1 * RATE) :]
    expected = np.sqrt(np.mean((scored - true) ** 2) / np.mean(true**2))
    assert response_errors(scene, RATE, found, exact).stiffness == pytest.approx(expected, rel=1e-6)
