import dataclasses
import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physics.checks import InvalidParameter
from physics.paths.roughness import MOST_STEPS, draw_roughness, edge_window, low_passed, resolved_width
from physics.spall import Spall

WIDTH = 0.24e-3
EXTENT = math.radians(40)


def draw(gearbox, seed=0, race="outer", extent=EXTENT, deviation=2e-6, width=WIDTH):
    generator = np.random.default_rng(seed)
    return np.array(draw_roughness(generator, gearbox.bearing, race, extent, deviation, width))


@given(
    seed=st.integers(0, 10**6),
    extent=st.floats(0.005, math.pi),
    deviation=st.floats(1e-7, 1e-5),
    width=st.one_of(st.none(), st.floats(5e-5, 1e-3)),
    race=st.sampled_from(["outer", "inner"]),
)
@settings(max_examples=60, deadline=None, derandomize=True)
def test_roughness_has_the_stated_deviation_no_mean_and_vanishes_at_both_edges(
    gearbox, seed, extent, deviation, width, race
):
    values = draw(gearbox, seed, race, extent, deviation, width)
    assert values[0] == values[-1] == 0.0
    assert np.std(values) == pytest.approx(deviation, abs=1e-12)  # values are rounded to 1e-12 m
    assert abs(np.mean(values)) < 1e-12  # values are rounded to 1e-12 m


@given(extent=st.floats(0.005, math.pi), width=st.floats(5e-5, 1e-3), race=st.sampled_from(["outer", "inner"]))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_steps_are_an_eighth_of_the_contact_width_or_shorter(gearbox, extent, width, race):
    values = draw(gearbox, 0, race, extent, 1e-6, width)
    step = extent * gearbox.bearing.raceway_radius(race) / (values.size - 1)
    assert step <= width / 8 * (1 + 1e-12)


def test_a_contact_of_next_to_no_load_feels_no_more_steps_than_there_may_be(gearbox):
    one, other = draw(gearbox, 3, width=1e-9), draw(gearbox, 3, width=1e-7)
    assert one.size == MOST_STEPS + 1
    assert np.array_equal(one, other)


def test_a_contact_of_next_to_no_load_is_felt_as_one_of_eight_of_the_shortest_steps(gearbox):
    power = np.mean([np.abs(np.fft.rfft(draw(gearbox, seed, width=1e-9))) ** 2 for seed in range(10)], axis=0)
    waves = 8 * np.fft.rfftfreq(MOST_STEPS + 1)  # in that width
    assert power[waves > 2.5].sum() < 1e-4 * power.sum()
    # Under the gain 2^−(1.66 k)² half the power lies below k = 0.4769 / (1.66 √(2 ln 2)), as erf(0.4769) = 1/2.
    half = 0.4769 / (1.66 * math.sqrt(2.0 * math.log(2.0)))
    assert power[waves < half].sum() / power.sum() == pytest.approx(0.5, abs=0.017)  # four sampling deviations


def test_the_filter_has_no_phase_and_halves_waves_of_1_66_contact_widths_as_a_moving_average_does():
    count, step = 8300, WIDTH / 8  # 625 waves in 8300 steps of an eighth of the width: 1.66 widths each
    position = step * np.arange(count)
    for cycles, gain in ((625, 0.5), (1250, 2**-4.0), (1875, 2**-9.0)):
        wave = np.cos(2 * np.pi * cycles / (count * step) * position + 0.7)
        assert np.allclose(low_passed(wave, step, WIDTH), gain * wave, atol=1e-12)  # rounding of the transform


def test_waves_much_shorter_than_the_contact_width_are_gone(gearbox):
    step = EXTENT * gearbox.bearing.raceway_radius("outer") / (draw(gearbox).size - 1)
    power = np.mean([np.abs(np.fft.rfft(draw(gearbox, seed))) ** 2 for seed in range(50)], axis=0)
    wave_number = np.fft.rfftfreq(draw(gearbox).size, step)
    above = power[wave_number > 2.5 / WIDTH].sum() / power.sum()
    below = power[wave_number < 1.0 / WIDTH].sum() / power.sum()
    assert above < 1e-4
    assert below > 0.9


def test_the_middle_of_the_spall_is_as_rough_everywhere(gearbox):
    draws = np.array([draw(gearbox, seed) for seed in range(400)])
    inner = draws[:, 12:-12]  # one contact width, and some, from each edge
    deviation = np.std(inner, axis=0)
    assert np.all(np.abs(deviation / deviation.mean() - 1.0) < 0.15)  # four sampling deviations of 400 draws


def test_the_edges_rise_over_one_contact_width():
    window = edge_window(80, 1.0, 8.0)
    assert window[0] == window[-1] == 0.0
    assert np.all(window[8:-8] == 1.0)
    assert np.all(np.diff(window[:9]) > 0)
    assert window[4] == pytest.approx(0.5)


def test_a_spall_shorter_than_two_contact_widths_rises_over_half_its_length():
    window = edge_window(16, 1.0, 100.0)
    assert window[8] == 1.0
    assert np.count_nonzero(window == 1.0) == 1


def test_the_decimal_text_of_the_values_is_exact(gearbox):
    values = draw_roughness(np.random.default_rng(1), gearbox.bearing, "outer", EXTENT, 2e-6, WIDTH)
    assert tuple(json.loads(json.dumps(values))) == values
    assert all(float(f"{value:.12f}") == value for value in values)


def test_the_same_seed_draws_the_same_floor(gearbox):
    assert np.array_equal(draw(gearbox, 7), draw(gearbox, 7))
    assert not np.array_equal(draw(gearbox, 7), draw(gearbox, 8))


def test_without_a_contact_width_neighbouring_heights_are_independent(gearbox):
    neighbours = np.mean(
        [np.corrcoef(v[10:-11], v[11:-10])[0, 1] for v in (draw(gearbox, s, width=None) for s in range(40))]
    )
    assert abs(neighbours) < 0.03  # 40 draws of some 500 values: 0.007 each way
    filtered = draw(gearbox)
    assert np.corrcoef(filtered[10:-11], filtered[11:-10])[0, 1] > 0.8


def test_the_unfiltered_step_is_an_eighth_of_the_gap_into_which_a_ball_sags_by_the_deviation(gearbox):
    values = draw(gearbox, deviation=2e-6, width=None)
    gap = resolved_width(gearbox.bearing, 2e-6)
    radius = gearbox.bearing.ball_radius
    assert radius - math.sqrt(radius**2 - gap**2 / 4) == pytest.approx(2e-6, rel=1e-3)  # a circle is not a parabola
    step = EXTENT * gearbox.bearing.raceway_radius("outer") / (values.size - 1)
    assert gap / 8 * 0.99 < step <= gap / 8
    assert resolved_width(gearbox.bearing, 1e-9) == pytest.approx(80e-6)


def test_without_a_contact_width_a_long_spall_has_as_many_steps_as_the_shortest_step_asks_for(gearbox):
    large = dataclasses.replace(gearbox.bearing, pitch_diameter=0.2)
    values = draw_roughness(np.random.default_rng(0), large, "outer", math.pi, 1e-9, None)
    assert len(values) - 1 == math.ceil(math.pi * large.raceway_radius("outer") / 10e-6) > MOST_STEPS


def test_no_deviation_means_a_smooth_floor_and_draws_nothing(gearbox):
    generator = np.random.default_rng(0)
    assert draw_roughness(generator, gearbox.bearing, "outer", EXTENT, 0.0, WIDTH) == ()
    assert generator.random() == np.random.default_rng(0).random()


def test_the_values_fit_a_spall(gearbox):
    values = tuple(draw(gearbox, extent=0.005))
    spall = Spall("outer", 1, 4.7, 0.005, 1e-6, roughness=2e-6, roughness_values=values)
    assert dataclasses.replace(spall, race="inner").roughness_values == values


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"deviation": -1e-6}, "deviation = -1e-06 m; it must not be below 0"),
        ({"extent": 0.0}, "extent = 0.0 rad; allowed: above 0, up to 3.14159 rad"),
        ({"extent": 3.2}, "extent = 3.2 rad; allowed: above 0, up to 3.14159 rad"),
        ({"width": 0.0}, "contact_width = 0.0 m; it must be above 0"),
        ({"race": "cage"}, 'race = "cage"'),
    ],
)
def test_impossible_roughness_is_refused(gearbox, change, message):
    with pytest.raises(InvalidParameter, match=message):
        draw(gearbox, **change)


def test_the_shortest_spall_has_sixteen_steps(gearbox):
    assert draw(gearbox, extent=1e-3).size == 17  # 23 µm, a tenth of a contact width


def test_no_height_is_a_negative_zero(gearbox):
    values = np.concatenate([draw(gearbox, seed, extent=0.02) for seed in range(8)])
    assert not np.signbit(values[values == 0.0]).any()  # which the text of a scene would show
