"""What a simulation gives back is a plain record that nobody changes by accident."""

import dataclasses
import math

import numpy as np
import pytest

from physics.integrators.modal.modal_march import march_modal
from physics.integrators.output import STEPS
from physics.request import FixedSteps, Reference, Simpler
from physics.simulate import simulate
from physics.spall import Spall
from physics.trace import ContactChanges, Kept

RATE = 65536.0
LINE = Spall("outer", 1, 4.712388980384690, 0.035, 12e-6, 0.005, 0.005)


@pytest.fixture(scope="module")
def trace(gearbox, build_scene):
    scene = build_scene(gearbox, LINE, start_angle=0.1)
    short = dataclasses.replace(scene, cage=dataclasses.replace(scene.cage, duration=0.1))
    return simulate(short, RATE, keep=Kept(state=True, force=True))


def test_a_trace_holds_one_row_a_sample(trace):
    count = round(0.1 * RATE)
    assert trace.time == pytest.approx(np.arange(count) / RATE, abs=1e-15)
    assert trace.acceleration.shape == (count, 2)
    assert trace.state.shape == (count, 12)
    assert trace.contact_force.shape == (count, 2, 12)
    assert trace.rate == RATE


def test_a_trace_cannot_be_changed_by_assignment(trace):
    with pytest.raises(dataclasses.FrozenInstanceError):
        trace.rate = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        trace.changes.time = np.zeros(0)


def test_contact_changes_are_in_time_order_and_name_balls_from_one(trace):
    changes = trace.changes
    assert changes.time.size == changes.row.size == changes.ball.size == changes.made.size > 0
    assert np.all(np.diff(changes.time) >= 0.0)
    assert {1, 2} >= set(changes.row.tolist())
    assert set(range(1, 13)) >= set(changes.ball.tolist())
    assert changes.initial.shape == (2, 12)


def test_replaying_the_changes_from_the_first_contact_set_gives_the_balls_that_carry_force(trace):
    held = trace.changes.initial.copy()
    contact = np.empty(trace.contact_force.shape, dtype=bool)
    place = 0
    for k, time in enumerate(trace.time):
        while place < trace.changes.time.size and trace.changes.time[place] <= time:
            here = trace.changes.row[place] - 1, trace.changes.ball[place] - 1
            assert held[here] != trace.changes.made[place]
            held[here] = trace.changes.made[place]
            place += 1
        contact[k] = held
    assert np.array_equal(contact, trace.contact_force != 0.0)


@pytest.mark.parametrize(
    ("solution", "samples"),
    [
        (FixedSteps(2, "exponential_adams2"), 0.5),
        (FixedSteps(2, "dormand_prince"), 0.5),
        (Reference(), math.nan),
        (Simpler("impulse train"), math.nan),
        (Simpler("quasi-static"), math.nan),
        (Simpler("linear time-varying"), 1.0),
    ],
)
def test_the_step_is_what_the_trace_says_it_is_for_each_kind_of_method(solution, samples, reference_scene):
    trace = simulate(reference_scene("G0", 0.01), RATE, solution)
    assert trace.step * RATE == pytest.approx(samples, rel=1e-12, nan_ok=True)


def test_the_step_of_the_modal_method_is_the_mean_over_the_march(reference_scene, monkeypatch):
    outputs = []

    def listening(*arguments):
        outputs.append(arguments[-1])
        return march_modal(*arguments)

    monkeypatch.setattr("physics.response.modal_case.march_modal", listening)
    trace = simulate(reference_scene("G0", 0.05), RATE)
    spans = [(output.acceleration.shape[0] - 1) / output.tally[STEPS] for output in outputs]
    assert trace.step * RATE in [pytest.approx(span) for span in spans]
    assert 1.0 < trace.step * RATE < 24.0  # its longest stride


@pytest.mark.parametrize(
    ("solution", "share"),
    [
        (Simpler("quasi-static"), 0.0),  # without a film no ball pulls
        (Simpler("impulse train"), math.nan),
        (Simpler("linear time-varying"), math.nan),
        (Reference(), math.nan),
    ],
)
def test_the_share_of_tension_is_only_known_where_the_forces_of_balls_are_followed(solution, share, reference_scene):
    trace = simulate(reference_scene("G1", 0.01), RATE, solution)
    assert trace.tension_share == pytest.approx(share, nan_ok=True)


def test_changes_before_an_end_are_those_before_it_and_not_at_it():
    """What happens at the instant of the sample behind the last one belongs to that sample."""
    times, ones, made = np.array([0.1, 0.2, 0.3]), np.ones(3, np.int16), np.array([True, False, True])
    early = ContactChanges(times, ones, 2 * ones, made, np.zeros((1, 2), bool)).before(0.2)
    assert (early.time.tolist(), early.made.tolist()) == ([0.1], [True])
    assert (early.row.tolist(), early.ball.tolist()) == ([1], [2])
