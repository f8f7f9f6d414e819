"""Release arcs from load and geometry, against the closed forms and the worked example of the model."""

import math

import numpy as np
import pytest

from labels.spall_size.situation import PLACEHOLDER_FACTOR, Situation
from labels.spall_size.static_release import (
    USUAL_SHARE_OF_PEAK,
    arc_with_static_release,
    release_arc,
    static_compression,
)
from physics import catalog
from physics.checks import InvalidParameter

GEARBOX = catalog.rig("gearbox").bearing


def test_the_compression_follows_from_stribecks_peak_load():
    # 346 N over 24 balls: 63.0 N on the most loaded one [P14 Eq. 24], 5.3 µm with K = 5157 MN/m^1.5.
    assert static_compression(GEARBOX, 346.0) / USUAL_SHARE_OF_PEAK == pytest.approx(5.3e-6, rel=0.005)


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_a_ball_released_at_the_release_arc_has_dropped_by_its_compression(race):
    arc, radius, ball = release_arc(GEARBOX, race, 346.0), GEARBOX.raceway_radius(race), GEARBOX.ball_radius
    turn = -1.0 if race == "outer" else 1.0
    lever = radius * math.sin(arc)
    drop = ball - math.sqrt(ball**2 - lever**2) + turn * radius * (1.0 - math.cos(arc))
    assert drop == pytest.approx(static_compression(GEARBOX, 346.0), rel=1e-6)


def test_the_spall_of_the_models_example_shows_0_47_of_itself():
    # 0.8 mm on the gearbox rig's outer race under 5.3 µm of compression: the time between the events is 0.47 of it.
    extent = 0.8e-3 / GEARBOX.raceway_radius("outer")
    full = release_arc(GEARBOX, "outer", 346.0 / USUAL_SHARE_OF_PEAK**1.5)
    assert (extent - 2.0 * full) / extent == pytest.approx(0.47, abs=0.01)


def test_more_load_means_a_longer_spall_for_the_same_lag():
    arcs = [arc_with_static_release(0.05, GEARBOX, "inner", load) for load in (50.0, 346.0, 1700.0)]
    assert np.all(np.diff(arcs) > 0.0)
    assert min(arcs) > 0.05


def test_a_situation_gives_both_races_unless_the_race_is_known():
    known = {"balls": 12, "rows": 2, "pitch_diameter": 38.75e-3, "ball_diameter": 7.12e-3, "shaft_speed": 44.0}
    both = Situation(**known).pass_periods()
    assert both["outer"] == pytest.approx(1.0 / 34.283, rel=2e-3)  # BPFO of the gearbox rig at 7 Hz (43.98 rad/s)
    assert set(both) == {"outer", "inner"}
    assert set(Situation(**known, race="inner").pass_periods()) == {"inner"}
    assert not Situation(**known, load=300.0).load_known
    assert Situation(**known, load=300.0, load_deflection=5e9).load_known


def test_a_situation_has_the_contact_angle_and_the_exponent_that_are_stated():
    # The ZA-2115 of IMS: 236.4 and 296.9 Hz are published at 2000 rpm.
    tilted = Situation(16, 1, 71.5e-3, 8.407e-3, 2000.0 / 60.0 * 2.0 * math.pi, math.radians(15.17))
    assert [1.0 / period for period in tilted.pass_periods().values()] == pytest.approx([236.4, 296.9], abs=0.05)
    rollers = Situation(16, 1, 71.5e-3, 8.407e-3, 209.0, load=300.0, load_deflection=1e9, exponent=10.0 / 9.0)
    assert rollers.bearing().exponent == 10.0 / 9.0
    assert rollers.without_load().exponent == 1.5  # that of balls, where nothing is known


@pytest.mark.parametrize("factor", [0.0, -5e9, math.nan])
def test_a_hertz_factor_is_above_0_or_unknown(factor):
    known = {"balls": 12, "rows": 2, "pitch_diameter": 38.75e-3, "ball_diameter": 7.12e-3, "shaft_speed": 44.0}
    with pytest.raises(InvalidParameter, match="load_deflection"):
        Situation(**known, load=300.0, load_deflection=factor)
    assert Situation(**known).bearing().load_deflection == PLACEHOLDER_FACTOR


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_a_spall_is_longer_than_its_events_are_apart_by_a_release_arc_at_either_edge(race):
    # A sharp spall whose ball is released one release arc behind the entry and loaded again one before the exit.
    entry, exit_ = 0.1, 0.25
    release = entry + release_arc(GEARBOX, race, 346.0)
    regain = exit_ - release_arc(GEARBOX, race, 346.0)
    assert arc_with_static_release(regain - release, GEARBOX, race, 346.0) == pytest.approx(exit_ - entry)


def test_no_load_is_negative():
    with pytest.raises(InvalidParameter, match="load"):
        Situation(12, 2, 38.75e-3, 7.12e-3, 44.0, load=-1.0)


def test_a_bearing_without_load_has_no_release_arc_to_be_computed():
    known = {"balls": 12, "rows": 2, "pitch_diameter": 38.75e-3, "ball_diameter": 7.12e-3, "shaft_speed": 44.0}
    assert not Situation(**known, load=0.0, load_deflection=5e9).load_known


def test_the_usual_share_of_the_peak_is_the_mean_cosine_of_where_spalls_lie():
    # The mean cosine of an angle spread normally by 25 degrees is exp(-spread² / 2).
    assert pytest.approx(math.exp(-0.5 * math.radians(25.0) ** 2), abs=0.005) == USUAL_SHARE_OF_PEAK  # two digits
