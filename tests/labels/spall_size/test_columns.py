"""Columns of pairs by name, on a mean pass whose energy, waveform, sway and displacement are known everywhere."""

import math

import numpy as np
import pytest

from labels.spall_size.columns.choice import LEADING
from labels.spall_size.columns.table import (
    LEADING_COLUMNS,
    LEADING_COLUMNS_WITH_LOAD,
    PAIR_COLUMNS,
    ROW_COLUMNS,
    ROW_COLUMNS_WITH_LOAD,
    leading_rows,
    pair_rows,
)
from labels.spall_size.estimation.measurement import leading_pairs, measure
from labels.spall_size.events.evidence import Evidence
from labels.spall_size.events.leading import LeadingView
from labels.spall_size.events.pairs import Pairs, RecordFacts, all_pairs
from labels.spall_size.signal.alignment import Alignment
from labels.spall_size.signal.mean_pass import MeanPass
from labels.spall_size.signal.pass_track import PassTrack
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


def test_pairs_of_an_event_with_itself_a_pass_later_are_none():
    # Places 6 samples apart: the way round is 394 of 400 samples, more than 0.97 periods.
    view = all_pairs(known_pass(), np.array([-6.0, 0.0, 100.0]), FACTS)
    assert sorted(view.lag.tolist()) == [6.0, 100.0, 106.0, 294.0, 300.0]


def evidence(features, lag, race="inner"):
    """Evidence of pairs that all end at the anchor, beside the known mean pass."""
    lag = np.asarray(lag, dtype=float)
    nothing = np.zeros(0)
    return Evidence(race, 65536.0, 4.0, 0.5, PassTrack(nothing, 1.0, nothing, 1.5), Alignment(nothing, nothing),
                    known_pass(), Pairs(-lag, np.zeros(lag.size), lag, features))  # fmt: skip


def leading(situation, lag, score, features=None):
    """Every column of the leading pairs by name."""
    known = np.zeros((len(lag), len(PAIR_COLUMNS))) if features is None else features
    rows = leading_pairs(evidence(known, lag), np.array(score), situation).rows
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


def test_the_chosen_pair_is_that_of_the_best_rank_and_knows_the_others():
    lag = [100.0, 110.0, 50.0]
    given = leading_pairs(evidence(np.zeros((3, len(PAIR_COLUMNS))), lag), np.array([0.9, 0.8, 0.7]), BLIND)
    chosen = measure(given, np.array([0.4, 0.5, 0.2]))
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
    given = leading_pairs(evidence(np.zeros((1, len(PAIR_COLUMNS))), [LAG]), np.array([0.9]), LOADED)
    found = dict(zip(ROW_COLUMNS_WITH_LOAD, measure(given, np.array([0.4])).row, strict=True))
    assert (found["rival_rank"], found["rival_apart"]) == (-1.0, 0.0)


@pytest.mark.parametrize("names", [ROW_COLUMNS, ROW_COLUMNS_WITH_LOAD])
def test_no_two_columns_share_a_name(names):
    assert len(set(names)) == len(names)


def test_rows_hold_their_columns_in_the_order_of_the_table():
    view = LeadingView(evidence(np.ones((1, len(PAIR_COLUMNS))), [LAG]), np.array([0.25]), LOADED, np.array([0]))
    row = leading_rows(view)[0]
    assert row.size == len(LEADING_COLUMNS_WITH_LOAD)
    assert row[: len(PAIR_COLUMNS)].tolist() == [1.0] * len(PAIR_COLUMNS)
    assert row[LEADING_COLUMNS.index("own_score")] == 0.25
    assert row[LEADING_COLUMNS_WITH_LOAD.index("deviation_over_load")] == pytest.approx(math.log(4.0 / 500.0))
