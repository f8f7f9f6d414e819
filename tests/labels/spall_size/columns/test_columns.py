"""Columns of pairs by name, on a mean pass whose energy, waveform, sway and displacement are known everywhere."""

import math
from dataclasses import replace

import numpy as np
import pytest

from labels.spall_size.columns.choice import measure as choose
from labels.spall_size.columns.table import (
    LEADING_COLUMNS,
    LEADING_COLUMNS_WITH_LOAD,
    PAIR_COLUMNS,
    ROW_COLUMNS,
    ROW_COLUMNS_WITH_LOAD,
    leading_rows,
    pair_rows,
)
from labels.spall_size.estimation.measurement import measure
from labels.spall_size.events.evidence import Evidence
from labels.spall_size.events.leading import LEADING, leading_view
from labels.spall_size.events.pairs import Pairs, RecordFacts, all_pairs
from labels.spall_size.signal.alignment import Alignment
from labels.spall_size.signal.mean_pass import MeanPass
from labels.spall_size.situation import Situation

PERIOD, ENTRY, EXIT, LAG = 400.0, -80.0, 0.0, 80.0
FACTS = RecordFacts(1.5, True, 0.7, 2.5, -3.0)
# Twelve balls of 8 mm on a 40 mm circle under 500 N.
BLIND = Situation(12, 1, 40e-3, 8e-3, 100.0)
LOADED = Situation(12, 1, 40e-3, 8e-3, 100.0, load=500.0, load_deflection=1e10)


def rumble(phase, first, last, energy):
    """The energy between two places, both included, and 1 elsewhere."""
    return np.where((phase >= first) & (phase <= last), energy, 1.0)


def known_pass():
    """Steps at the entry, 80 samples before the anchor, and at the exit, which is the anchor.

    Energy is 100 between them as a whole, 10 over the first half in the low band, 1000 over the second in the high one.
    The waveform is 3 at the entry and −3 one sample behind the exit, the sway 1 between the events and −0.5 elsewhere,
    the displacement a hundredth of the place.
    """
    offset = np.arange(-440, 441)
    phase = (offset + 0.5 * PERIOD) % PERIOD - 0.5 * PERIOD
    channels = [(ENTRY, EXIT, 100.0), (ENTRY, -40.0, 10.0), (1e9, 1e9, 1.0), (-40.0, EXIT, 1000.0)]
    energy = np.array([rumble(phase, *channel) for channel in channels])
    wave = 3.0 * (phase == ENTRY) - 3.0 * (phase == EXIT + 1.0)
    sway = np.where((phase >= ENTRY) & (phase < EXIT), 1.0, -0.5)
    return MeanPass(offset, energy, wave, sway, 2.0, offset / 100.0, 3.0, 50.0, PERIOD)


@pytest.fixture(scope="module")
def columns():
    """Every column of the pair of both events by name."""
    view = all_pairs(known_pass(), np.array([ENTRY, EXIT]), FACTS)
    assert view.lag.tolist() == [PERIOD - LAG, LAG]  # the other one takes the exit for the entry
    return dict(zip(PAIR_COLUMNS, pair_rows(view)[1], strict=True))


# A core reaches 5 % of the lag to either side: 9 samples, 5 of them in the rumble, which are (5·E + 4)/9 on average.
CORE, LOW_CORE, HIGH_CORE = 504.0 / 9.0, 54.0 / 9.0, 5004.0 / 9.0
# The core of a shape reaches 1.5 samples: 2.5 of 4 lie in the rumble.
SHARP_CORE = (2.5 * 100.0 + 1.5) / 4.0
# Of seven samples round an edge four lie in the rumble.
SEVEN = (4.0 * 100.0 + 3.0) / 7.0


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("period", math.log(400.0)),
        ("lag", math.log(80.0)),
        ("lag_share", 0.2),
        ("passes", math.log(50.0)),
        ("score", 1.5),
        ("inner", 1.0),
        ("peakedness", 0.7),
        ("predictability", 2.5),
        ("noise", -3.0),
        ("candidates", 2.0),
        ("entry_core_all", math.log(CORE)),
        ("exit_core_all", math.log(CORE)),
        ("entry_core_middle", 0.0),
        ("entry_before_all", 0.0),  # from half a lag off up to the core
        ("entry_after_all", math.log(100.0)),
        ("exit_before_all", math.log(100.0)),
        ("exit_after_all", 0.0),
        ("exit_before_low", math.log(45.0 / 36.0)),  # of the 36 samples up to the core the furthest lies in the rumble
        ("entry_after_high", math.log(1035.0 / 36.0)),
        ("entry_just_before_all", 0.0),  # 2 to 6 samples off
        ("entry_just_after_low", math.log(10.0)),
        ("exit_just_before_high", math.log(1000.0)),
        ("exit_just_after_high", 0.0),
        ("exit_over_entry_low", -math.log(LOW_CORE)),
        ("exit_over_entry_high", math.log(HIGH_CORE)),
        ("entry_is_anchor", 0.0),
        ("exit_is_anchor", 1.0),
        ("inside", math.log(100.0 / CORE)),
        ("outside", -math.log(CORE)),
        ("alike", -1.0),  # upside down and a sample late
        ("entry_coherence", math.log(9.0 / 7.0) - math.log(SEVEN)),
        ("sway_inside", 1.0),
        ("sway_after", -0.5),
        ("give_at_entry", -0.8),
        ("give_inside", -0.4),
        ("give_at_exit", 0.0),
        ("entry_core", math.log(SHARP_CORE / 100.0)),
        ("entry_before_12", -math.log(SHARP_CORE)),
        ("entry_after_12", math.log(100.0 / SHARP_CORE)),
        ("exit_before_0.1_periods", math.log(100.0 / SHARP_CORE)),  # 12 to 40 samples off
        ("exit_after_0.1_periods", -math.log(SHARP_CORE)),
        ("entry_low_step_12", math.log(10.0)),
        ("exit_low_step_12", 0.0),
        ("entry_wave_sign", 3.0 / math.sqrt(SEVEN)),
        ("exit_wave_sign", -3.0 / math.sqrt(SEVEN)),
    ],
)
def test_a_column_says_what_its_name_says(columns, name, expected):
    assert columns[name] == pytest.approx(expected, abs=1e-6)


def test_a_step_of_the_sway_slopes_by_its_height_over_the_blur_that_hides_it(columns):
    # A unit step under a Gaussian of 2 samples rises by 1/√(2π)/2 a sample at its middle, and 1.5 times that here. The
    # step lies half a sample before the place; a difference over two samples sees 4 % less of it.
    assert columns["entry_sway_slope_2"] / (2.0 + 4.0) == pytest.approx(1.5 / math.sqrt(2.0 * math.pi) / 2.0, rel=0.08)
    assert columns["exit_sway_slope_2"] == pytest.approx(-columns["entry_sway_slope_2"], rel=1e-6)
    # A quarter of a deviation up from the step.
    assert columns["entry_sway_level_2"] == pytest.approx(0.25 + 1.5 * 0.4 * 0.25, abs=0.03)


def pair_of(mean, entry, leave):
    """Every column by name of the pair of an event at `entry` and one at `leave`."""
    view = all_pairs(mean, np.array([entry, leave]), FACTS)
    return dict(zip(PAIR_COLUMNS, pair_rows(view)[view.entry.tolist().index(entry)], strict=True))


# Middles of windows, samples from an event 100 samples beside the other one.
LEVELS = {
    "core_all": 0.0, "before_all": -28.0, "after_middle": 28.0, "just_before_low": -4.0, "just_after_high": 4.0,
}  # fmt: skip
OVER_CORE = {"3": 2.2, "6": 4.5, "12": 9.0, "24": 18.0, "48": 36.0, "96": 72.0, "0.1_periods": 26.0,
             "0.25_periods": 70.0}  # fmt: skip


@pytest.mark.parametrize(("event", "place"), [("entry", -100.0), ("exit", 0.0)])
def test_every_window_lies_where_its_name_says(event, place):
    """On energy that grows evenly from sample to sample the mean tells where the middle of a window lies."""
    growing = replace(known_pass(), energy=1000.0 + np.arange(-440.0, 441.0) * np.ones((4, 1)))
    row, core = pair_of(growing, -100.0, 0.0), 1000.0 + place
    found = {name: math.exp(row[f"{event}_{name}"]) - core for name in LEVELS}
    assert found == pytest.approx(LEVELS, abs=1e-5)
    for side, sign in (("before", -1.0), ("after", 1.0)):
        found = {name: sign * core * math.expm1(row[f"{event}_{side}_{name}"]) for name in OVER_CORE}
        assert found == pytest.approx(OVER_CORE, abs=1e-5)
    for reach, middle in ((3, 2.0), (12, 6.5), (48, 24.5)):
        assert row[f"{event}_low_step_{reach}"] == pytest.approx(math.log((core + middle) / (core - middle)))


def test_beside_events_side_by_side_a_window_reaches_two_samples_beyond_the_core():
    growing = replace(known_pass(), energy=1000.0 + np.arange(-440.0, 441.0) * np.ones((4, 1)))
    # Half a lag would be two samples; the core reaches one, and a sample lies between.
    assert math.exp(pair_of(growing, -4.0, 0.0)["exit_before_all"]) == pytest.approx(1000.0 - 2.5)


def test_what_else_there_is_is_told_over_the_weaker_event():
    known = known_pass()
    energy = np.ones((4, known.offset.size))
    for place, height in ((-80, 1000.0), (320, 1000.0), (0, 50.0), (400, 50.0), (-40, 7.0), (200, 9.0), (-200, 9.0)):
        energy[:, np.abs(known.offset - place) < 2] = height
    wave = 1.0 * (known.offset == -80) - 2.0 * (known.offset == 0)
    row = pair_of(replace(known, energy=energy, waveform=wave), -80.0, 0.0)
    weaker = math.log((3.0 * 50.0 + 6.0) / 9.0)
    assert (row["inside"], row["outside"]) == pytest.approx((math.log(7.0) - weaker, math.log(9.0) - weaker))
    # Of seven samples round an event three hold its energy.
    expected = [math.log(1.0 / 3004.0), math.log(4.0 / 154.0)]
    assert [row["entry_coherence"], row["exit_coherence"]] == pytest.approx(expected)


def test_what_lies_beyond_the_end_of_the_mean_pass_is_looked_for_a_period_earlier():
    known = known_pass()
    energy = np.ones((4, known.offset.size))
    energy[:, known.offset == 70] = 9.0  # 470 is beyond the last offset, 440
    row = pair_of(replace(known, energy=energy), 100.0, 180.0)
    assert row["outside"] == pytest.approx(math.log(9.0))


def test_between_events_side_by_side_there_is_nothing():
    known = replace(known_pass(), energy=np.ones((4, 881)))
    assert pair_of(known, -3.0, 0.0)["inside"] == pytest.approx(-9.0)


@pytest.mark.parametrize(
    ("entry", "leave", "alike"),
    [
        ({0: 1.0}, {2: 1.0}, 1.0),
        ({0: 1.0}, {3: 1.0}, 0.0),
        ({0: 1.0, 7: 1.0}, {0: 1.0, -7: 1.0}, 0.5),
        ({0: 1.0, 2: 1.0}, {0: -1.0, 2: -1.0}, -1.0),
    ],
)
def test_waves_are_compared_over_eight_samples_shifted_by_up_to_two(entry, leave, alike):
    known = known_pass()
    wave = np.zeros(known.offset.size)
    for place, heights in ((-100, entry), (0, leave)):
        for away, height in heights.items():
            wave[known.offset == place + away] = height
    row = pair_of(replace(known, waveform=wave), -100.0, 0.0)
    assert row["alike"] == pytest.approx(alike, abs=1e-9)


def test_sway_is_averaged_up_to_half_a_lag_behind_the_exit_and_up_to_the_next_entry_at_most():
    known = known_pass()
    turn = 2.0 * math.pi / PERIOD
    wave = np.sin(turn * (known.offset + 0.5))  # a running sum counts a sample from its place to the next
    swaying = replace(known, sway=wave, give=np.sin(turn * known.offset))

    def mean(first, last):
        return (math.cos(turn * first) - math.cos(turn * last)) / turn / (last - first)

    short, long, late = pair_of(swaying, -30.0, 30.0), pair_of(swaying, -150.0, 150.0), pair_of(swaying, 150.0, 50.0)
    assert short["sway_after"] == pytest.approx(mean(30.0, 60.0), abs=1e-3)
    assert long["sway_after"] == pytest.approx(mean(150.0, 250.0), abs=1e-3)  # where 1.5 lags would reach to 300
    assert late["sway_after"] == pytest.approx(mean(450.0, 550.0), abs=1e-3)
    places = [late["give_at_entry"], late["give_inside"], late["give_at_exit"]]
    assert places == pytest.approx([math.sin(turn * place) for place in (150.0, 300.0, 450.0)], abs=1e-9)


def test_no_pass_in_effect_counts_as_one():
    assert pair_of(replace(known_pass(), passes=0.0), ENTRY, EXIT)["passes"] == 0.0


def test_the_core_of_an_event_is_three_samples_at_least():
    known = known_pass()
    sharp = np.where(np.isin(known.offset, [-10, 0]), 301.0, 1.0) * np.ones((4, 1))
    row = pair_of(replace(known, energy=sharp), -10.0, 0.0)
    assert (row["entry_core_all"], row["exit_core_low"]) == pytest.approx((math.log(101.0), math.log(101.0)))


def test_pairs_of_an_event_with_itself_a_pass_later_are_none():
    # Places 6 samples apart: the way round is 394 of 400 samples, more than 0.97 periods.
    view = all_pairs(known_pass(), np.array([-6.0, 0.0, 100.0]), FACTS)
    assert sorted(view.lag.tolist()) == [6.0, 100.0, 106.0, 294.0, 300.0]


def evidence(features, lag, race="inner"):
    """Evidence of pairs that all end at the anchor, beside the known mean pass."""
    lag = np.asarray(lag, dtype=float)
    nothing = np.zeros(0)
    return Evidence(race, 65536.0, 4.0, 0.5, Alignment(nothing, nothing),
                    known_pass(), Pairs(-lag, np.zeros(lag.size), lag, features))  # fmt: skip


def leading(situation, lag, score, features=None):
    """Every column of the leading pairs by name."""
    known = np.zeros((len(lag), len(PAIR_COLUMNS))) if features is None else features
    rows = leading_rows(leading_view(evidence(known, lag), np.array(score), situation))
    names = LEADING_COLUMNS_WITH_LOAD if situation.load_known else LEADING_COLUMNS
    return dict(zip(names, rows.T, strict=True))


def test_profiles_run_through_the_steps():
    found = leading(BLIND, [LAG], [1.0])
    # The windows end 4 and 1.6 samples before the event, 1.6 behind it, and 8 and 13.6.
    assert found["entry_all_-0.05_to_-0.02"] == pytest.approx([0.0], abs=1e-6)
    assert found["entry_all_-0.02_to_0.02"] == pytest.approx([math.log((2.6 * 100.0 + 1.6) / 4.2)], abs=1e-6)
    assert found["entry_all_0.1_to_0.17"] == pytest.approx([math.log(100.0)], abs=1e-6)
    assert found["entry_low_0.1_to_0.17"] == pytest.approx([math.log(10.0)], abs=1e-6)
    assert found["exit_high_-0.17_to_-0.1"] == pytest.approx([math.log(1000.0)], abs=1e-6)
    assert found["exit_high_0.1_to_0.17"] == pytest.approx([0.0], abs=1e-6)


def test_windows_of_a_profile_grow_with_the_lag_of_their_own_pair_and_are_a_sample_wide_at_least():
    found = leading(BLIND, [LAG, 200.0, 10.0], [1.0, 0.5, 0.2])
    # Of 31 samples from 100 to 70 before the exit eleven lie in the rumble; of one pair all, and so of the other.
    expected = [math.log(100.0), math.log((11.0 * 100.0 + 20.0) / 31.0), math.log(100.0)]
    assert found["exit_all_-0.5_to_-0.35"] == pytest.approx(expected, abs=1e-6)
    # From 0.5 before the exit to 0.5 behind it, and the sample there: 1.5 of them, of two, half a sample behind.
    assert found["exit_all_-0.02_to_0.02"][2] == pytest.approx(math.log((1.5 * 100.0 + 0.5) / 2.0), abs=1e-6)


def test_rivals_are_the_best_pairs_that_say_something_else():
    # Of the four lags 100 and 102 say the same (within 3 %), and so only the first of them leads.
    found = leading(BLIND, [100.0, 102.0, 50.0, 130.0], [0.8, 0.6, 0.4, 0.2])
    assert found["own_score"].tolist() == [0.8, 0.4, 0.2]
    assert found["place"].tolist() == [0.0, 1.0, 2.0]
    assert found["behind_first"] == pytest.approx([0.0, -0.4, -0.6])
    assert found["rival_1_score"].tolist() == [0.4, 0.8, 0.8]
    assert found["rival_1_apart"] == pytest.approx(np.log([0.5, 2.0, 100.0 / 130.0]))
    assert found["rival_2_score"].tolist() == [0.2, 0.6, 0.6]
    assert found["rival_3_score"].tolist() == [0.0, 0.2, 0.4]  # to the first pair only two are rivals
    # Within a factor of 1.35 of 100 lie 102 and 130, their weights the squares of the scores; of 50 only itself.
    near = (0.36 * math.log(1.02) + 0.04 * math.log(1.3)) / (0.64 + 0.36 + 0.04)
    assert found["near_apart"][:2] == pytest.approx([near, 0.0])


def test_lags_within_3_per_cent_are_the_same_and_within_35_may_mean_the_same_events():
    found = leading(BLIND, [100.0, 105.0, 145.0, 90.0], [0.8, 0.6, 0.4, -0.5])
    rivals = [found[f"rival_{k}_score"][0] for k in (1, 2, 3)]
    assert rivals == [0.6, 0.4, -0.5]
    # 145 lies farther off, and a pair of a score below 0 says nothing.
    assert found["near_apart"][0] == pytest.approx(0.36 * math.log(1.05) / (0.64 + 0.36))


def test_of_rivals_of_equal_scores_those_that_were_paired_first_are_told():
    # The last pair leads, and every third of the 99 before it, from the second on, comes next.
    lag, score = 5.0 * 1.04 ** np.arange(100), np.append(np.tile([0.1, 0.5, 0.3], 33), 0.9)
    found = leading(BLIND, lag, score)
    apart = [found[f"rival_{k}_apart"][0] for k in (1, 2, 3)]
    assert apart == pytest.approx(-math.log(1.04) * np.array([98.0, 95.0, 92.0]))


@pytest.mark.parametrize(("rank", "middle"), [((0.05, 0.0), 0.0), ((0.0, 0.0), 0.5 * math.log(1.1))])
def test_ranks_weigh_by_their_squares_and_alike_where_all_are_nothing(rank, middle):
    found = choose(np.array([100.0, 110.0]), np.array(rank))
    assert found["ranked_near_apart"] == pytest.approx(middle, abs=1e-6)


def test_a_pair_knows_how_long_its_spall_would_be():
    found = leading(BLIND, [LAG], [1.0])
    arc = LAG / PERIOD * 2.0 * math.pi / 12.0  # a fifth of a ball spacing
    assert found["lag_arc"] == pytest.approx([math.log(arc)])
    assert found["length_in_balls"] == pytest.approx([math.log(arc * 16e-3 / 8e-3)])  # the inner race's radius is 16 mm


def test_what_is_known_of_all_pairs_goes_with_the_leading_ones():
    features = np.arange(3.0)[:, None] + np.zeros(len(PAIR_COLUMNS))
    assert leading(BLIND, [50.0, 100.0, 200.0], [0.1, 0.9, 0.5], features)["noise"].tolist() == [1.0, 2.0, 0.0]


def test_load_tells_what_size_of_jump_to_expect():
    features = np.zeros((1, len(PAIR_COLUMNS)))
    features[0, PAIR_COLUMNS.index("entry_core_all")] = math.log(4.0)
    features[0, PAIR_COLUMNS.index("exit_core_all")] = math.log(9.0)
    found = leading(LOADED, [LAG], [1.0], features)
    # Vibration 4 m/s², sway 2, prewhitened 0.5 a unit: jumps of twice and three times that, and of 10 at the largest.
    for name, size in (("deviation", 4.0), ("sway", 2.0), ("entry_jump", 1.0), ("exit_jump", 1.5)):
        assert found[f"{name}_over_load"] == pytest.approx([math.log(size / 500.0)])
    assert found["largest_jump_over_load"] == pytest.approx([math.log(5.0 / 500.0)])
    # The most loaded of twelve balls carries 4.37 twelfths of the load [Stribeck, exponent 1.5]; a spall 0.91 of it.
    pressed = 0.91 * (4.37 / 12.0 * 500.0 / 1e10) ** (2.0 / 3.0)
    assert found["pressed"] == pytest.approx([math.log(pressed / 4e-3)], abs=0.01)
    assert found["give_over_pressed"] == pytest.approx([math.log(3.0 / 65536.0**2 / pressed)], abs=0.01)
    assert np.expm1(found["released"]) == pytest.approx(np.exp(found["release"]))
    # Half of that arc of the inner race, of 16 mm radius, and a ball of 4 mm has dropped by what it was pressed.
    half = float(np.exp(found["release"][0])) * LAG / PERIOD * math.pi / 12.0
    lever = 16e-3 * math.sin(half)
    drop = 4e-3 - math.sqrt(4e-3**2 - lever**2) + 16e-3 * (1.0 - math.cos(half))
    assert drop == pytest.approx(pressed, rel=0.01)


def test_the_chosen_pair_is_that_of_the_best_rank_and_knows_the_others():
    lag = [100.0, 110.0, 50.0]
    given = leading_view(evidence(np.zeros((3, len(PAIR_COLUMNS))), lag), np.array([0.9, 0.8, 0.7]), BLIND)
    chosen = measure(given, leading_rows(given), np.array([0.4, 0.5, 0.2]))
    found = dict(zip(ROW_COLUMNS, chosen.row, strict=True))
    assert (chosen.entry, chosen.exit, chosen.lag) == (-110.0, 0.0, 110.0)
    assert chosen.lag_arc == pytest.approx(110.0 / PERIOD * 2.0 * math.pi / 12.0)
    assert found["own_score"] == 0.8
    assert (found["rank"], found["rival_rank"]) == (0.5, 0.4)
    away = math.log(100.0 / 110.0)
    assert found["rival_apart"] == pytest.approx(away)
    # 50 lies further off than a factor of 1.35, so two lags remain, their weights the squares of the ranks.
    middle = 0.16 * away / 0.41
    assert found["ranked_near_apart"] == pytest.approx(middle)
    spread = math.sqrt((0.25 * middle**2 + 0.16 * (away - middle) ** 2) / 0.41)
    assert found["ranked_near_spread"] == pytest.approx(spread)
    assert [found[f"rank_{k}"] for k in (1, 2, 3, 4, LEADING)] == [0.5, 0.4, 0.2, 0.0, 0.0]
    assert [found[f"apart_{k}"] for k in (1, 2, 3, 4)] == pytest.approx([0.0, away, math.log(50.0 / 110.0), 0.0])


def test_a_pair_without_rival_has_a_rank_below_all_others():
    given = leading_view(evidence(np.zeros((1, len(PAIR_COLUMNS))), [LAG]), np.array([0.9]), LOADED)
    chosen = measure(given, leading_rows(given), np.array([0.4]))
    found = dict(zip(ROW_COLUMNS_WITH_LOAD, chosen.row, strict=True))
    assert (found["rival_rank"], found["rival_apart"]) == (-1.0, 0.0)


@pytest.mark.parametrize("names", [ROW_COLUMNS, ROW_COLUMNS_WITH_LOAD])
def test_no_two_columns_share_a_name(names):
    assert len(set(names)) == len(names)


def test_rows_hold_their_columns_in_the_order_of_the_table():
    view = leading_view(evidence(np.ones((1, len(PAIR_COLUMNS))), [LAG]), np.array([0.25]), LOADED)
    row = leading_rows(view)[0]
    assert row.size == len(LEADING_COLUMNS_WITH_LOAD)
    assert row[: len(PAIR_COLUMNS)].tolist() == [1.0] * len(PAIR_COLUMNS)
    assert row[LEADING_COLUMNS.index("own_score")] == 0.25
    assert row[LEADING_COLUMNS_WITH_LOAD.index("deviation_over_load")] == pytest.approx(math.log(4.0 / 500.0))


@pytest.mark.parametrize(("half", "lags"), [(193.5, [13.0, 387.0]), (194.5, [11.0])])
def test_the_lag_of_two_events_is_below_0_97_periods(half, lags):
    # That is 388 of the 400 samples of a period; the other way round the rest of it is the lag.
    assert sorted(all_pairs(known_pass(), np.array([-half, half]), FACTS).lag.tolist()) == lags
