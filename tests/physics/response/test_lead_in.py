"""Responses of machines that have run for a while when their record begins."""

import dataclasses
import math
from functools import cache

import numpy as np
import pytest

from physics.cage import CagePath
from physics.checks import InvalidParameter
from physics.imperfections import Imperfections, Waviness
from physics.outcome import Outcome, SimulationFailed
from physics.reference_scenes import reference_scene
from physics.request import FixedSteps, HalvedSteps, LeadIn, Reference, Simpler
from physics.response.lead_in import from_start, respond_behind, started_earlier
from physics.rms import relative_error, rms
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium, load_vector
from physics.trace import ContactChanges, Kept, Trace

RATE = 65536.0
LEAD_IN = 0.1


def slipping(name, duration, lead_in=LEAD_IN, seed=1):
    """The reference scene whose slip is known from −lead_in on, and is none of those without a lead-in."""
    longer = reference_scene(name, duration + lead_in, slip_seed=seed)
    cage = dataclasses.replace(
        longer.cage,
        duration=duration,
        start_angle=float(longer.cage.polynomial(lead_in)),
        knot_start=longer.cage.knot_start - lead_in,
    )
    return dataclasses.replace(longer, cage=cage)


@cache
def quiet_scene():
    """A healthy bearing with an unbalanced shaft: its start from rest is much louder than its run."""
    scene = reference_scene("G0", 0.3)
    run = dataclasses.replace(scene.operation, unbalance_force=30.0)
    return dataclasses.replace(scene, operation=run)


@pytest.mark.parametrize("name", ["G1", "F2"])
def test_what_comes_before_a_long_lead_in_is_forgotten(name):
    scene = reference_scene(name, 0.2)
    plain, once, twice = (simulate(scene, RATE, lead_in=LeadIn(lead_in)).acceleration for lead_in in (0.0, 0.4, 0.8))
    # Each has an error of at most 1e-3 of its own.
    assert rms(once - twice) < 2e-3 * rms(twice)
    assert rms(plain - twice) > 0.05 * rms(twice)


def test_a_scene_that_started_earlier_does_the_same_later():
    scene = slipping("F1", 0.2)
    earlier, instants = started_earlier(scene, LEAD_IN), np.linspace(-LEAD_IN, 0.2, 301)
    np.testing.assert_allclose(earlier.cage.angle(instants + LEAD_IN), scene.cage.angle(instants), atol=1e-12)
    np.testing.assert_allclose(earlier.cage.speed(instants + LEAD_IN), scene.cage.speed(instants), rtol=1e-12)
    assert earlier.duration == pytest.approx(0.3)


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_loads_spalls_waves_and_both_cages_stand_after_the_lead_in_where_the_record_begins_with_them(race):
    scene = reference_scene("G1", 0.05)
    turning = {"unbalance_force": 60.0, "unbalance_phase": 0.3, "load_fluctuation": 0.2, "fluctuation_phase": 1.9}
    scene = dataclasses.replace(
        scene,
        operation=dataclasses.replace(scene.operation, **turning),
        second_cage=CagePath(0.97 * scene.cage.nominal_speed, 0.05, 0.1),
        spalls=(dataclasses.replace(scene.spalls[0], race=race, extent=0.3),),
        imperfections=Imperfections((Waviness("outer", 7, 1e-6, 0.4), Waviness("inner", 3, 2e-6, 1.1))),
    )
    earlier, instants = started_earlier(scene, LEAD_IN), np.linspace(0.0, 0.05, 101)
    load = load_vector(scene, instants)
    assert load_vector(earlier, instants + LEAD_IN) == pytest.approx(load, abs=1e-9)  # N; rounding of phases
    # What each ball bears tells where it is, and spall and waves below it.
    borne = equilibrium(scene, instants).ball_load
    assert equilibrium(earlier, instants + LEAD_IN).ball_load == pytest.approx(borne, abs=1e-6)  # N, of up to 70


def test_the_modal_method_keeps_its_accuracy_behind_a_start_that_is_much_louder():
    scene = quiet_scene()
    trace = simulate(scene, RATE, lead_in=LeadIn(LEAD_IN))
    whole = simulate(scene, RATE, lead_in=LeadIn(LEAD_IN, kept=True))
    fine = simulate(scene, RATE, FixedSteps(8), lead_in=LeadIn(LEAD_IN))
    assert rms(whole.acceleration[: round(0.02 * RATE)]) > 5.0 * rms(trace.acceleration)
    error = relative_error(trace.acceleration, fine.acceleration)
    assert error <= trace.error_estimate <= 1e-3


def stand_in(asked, calls, chaotic=False):
    """A trace of which the first half is ten times as loud as the second, with half the error that is asked for."""
    calls.append(asked)
    trace = simulate(reference_scene("G0", 100 / RATE), RATE)
    signal = np.where(np.arange(100)[:, None] < 50, 10.0, 1.0) * np.ones(2)
    return dataclasses.replace(trace, acceleration=signal, error_estimate=0.5 * asked, chaotic=chaotic)


def test_a_response_is_made_again_until_what_comes_behind_is_exact_enough():
    calls = []
    trace = respond_behind(lambda asked: stand_in(asked, calls), 50, 1e-3, 0.0)
    apart = math.sqrt((100.0 + 1.0) / 2.0)  # RMS of the whole over that of its second half
    assert calls == pytest.approx([1e-3, 0.9 * 1e-3 / (0.5 * apart)])
    assert trace.error_estimate == pytest.approx(0.5 * calls[-1] * apart)
    assert 0.5e-3 < trace.error_estimate <= 1e-3


def test_an_error_that_is_always_allowed_is_allowed_behind_a_lead_in_too():
    calls = []
    trace = respond_behind(lambda asked: stand_in(asked, calls), 50, 1e-3, 4e-3)
    assert calls == [1e-3]
    assert trace.error_estimate == pytest.approx(0.5e-3 * math.sqrt(50.5))


def test_a_chaotic_response_stays_one():
    calls = []
    trace = respond_behind(lambda asked: stand_in(asked, calls, chaotic=True), 50, 1e-3, 0.0)
    assert calls == [1e-3]
    assert trace.error_estimate == 0.5e-3


def test_the_instants_before_the_record_are_there_if_wanted():
    scene = slipping("G1", 0.05)
    keep = Kept(state=True, force=True, outer=True, fastest_path=9000.0)
    whole, recorded = (simulate(scene, RATE, keep=keep, lead_in=LeadIn(LEAD_IN, kept)) for kept in (True, False))
    before, factor = round(LEAD_IN * RATE), round(whole.outer.rate / RATE)
    assert whole.time[0] == -before / RATE
    assert recorded.time[0] == 0.0
    assert recorded.time.size == round(0.05 * RATE)
    assert factor > 1
    for field in ("acceleration", "state", "contact_force"):
        np.testing.assert_array_equal(getattr(recorded, field), getattr(whole, field)[before:])
    for field in ("displacement", "velocity", "acceleration"):
        np.testing.assert_array_equal(getattr(recorded.outer, field), getattr(whole.outer, field)[before * factor :])
    np.testing.assert_array_equal(from_start(whole).changes.time, recorded.changes.time)


def test_the_balls_that_touch_when_the_record_begins_are_those_that_carry_then():
    scene = slipping("G1", 0.05, seed=3)
    trace = simulate(scene, RATE, keep=Kept(force=True), lead_in=LeadIn(LEAD_IN))
    start = simulate(scene, RATE, lead_in=LeadIn(LEAD_IN, kept=True))
    np.testing.assert_array_equal(trace.changes.initial, trace.contact_force[0] != 0.0)
    assert np.any(trace.changes.initial != start.changes.initial)
    assert trace.changes.time.min() >= 0.0
    assert trace.changes.time.max() < 0.05


def test_of_changes_those_before_0_are_in_the_first_contacts_and_that_at_0_is_still_logged():
    balls, made = np.array([1, 2, 2, 1], np.int16), np.array([False, True, False, True])
    changes = ContactChanges(
        np.array([-1.5, -1.0, 0.0, 1.0]), np.ones(4, np.int16), balls, made, np.array([[True, False]])
    )
    trace = Trace(1.0, np.arange(-2.0, 3.0), np.zeros((5, 2)), changes, "none", "none", 1.0, 0.0, 0.0)
    recorded = from_start(trace)
    assert recorded.time.tolist() == [0.0, 1.0, 2.0]
    assert recorded.changes.time.tolist() == [0.0, 1.0]
    assert recorded.changes.initial.tolist() == [[False, True]]


def test_changes_of_contact_stay_with_the_forces_that_they_change():
    scene = slipping("G1", 0.1, seed=3)
    trace = simulate(scene, RATE, keep=Kept(force=True), lead_in=LeadIn(LEAD_IN))
    touching = trace.changes.initial.copy()
    instants = np.searchsorted(trace.changes.time, trace.time)
    done = 0
    for k in range(0, trace.time.size, 7):
        while done < instants[k]:
            touching[trace.changes.row[done] - 1, trace.changes.ball[done] - 1] = trace.changes.made[done]
            done += 1
        np.testing.assert_array_equal(touching, trace.contact_force[k] != 0.0)
    assert done > 10


def test_a_lead_in_of_which_the_slip_is_not_known_is_refused():
    scene = reference_scene("G1", 0.02, slip_seed=1)
    with pytest.raises(SimulationFailed, match=r"a lead-in of 0.1 s; the cage's slip is known from -0.0\d+ s on"):
        simulate(scene, RATE, lead_in=LeadIn(0.1))
    with pytest.raises(InvalidParameter, match="slip knots cover"):
        started_earlier(scene, 0.1)


def test_the_slip_of_both_cages_has_to_be_known_during_the_lead_in():
    known = slipping("G1", 0.02)
    late = dataclasses.replace(known, second_cage=reference_scene("G1", 0.02, slip_seed=1).cage)
    with pytest.raises(SimulationFailed, match=r"a lead-in of 0.1 s; the cage's slip is known from -0.0\d+ s on"):
        simulate(late, RATE, lead_in=LeadIn(LEAD_IN))


def test_a_lead_in_whose_whole_samples_begin_before_the_slip_is_known_is_refused():
    scene = reference_scene("G1", 0.02, slip_seed=1)
    known = -scene.cage.knot_start
    rate = (math.floor(known * RATE) + 0.6) / known
    with pytest.raises(SimulationFailed, match="the cage's slip is known from") as caught:
        simulate(scene, rate, lead_in=LeadIn(known))
    assert caught.value.outcome is Outcome.BAD_REQUEST


@pytest.mark.parametrize("solution", [HalvedSteps(), Reference()])
def test_other_methods_have_a_lead_in_too(solution):
    scene = slipping("G1", 0.01, lead_in=0.01)
    trace = simulate(scene, RATE, lead_in=LeadIn(0.01))
    other = simulate(scene, RATE, solution, lead_in=LeadIn(0.01))
    assert trace.time.size == other.time.size == round(0.01 * RATE)
    assert rms(trace.acceleration - other.acceleration) < 2e-3 * rms(other.acceleration)


def test_the_quasi_static_model_knows_no_start():
    scene = slipping("G1", 0.02)
    keep, model = Kept(force=True), Simpler("quasi-static")
    at_rest, run_in = (simulate(scene, RATE, model, keep=keep, lead_in=LeadIn(lead)) for lead in (0.0, LEAD_IN))
    np.testing.assert_allclose(run_in.contact_force, at_rest.contact_force, atol=1e-6)
