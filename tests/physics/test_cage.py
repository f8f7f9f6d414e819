import dataclasses
import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physics.cage import CagePath, draw_slip_knots, slip_knot_scale
from physics.checks import InvalidParameter
from physics.crossing import crossing_times

SPEED = 17.95
SPACING = 2 * math.pi / 12
BALL_PASS = SPACING / SPEED
SLIP = 0.01


def drawn_path(seed=0, duration=1.0, deviation=SLIP, correlation_time=BALL_PASS, **other):
    step, start, values = draw_slip_knots(np.random.default_rng(seed), deviation, correlation_time, duration)
    return CagePath(SPEED, duration, knot_step=step, knot_start=start, knot_values=values, **other)


@pytest.fixture(scope="module")
def slips():
    """Slip of 2000 draws, shape (2000, 40), over ten correlation times."""
    times = np.linspace(0.0, 10 * BALL_PASS, 40)
    return np.array([drawn_path(seed, 10 * BALL_PASS).speed(times) / SPEED - 1.0 for seed in range(2000)])


def test_without_slip_the_cage_turns_evenly():
    path = CagePath(SPEED, 2.0, start_angle=0.3)
    time = np.linspace(0.0, 2.0, 11)
    assert np.allclose(path.angle(time), 0.3 + SPEED * time, rtol=1e-15)
    assert np.allclose(path.speed(time), SPEED, rtol=1e-15)


def test_a_mean_slip_slows_the_cage_by_that_share():
    path = CagePath(SPEED, 1.0, mean_slip=0.02)
    assert path.angle(np.array([1.0]))[0] == pytest.approx(0.98 * SPEED, rel=1e-14)
    slipping, plain = drawn_path(mean_slip=0.02), drawn_path()
    time = np.linspace(0.0, 1.0, 9)
    assert np.allclose(plain.angle(time) - slipping.angle(time), 0.02 * SPEED * time, atol=1e-12)  # rounding


def test_any_step_reads_the_same_path():
    path = drawn_path()
    fine = np.arange(65537) / 65536
    halves = path.angle(fine)[::2]
    assert np.array_equal(path.angle(fine[::2]), halves)
    steps = np.concatenate([path.angle(part) for part in np.array_split(fine, 7)])
    assert np.array_equal(path.angle(fine), steps)


def crossed(path, target):
    """When the cage is at each of the `target` angles."""
    return crossing_times(path.polynomial, path.mean_speed, path.duration, target)


def test_the_ball_pass_times_do_not_depend_on_how_finely_they_are_looked_for():
    path = drawn_path()
    targets = SPACING * np.arange(1, 30)
    exact = crossed(path, targets)
    for rate in (512, 65536):
        time = np.arange(rate + 1) / rate
        found = np.interp(targets, path.angle(time), time)
        curvature = 5 * SLIP * SPEED / BALL_PASS * 4
        assert np.max(np.abs(found - exact)) < curvature / (8 * rate**2) / SPEED * 2  # error of linear interpolation


def test_speed_is_the_derivative_of_the_angle():
    path = drawn_path()
    time, h = np.linspace(0.1, 0.9, 33), 1e-5
    difference = (path.angle(time + h) - path.angle(time - h)) / (2 * h)
    assert np.allclose(difference, path.speed(time), rtol=1e-6)  # third derivative of the angle times h²


def test_slip_passes_through_its_knots():
    path = drawn_path(mean_slip=0.01)
    inside = (path.knot_times >= 0) & (path.knot_times <= path.duration)
    slip = path.speed(path.knot_times[inside]) / SPEED - 1.0 + 0.01
    assert np.allclose(slip, np.array(path.knot_values)[inside], atol=1e-12)  # rounding


def test_slip_has_the_stated_deviation_and_no_mean_over_many_draws(slips):
    assert np.std(slips) == pytest.approx(SLIP, rel=0.02)  # 2000 draws of about ten independent values: 0.5 %
    assert abs(np.mean(slips)) < 3 * SLIP / math.sqrt(2000 * 5)


def test_slip_is_stationary(slips):
    deviation = np.std(slips, axis=0)
    assert np.all(np.abs(deviation / SLIP - 1.0) < 0.09)  # sampling 1.6 %, and the spline sags between its knots
    first, last = np.std(slips[:, :8]), np.std(slips[:, -8:])
    assert first == pytest.approx(last, rel=0.05)  # two averages of 2000 draws


def test_slip_forgets_itself_over_the_correlation_time(slips):
    lag = 4  # in the 40 samples over ten correlation times, 1.026 correlation times
    product = np.mean(slips[:, :-lag] * slips[:, lag:]) / SLIP**2
    assert product == pytest.approx(math.exp(-10 * lag / 39), abs=0.04)  # 2000 draws and the spline's smoothing


def test_the_ball_pass_period_scatters_by_about_0_87_of_the_slip_s_deviation():
    path = drawn_path(seed=3, duration=400.0)
    periods = np.diff(crossed(path, SPACING * np.arange(1, 13000)))
    scatter = np.std(periods) / np.mean(periods) / SLIP
    assert 0.85 < scatter < 0.91  # √(2/e) = 0.858 for the exponential correlation; the spline adds a little


@pytest.mark.parametrize("passes", [0.5, 4.0])
def test_the_scatter_of_the_period_follows_from_the_correlation_time(passes):
    path = drawn_path(seed=4, duration=400.0, correlation_time=passes * BALL_PASS)
    periods = np.diff(crossed(path, SPACING * np.arange(1, 13000)))
    ratio = 1 / passes
    expected = math.sqrt(2 * (ratio - 1 + math.exp(-ratio))) / ratio
    assert np.std(periods) / np.mean(periods) / SLIP == pytest.approx(expected, rel=0.05)  # sampling and the spline


@given(seed=st.integers(0, 10**6), start=st.floats(-10, 10), mean=st.floats(-0.1, 0.1))
@settings(max_examples=20, deadline=None, derandomize=True)
def test_crossing_times_invert_the_angle(seed, start, mean):
    path = drawn_path(seed, start_angle=start, mean_slip=mean)
    time = np.linspace(0.0, 1.0, 50)
    assert np.allclose(crossed(path, path.angle(time)), time, atol=1e-12)  # rounding of angles near 30 rad
    assert path.angle(np.zeros(1))[0] == pytest.approx(start, abs=1e-12)


def test_crossing_times_invert_the_angle_even_of_a_cage_that_nearly_stops_and_nearly_doubles():
    values = (0.5, -0.5) * 60
    path = CagePath(SPEED, 1.0, knot_step=0.01, knot_start=-0.02, knot_values=values, mean_slip=0.2)
    time = np.linspace(0.0, 1.0, 1001)
    assert path.speed(time).min() < 0.35 * SPEED
    assert np.allclose(crossed(path, path.angle(time)), time, atol=1e-12)  # rounding of angles near 15 rad


def test_crossing_times_beyond_the_ends_go_on_at_the_mean_speed():
    path = drawn_path(start_angle=1.0)
    last = path.angle(np.array([1.0]))[0]
    found = crossed(path, np.array([1.0 - SPEED, last + 2 * SPEED]))
    assert found == pytest.approx([-1.0, 3.0], rel=1e-12)  # rounding


def test_crossing_times_of_a_relative_angle_follow_the_same_rule():
    path = CagePath(SPEED, 1.0)
    half = dataclasses.replace(path, nominal_speed=SPEED / 2)
    found = crossing_times(half.polynomial, SPEED / 2, 1.0, np.array([SPEED / 4]))
    assert found == pytest.approx([0.5], rel=1e-14)


def test_the_knots_survive_their_decimal_text_exactly():
    path = drawn_path()
    assert tuple(json.loads(json.dumps(path.knot_values))) == path.knot_values
    assert all(float(f"{value:.12f}") == value for value in path.knot_values)


def test_the_same_seed_draws_the_same_knots_and_a_longer_run_only_adds_to_them():
    short, again, long = drawn_path(5), drawn_path(5), drawn_path(5, duration=3.0)
    assert short == again
    assert long.knot_values[: len(short.knot_values)] == short.knot_values
    assert drawn_path(6).knot_values != short.knot_values


def test_the_knots_reach_two_steps_beyond_both_ends():
    path = drawn_path()
    assert path.knot_times[0] == pytest.approx(-2 * path.knot_step)
    assert path.knot_times[-1] >= 1.0 + 2 * path.knot_step * (1 - 1e-9)


def test_the_knots_of_a_slip_with_a_lead_in_reach_two_steps_beyond_its_start():
    step, start, values = draw_slip_knots(np.random.default_rng(1), SLIP, 0.04, 1.0, lead_in=0.3)
    assert (step, start) == pytest.approx((0.01, -0.32))
    assert start + step * (len(values) - 1) >= 1.0 + 2.0 * step * (1.0 - 1e-9)


def test_more_knots_of_a_slip_than_fit_into_memory_are_refused_before_they_are_drawn():
    with pytest.raises(InvalidParameter, match=r"the slip needs 4e\+07 knots, .* allowed: up to 1e\+07") as caught:
        draw_slip_knots(np.random.default_rng(1), SLIP, 1e-7, 1.0)
    assert caught.value.field == "correlation_time"


def test_a_path_that_goes_on_keeps_what_it_was_and_the_speed_of_its_last_knot():
    path = drawn_path(3, start_angle=0.4)
    longer, last = path.going_on(5 * BALL_PASS), path.knot_times[-1]
    within = np.linspace(0.0, last, 500)
    np.testing.assert_allclose(longer.angle(within), path.angle(within), rtol=1e-14)
    beyond = last + np.linspace(0.0, 4 * BALL_PASS, 50)
    speed = SPEED * (1.0 + path.knot_values[-1])
    np.testing.assert_allclose(longer.angle(beyond), path.angle(last) + speed * (beyond - last), rtol=1e-13)
    np.testing.assert_allclose(crossed(longer, longer.angle(beyond[:25])), beyond[:25], rtol=1e-12)
    # By less than a step between knots, too: the last spline goes no farther than its knots.
    short = dataclasses.replace(path, duration=last).going_on(0.9 * path.knot_step)
    beyond = np.linspace(last, short.duration, 20)
    np.testing.assert_allclose(short.angle(beyond), path.angle(last) + speed * (beyond - last), rtol=1e-13)
    even = CagePath(SPEED, 1.0, 0.4).going_on(0.5)
    assert even.duration == 1.5
    assert even.angle(np.array([1.5])) == pytest.approx(0.4 + 1.5 * SPEED)


@pytest.mark.parametrize("correlation", [0.1, math.exp(-0.25), 0.95])
def test_the_knot_scale_makes_up_for_the_spline(correlation):
    rng = np.random.default_rng(1)
    steps = 60000
    noise = rng.standard_normal(steps)
    knots = np.empty(steps)
    knots[0] = noise[0]
    for k in range(1, steps):
        knots[k] = correlation * knots[k - 1] + math.sqrt(1 - correlation**2) * noise[k]
    path = CagePath(1.0, steps - 1.0, knot_step=1.0, knot_values=tuple(np.clip(0.1 * knots, -0.5, 0.5)))
    fine = np.linspace(0.0, steps - 1.0, 4 * steps)
    deviation = np.std(path.speed(fine)) / 0.1
    tolerance = 3 * math.sqrt((1 + correlation) / (1 - correlation) / (2 * steps)) + 1e-3
    assert deviation * slip_knot_scale(correlation) == pytest.approx(1.0, abs=tolerance)  # three sampling deviations


@pytest.mark.parametrize(
    ("change", "field", "message"),
    [
        ({"nominal_speed": 0.0}, "nominal_speed", "nominal_speed = 0.0 rad/s; it must be above 0"),
        ({"duration": -1.0}, "duration", "duration = -1.0 s; it must be above 0"),
        ({"start_angle": math.nan}, "start_angle", "start_angle = nan rad; allowed: -1e.06 to 1e.06 rad"),
        ({"mean_slip": 0.3}, "mean_slip", "mean_slip = 0.3; allowed: -0.2 to 0.2"),
        ({"knot_step": 0.0}, "knot_step", "knot_step = 0.0 s; it must be above 0"),
        ({"knot_start": 0.01}, "knot_values", "slip knots cover 0.01 to"),
        ({"duration": 2.0}, "knot_values", "they must cover 0 to 2 s"),
        ({"knot_values": (0.0, 0.6) * 100}, "knot_values", "knot_values = 0.6; allowed: -0.5 to 0.5"),
        ({"knot_values": (math.nan,) * 200}, "knot_values", "knot_values = nan; allowed"),
    ],
)
def test_an_impossible_path_is_refused_by_field_and_value(change, field, message):
    with pytest.raises(InvalidParameter, match=message) as caught:
        dataclasses.replace(drawn_path(), **change)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"deviation": -0.01}, "deviation"),
        ({"deviation": math.nan}, "deviation"),
        ({"correlation_time": 0.0}, "correlation_time"),
        ({"duration": -1.0}, "duration"),
        ({"duration": math.nan}, "duration"),
        ({"lead_in": -0.1}, "lead_in"),
    ],
)
def test_slip_cannot_be_drawn_with_a_negative_deviation_or_without_correlation_or_duration(change, field):
    settings = {"deviation": 0.01, "correlation_time": 0.03, "duration": 1.0} | change
    with pytest.raises(InvalidParameter, match=field) as caught:
        draw_slip_knots(np.random.default_rng(0), **settings)
    assert caught.value.field == field
