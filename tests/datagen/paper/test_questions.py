"""Answers to the three questions, on a part of their grids; the whole grids are slow."""

import math

import numpy as np
import pytest

from datagen.drawing.style import house_style
from datagen.paper import question1_extended_profiles, question2_unequal_balls, question3_slip
from datagen.paper.profile_search import CHOSEN, REFERENCE, SMOOTH, Outcome, Profile, outcome, profiles, rough_profiles
from datagen.paper.question1_extended_profiles import answer
from datagen.paper.question2_unequal_balls import machine_state, measure, unequal
from datagen.paper.question3_slip import FADED, faded, lines_at, predicted_drop
from datagen.paper.question3_slip import measure as measure_slip
from datagen.paper.scenes import RATE, reference_extended_spall
from physics.reference_scenes import extended_spall

SIXTH = 5


@pytest.fixture(scope="module")
def chosen():
    """The profile that the figures use, found in the grid by its name."""
    return next(one for one in rough_profiles((2.0,), (8.0,), (4.0,)) if one.title == CHOSEN)


def test_the_profiles_that_the_figures_name_are_in_the_grid():
    assert {CHOSEN, REFERENCE, SMOOTH} <= {one.title for one in profiles()}


def test_a_search_without_the_chosen_profile_has_no_table():
    outcomes, _, _ = made_up_numbers()
    others = [one for one in outcomes if one.profile.title != CHOSEN]
    with pytest.raises(ValueError, match="8 µm about 4 µm, shortest wave 2 mm"):
        question1_extended_profiles.rows(others)


def few(profile, draws):
    return Profile(profile.family, profile.title, profile.draws[:draws])


def test_long_waves_lift_the_lines_and_the_sixth_above_the_line_spalls(chosen):
    found = outcome(few(chosen, 4))
    assert found.median_lift_db > 0.0
    assert found.keeps_envelope
    assert np.mean(found.strongest == SIXTH + 1) >= 0.75


def test_a_smooth_extended_spall_does_not():
    found = outcome(Profile("smooth", "", (extended_spall(4e-6, math.radians(1.0)),)))
    assert found.median_lift_db < -3.0
    assert found.sixth < 0.0
    assert found.envelope_ratio[0] > 1000.0  # the claim on G1 over G2


def test_waves_down_to_the_contact_s_width_take_the_envelope_with_them():
    rough = next(rough_profiles((0.4,), (8.0,), (4.0,)))
    found = outcome(few(rough, 2))
    assert found.median_lift_db > 0.0
    assert not found.keeps_envelope


def test_the_verdict_wants_eight_records_of_ten():
    profile = Profile("long", "waves", (reference_extended_spall(0),))
    above = np.full((10, 13), 2.0)
    assert Outcome(profile, above, np.full(10, 6), np.full(10, 3.0)).lifts
    above[:3, SIXTH] = -1.0
    weak = Outcome(profile, above, np.full(10, 6), np.append(np.full(9, 3.0), 0.9))
    assert not weak.lifts
    assert not weak.keeps_envelope
    assert answer([weak]).startswith("None does")


def test_sidebands_grow_in_proportion_to_the_deviation_of_the_balls():
    found = measure("line", (0.2, 1.0), draws=2).sixth()
    # 14 dB for five times the deviation; below lies the leakage of the window, above the bending of the springs.
    assert found[1] - found[0] == pytest.approx(14.0, abs=1.0)
    assert np.all(found[1] < -15.0)


def test_the_deviation_for_a_level_lies_on_the_line_through_those_that_were_measured():
    deviations = (0.1, 0.3, 1.0)
    level = np.broadcast_to(20.0 * np.log10(deviations)[:, None, None] - 20.0, (3, 2, 13))
    found = question2_unequal_balls.Sidebands(deviations, level, level)
    assert question2_unequal_balls.deviation_for(found, -26.0) == pytest.approx(10.0**-0.3)


def test_equal_balls_have_no_sidebands_and_slip_alone_fills_their_place():
    found = measure("extended", (0.0,), draws=1)
    assert found.sixth()[0, 0] < -60.0
    assert found.sixth(slipping=True)[0, 0] > -30.0


def test_drawn_balls_have_the_stated_deviation_and_the_nominal_mean():
    drawn = np.array(unequal(0.5, 3).ball_deviation)
    assert drawn.shape == (2, 12)
    assert np.std(drawn) == pytest.approx(0.5e-6)
    assert np.mean(drawn) == pytest.approx(0.0, abs=1e-18)
    assert machine_state("line", 0.0, 3, slip=False).imperfections.ball_deviation == ()


def test_slip_takes_lines_down_as_a_wandering_phase_does():
    slips, seeds = (0.0, 0.01), 6
    drop = measure_slip("gearbox", slips, seeds).drop(0.01)
    predicted = predicted_drop("gearbox", 0.01)
    # Six seeds scatter by 2 dB once a line is a sum over many correlation times.
    assert np.sqrt(np.mean((drop - predicted) ** 2)) < 2.0
    assert drop[0] > -1.0 > FADED > drop[-1] - 5.0


def test_the_predicted_drop_is_none_without_slip_and_falls_with_order_and_slip():
    assert predicted_drop("fan", 0.0) == pytest.approx(0.0, abs=1e-9)
    some, more = predicted_drop("fan", 0.005), predicted_drop("fan", 0.01)
    assert np.all(np.diff(some) < 0.0)
    assert np.all(more < some)


def test_a_small_wander_costs_half_the_mean_square_of_its_phase():
    """To first order the power lost is (k Nb)² times the variance of the angle about its weighted mean."""
    tiny = predicted_drop("gearbox", 1e-5)
    twice = predicted_drop("gearbox", 2e-5)
    assert twice / tiny == pytest.approx(4.0, rel=1e-3)
    assert tiny[9] / tiny[0] == pytest.approx(100.0, rel=1e-2)


def test_a_line_on_its_frequency_has_its_amplitude():
    time = np.arange(round(0.5 * RATE)) / RATE
    signal = 1.0 + 0.3 * np.cos(2.0 * np.pi * 100.0 * time)
    assert lines_at(signal, np.array([100.0, 140.0])) == pytest.approx([0.3, 0.0], abs=1e-6)


def test_the_first_faded_harmonic_is_the_first_10_db_down():
    assert faded(np.array([0.0, -9.9, -10.0, -30.0])) == 3
    assert math.isnan(faded(np.array([0.0, -1.0])))


def made_up_numbers():
    """Numbers in the shapes that the three questions' figures draw, not simulated."""
    generator = np.random.default_rng(0)
    others = (Profile("reference", REFERENCE, ()), Profile("smooth", SMOOTH, ()))
    searched = [*rough_profiles((1.0, 2.0), (4.0, 8.0), (4.0,)), *others]
    outcomes = [
        Outcome(one, generator.normal(2.0, 3.0, (10, 13)), np.full(10, 6), generator.uniform(0.5, 9.0, 10))
        for one in searched
    ]
    shape = (len(question2_unequal_balls.DEVIATIONS_UM), 5, 13)
    sidebands = {
        name: question2_unequal_balls.Sidebands(
            question2_unequal_balls.DEVIATIONS_UM,
            generator.normal(-30.0, 9.0, shape),
            generator.normal(-14.0, 1.0, shape),
        )
        for name in ("line", "extended")
    }
    slip = [
        question3_slip.Smearing(rig, {slip: np.exp(-slip * np.arange(20.0)) for slip in question3_slip.SLIPS})
        for rig in question3_slip.RIGS
    ]
    return outcomes, sidebands, slip


def test_the_figures_of_the_questions_have_their_panels():
    outcomes, sidebands, slip = made_up_numbers()
    with house_style():
        figures = (
            question1_extended_profiles.draw(outcomes),
            question2_unequal_balls.draw(sidebands, sidebands),
            question3_slip.draw(slip),
        )
    assert [len([a for a in one.axes if a.get_title(loc="left")]) for one in figures] == [5, 3, 4]


def test_the_tables_of_the_questions_have_a_row_for_every_case():
    outcomes, sidebands, slip = made_up_numbers()
    first = question1_extended_profiles.rows(outcomes)
    assert len([row for row in first if row.quantity.startswith("harmonics 3 to 13 over the line spall's: ")]) == 6
    second = question2_unequal_balls.rows(sidebands, sidebands)
    assert len([row for row in second if row.where]) == 2 * len(question2_unequal_balls.DEVIATIONS_UM)
    third = question3_slip.rows(slip)
    assert len(third) == 2 * 3 * (len(question3_slip.TABLED) + 1)


def answering(title, wave=2.0, deviation=8.0, sixth=6, ratio=3.0):
    """What a profile does that is 2 dB above the line spall, whose strongest harmonic and envelope are as given."""
    profile = Profile("long", title, (), 4.0, deviation, wave)
    return Outcome(profile, np.full((10, 13), 2.0), np.full(10, sixth), np.full(10, ratio))


def test_a_profile_answers_yes_only_if_it_does_both():
    assert not answering("elsewhere", sixth=5).lifts
    found = [
        answering(CHOSEN), answering("lifts", ratio=0.5), answering("lifts too", ratio=0.5),
        answering("keeps", sixth=5),
    ]  # fmt: skip
    assert "Of 4 profiles 3 lift the lines and 1 do so with the envelope's order kept" in answer(found)
    (yes,) = (row for row in question1_extended_profiles.rows(found) if row.quantity == "profiles that answer yes")
    assert (yes.ours, yes.unit) == (1.0, "of 4")


def test_each_draw_is_held_against_the_line_spall_under_the_same_slip(monkeypatch):
    level = {"simulated": lambda *_: (1.0, 2.0), "signal": lambda _: 5.0, "envelope_line": lambda found: found}
    for name, made in (level | {"harmonics": lambda found: np.full(13, found)}).items():
        monkeypatch.setattr(f"datagen.paper.profile_search.{name}", made)
    found = outcome(Profile("reference", "two", (reference_extended_spall(0),) * 2))
    assert found.above[:, 0].tolist() == [4.0, 3.0]
    assert found.envelope_ratio.tolist() == [0.2, 0.4]


def test_the_maps_of_the_waves_name_and_frame_each_profile_in_its_place():
    outcomes = [
        answering(CHOSEN, 2.0, 8.0), answering("b", 4.0, 8.0, ratio=0.5), answering("c", 2.0, 1.0, sixth=5),
        answering(REFERENCE, math.nan), answering(SMOOTH, math.nan),
    ]  # fmt: skip
    with house_style():
        axes = question1_extended_profiles.draw(outcomes).axes[2]
    assert [label.get_text() for label in axes.get_xticklabels()] == ["2", "4"]  # mm
    # 20 lg of the ratios of amplitudes 3 and 0.5, above the deviation of 1 µm and of 8 µm
    assert {text.get_position(): text.get_text() for text in axes.texts} == {
        (0, 1): "+10", (1, 1): "-6", (0, 0): "+10"
    }  # fmt: skip
    assert np.ma.filled(axes.images[0].get_array(), 0.0) == pytest.approx(
        np.array([[9.54, 0.0], [9.54, -6.02]]), abs=0.01
    )
    (frame,) = axes.patches
    assert (frame.get_x(), frame.get_y()) == (-0.46, 1.0 - 0.44)


def test_sidebands_are_seen_six_decibels_above_what_leaks(monkeypatch):
    monkeypatch.setattr(question2_unequal_balls, "strongest_of_all", lambda _: np.zeros(5))
    deviations = question2_unequal_balls.DEVIATIONS_UM
    levels = 20.0 * np.log10(deviations)[:, None, None] * np.ones((len(deviations), 5, 13))
    found = {"line": question2_unequal_balls.Sidebands(deviations, levels, levels)}
    floor = {"line": question2_unequal_balls.Sidebands((0.0,), np.full((1, 5, 13), -16.0), np.zeros((1, 5, 13)))}
    verdicts = [row.agrees for row in question2_unequal_balls.rows(found, floor) if row.agrees is not None]
    assert verdicts == [deviation > 10.0**-0.5 for deviation in deviations]  # -10 dB
    spread = np.array([-3.0, -2.0, 0.0, 4.0, 8.0])[:, None] + levels
    with house_style():
        figure = question2_unequal_balls.draw(
            {"line": question2_unequal_balls.Sidebands(deviations, spread, spread)}, floor
        )
    (curve,) = (line for line in figure.axes[0].lines if line.get_label() == "line, no slip")
    assert curve.get_ydata() == pytest.approx(20.0 * np.log10(deviations))


def test_drops_are_judged_and_drawn_beside_those_predicted_for_their_own_slip():
    heights = {slip: np.exp(100.0 * slip * (np.arange(20.0) < 10.0) - 100.0 * slip) for slip in question3_slip.SLIPS}
    smearing = question3_slip.Smearing("gearbox", heights)
    table = {row.quantity: row for row in question3_slip.rows([smearing])}
    title = "gearbox rig, slip 1.0%, harmonic {} over that without slip"
    assert [table[title.format(k)].agrees for k in (5, 10, 20)] == [False, False, True]
    drop = np.where(np.arange(20) < 10, 0.0, -20.0 / math.log(10.0))
    away = np.sqrt(np.mean((drop - predicted_drop("gearbox", 0.01)) ** 2))
    assert table["gearbox rig, slip 1.0%, RMS of measured less predicted"].ours == pytest.approx(away)
    with house_style():
        lines = question3_slip.draw([smearing] * 2).axes[0].lines
    for curve, dots in zip(lines[0:6:2], lines[1:6:2], strict=True):
        slip = float(dots.get_label().removeprefix("slip ").removesuffix("%")) / 100.0
        assert curve.get_ydata() == pytest.approx(predicted_drop("gearbox", slip))


@pytest.mark.slow
def test_the_chosen_profile_answers_yes_over_its_ten_draws(chosen):
    found = outcome(chosen)
    assert found.lifts
    assert found.keeps_envelope
