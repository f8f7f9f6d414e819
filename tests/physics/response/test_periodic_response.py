"""Without slip a response repeats itself: it is marched until it does, and every later period is read from the last."""

from dataclasses import replace

import numpy as np
import pytest
from variants import changed

from physics.cage import CagePath
from physics.imperfections import Imperfections, Waviness
from physics.integrators.method_table import MODAL
from physics.request import Accurate
from physics.response.periodic import REPEATED, _reading_error, _repeated_changes, balls_a_period, period_of
from physics.response.resampling import read_at, read_repeated
from physics.rms import relative_error, rms
from physics.simulate import simulate
from physics.trace import ContactChanges, Kept

RATE = 65536.0


@pytest.fixture(scope="module", params=["F1", "F2", "F0"])
def steady(request, reference_scene):
    return _without_slip(reference_scene(request.param), 1.0)


def _without_slip(scene, duration):
    return replace(scene, cage=CagePath(scene.cage.nominal_speed, duration, scene.cage.start_angle, 0.004))


def test_what_is_repeated_is_what_a_march_to_the_end_gives(steady):
    trace, exact = simulate(steady, RATE), simulate(steady, RATE, Accurate(1e-5))
    assert trace.method == REPEATED
    assert exact.method == MODAL
    assert trace.acceleration.shape == exact.acceleration.shape
    error = relative_error(trace.acceleration, exact.acceleration)
    assert error <= trace.error_estimate <= 1e-3


def test_the_same_balls_touch_and_part_at_the_same_times(steady):
    trace, exact = simulate(steady, RATE), simulate(steady, RATE, Accurate(1e-5))
    for ball in range(1, steady.rig.bearing.balls + 1):
        for made in (True, False):
            own, other = (_times(one.changes, ball, made) for one in (trace, exact))
            assert own.size == other.size
            assert np.abs(own - other).max(initial=0.0) < 1e-5


def _times(changes, ball, made):
    return changes.time[(changes.ball == ball) & (changes.made == made)]


def test_an_accuracy_that_may_be_too_fine_to_read_is_kept_all_the_same(steady):
    trace, exact = simulate(steady, RATE, Accurate(3e-4)), simulate(steady, RATE, Accurate(1e-5))
    assert relative_error(trace.acceleration, exact.acceleration) <= trace.error_estimate <= 3e-4


def test_the_estimate_counts_what_the_last_period_has_not_settled_yet(reference_scene):
    scene = _without_slip(reference_scene("F1p", speed_factor=0.5), 1.2)
    trace, exact = simulate(scene, RATE), simulate(scene, RATE, Accurate(1e-5))
    assert trace.method == REPEATED
    assert relative_error(trace.acceleration, exact.acceleration) <= trace.error_estimate


def test_spikes_of_a_spall_that_is_passed_within_a_sample_are_not_read_between_samples(reference_scene):
    narrow = {"extent": 3e-4, "entry_taper": 1.2e-4, "exit_taper": 1.2e-4}
    scene = changed(_without_slip(reference_scene("G1"), 0.8), spall=narrow)
    trace, exact = simulate(scene, RATE), simulate(scene, RATE, Accurate(1e-5))
    assert relative_error(trace.acceleration, exact.acceleration) <= trace.error_estimate <= 1e-3


def test_a_finer_accuracy_than_can_be_read_is_marched_to_the_end(steady):
    assert simulate(steady, RATE, Accurate(1e-4)).method == MODAL


def test_states_are_kept_by_marching_to_the_end(steady):
    trace = simulate(steady, RATE, keep=Kept(state=True))
    assert trace.method == MODAL
    assert trace.state is not None


def test_a_short_record_is_marched_to_the_end(reference_scene):
    assert simulate(_without_slip(reference_scene("F1"), 0.1), RATE).method == MODAL


@pytest.mark.parametrize(
    "change",
    [
        lambda scene: scene,  # slips
        lambda scene: replace(_without_slip(scene, 1.0), second_cage=CagePath(scene.cage.nominal_speed, 1.0)),
        lambda scene: _running(scene, unbalance_force=5.0),
        lambda scene: _running(scene, load_fluctuation=0.1),
        lambda scene: _imperfect(scene, waviness=(Waviness("inner", 5, 1e-7),)),
        lambda scene: replace(
            _without_slip(scene, 1.0), spalls=tuple(replace(spall, race="inner") for spall in scene.spalls)
        ),
    ],
)
def test_what_turns_with_the_shaft_or_slips_never_repeats_itself(reference_scene, change):
    assert period_of(change(reference_scene("F1", slip_seed=1))) == np.inf


def _running(scene, **settings):
    return replace(_without_slip(scene, 1.0), operation=replace(scene.operation, **settings))


def _imperfect(scene, **settings):
    return replace(_without_slip(scene, 1.0), imperfections=Imperfections(**settings))


def test_unequal_balls_repeat_themselves_once_all_have_passed(reference_scene):
    scene = reference_scene("F1")
    bearing = scene.rig.bearing
    unequal = tuple(tuple(1e-7 * (ball % 3) for ball in range(bearing.balls)) for _ in range(bearing.rows))
    alike, different = _without_slip(scene, 1.0), _imperfect(scene, ball_deviation=unequal)
    assert (balls_a_period(alike), balls_a_period(different)) == (1, bearing.balls)
    assert period_of(alike) == pytest.approx(bearing.spacing / alike.cage.mean_speed)
    assert period_of(different) == pytest.approx(2.0 * np.pi / alike.cage.mean_speed)


def test_waves_of_the_outer_race_repeat_themselves_with_the_balls(reference_scene):
    scene = _imperfect(reference_scene("F0"), waviness=(Waviness("outer", 7, 2e-7),))
    trace, exact = simulate(scene, RATE), simulate(scene, RATE, Accurate(1e-5))
    assert trace.method == REPEATED
    error = relative_error(trace.acceleration, exact.acceleration)
    assert error <= trace.error_estimate <= 1e-3


def test_a_response_that_repeats_itself_only_after_two_periods_is_not_read_from_one(reference_scene):
    scene = changed(_without_slip(reference_scene("F1p", speed_factor=2.0), 0.4), operation={"load": 50.0})
    trace, exact = simulate(scene, RATE), simulate(scene, RATE, Accurate(1e-5))
    assert rms(trace.acceleration - exact.acceleration) <= trace.error_estimate * rms(exact.acceleration)
    assert trace.error_estimate <= 1e-3


@pytest.mark.parametrize("speed_factor", [1.0, 0.8])  # on in one direction, and to and fro
def test_a_slow_part_of_the_transient_that_hides_behind_the_rest_is_seen(reference_scene, speed_factor):
    scene = changed(reference_scene("F1", 0.6, speed_factor=speed_factor), operation={"load": 80.0})
    trace, exact = simulate(scene, RATE), simulate(scene, RATE, Accurate(1e-5))
    assert trace.method == REPEATED
    assert rms(trace.acceleration - exact.acceleration) <= trace.error_estimate * rms(exact.acceleration)


def test_a_response_of_which_a_low_rate_leaves_little_is_not_repeated(reference_scene):
    scene = _without_slip(reference_scene("F1s"), 0.4)
    low, exact = simulate(scene, 1000.0), simulate(scene, 1000.0, Accurate(1e-6))
    assert rms(low.acceleration - exact.acceleration) <= low.error_estimate * rms(exact.acceleration)
    assert low.method == MODAL
    assert simulate(scene, 8000.0).method == REPEATED


def test_a_polynomial_of_degree_five_is_read_exactly_anywhere():
    grid, place = np.arange(40.0), np.array([0.0, 0.3, 1.7, 12.5, 20.0, 37.9, 39.0])
    rows = np.column_stack([grid**5 - 3.0 * grid**2, 2.0 - grid**3])
    expected = np.column_stack([place**5 - 3.0 * place**2, 2.0 - place**3])
    assert read_at(rows, place) == pytest.approx(expected, rel=1e-10, abs=1e-6)
    with pytest.raises(ValueError, match="5 samples"):
        read_at(rows[:5], place)


def test_what_goes_on_and_on_is_read_from_its_last_period_even_across_its_end():
    beginning, period, pace = 5, 8, 0.7
    on_and_on = np.sin(2.0 * np.pi / period * np.arange(200))
    # A beginning of its own, then whole periods; of them only two are given.
    longer = np.column_stack([on_and_on, np.arange(200.0) % period])
    longer[:beginning] += 3.0
    known = longer[: beginning + 3 + 2 * period]
    expected = read_at(longer, pace * np.arange(250))
    assert read_repeated(known, period, pace, 250) == pytest.approx(expected, abs=1e-12)  # rounding


def test_the_error_of_reading_between_samples_is_told_where_the_signal_has_corners():
    """Of every other sample each corner is missed by twice as much, at as many of half the places: √8 times the RMS."""

    def corners(place):
        return np.stack([np.abs(place / 60.7 % 1.0 - 0.5), np.abs((place / 47.3 + 0.3) % 1.0 - 0.5)], axis=1)

    place = np.arange(20_000.0)
    signal, between = corners(place), place[10:-10] + 0.5
    missed = rms(read_at(signal, between) - corners(between)) / rms(signal)
    assert _reading_error(signal) == pytest.approx(0.5 * np.sqrt(8.0) * missed, rel=0.05)


def test_changes_of_a_march_beyond_the_record_are_left_out(reference_scene):
    scene = reference_scene("G0", 0.1)
    time = np.array([0.01, 0.09, 0.11])
    numbers = np.ones(3, dtype=np.int16)
    initial = np.zeros((2, 12), dtype=np.bool_)
    changes = ContactChanges(time, numbers, numbers, np.ones(3, dtype=np.bool_), initial)
    assert _repeated_changes(scene, changes, 0.12, 0.1).time == pytest.approx([0.01, 0.09])
