"""Where the lines of a race may lie, and what of a record is looked at."""

import math
from dataclasses import replace

import numpy as np
import pytest

from labels.features.analysis import DECOYS, Analysis, analyse
from labels.features.families import Family
from labels.features.kinematics import NOMINAL_WITHIN, bearing_kinematics
from labels.features.lines import Lines, lines_in
from labels.features.turning import Turning

RATE, SHAFT = 20_000.0, 25.0
# Of a bearing's own orders, at which harmonics of one family pass for another's.
RATIOS = (1 / 2, 2 / 3, 1, 3 / 2, 2)
KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, SHAFT)


def noise(loud: float) -> Analysis:
    """Two seconds of noise and, as loud as stated, harmonics of the shaft, which show its speed."""
    turn = 2.0 * np.pi * SHAFT * np.arange(40_000) / RATE
    shaft = loud * sum(np.cos(k * turn + k) for k in (1, 2, 4, 5, 6, 8))
    return analyse(np.random.default_rng(0).standard_normal(turn.size) + shaft, RATE, KNOWN)


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_the_lines_of_a_race_may_lie_where_slip_and_a_contact_angle_move_them(race):
    centre, tolerance = noise(0.5).race_window(race)
    low, high = (centre * (1.0 + side * tolerance) / (KNOWN.pass_order(race) * SHAFT) for side in (-1.0, 1.0))
    tilted = bearing_kinematics(9, 39.04e-3, 7.94e-3, math.radians(15.0), SHAFT)
    # A slipping cage passes fewer balls over the outer race and more over the inner one; a tilt does the opposite.
    slipping = 0.98 if race == "outer" else 1.015
    for moved in (1.0, slipping, tilted.pass_order(race) / KNOWN.pass_order(race)):
        assert low < moved < high
    assert not low < 2.0 - slipping < high


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_where_no_line_of_the_shaft_shows_its_speed_they_may_lie_as_far_off_to_both_sides(race):
    centre, tolerance = noise(0.0).race_window(race)
    # Slip and a speed that is 2 % off, as labels say it may be.
    assert tolerance > max(0.02, noise(0.5).race_window(race)[1])
    assert centre == pytest.approx(KNOWN.pass_order(race) * noise(0.0).speed.shaft_hz)


def standing(lines: Lines, places: list[float]) -> list[float]:
    """The mean excess at the `places` (Hz) in the widest band, over a component to both sides."""
    return lines.means(np.array(places)[:, None], np.full(len(places), 1.5 * lines.step))[:, 0, 0].tolist()


def of_shaft(shaft_hz: float, duration: float) -> np.ndarray:
    """Harmonics of the shaft, which show its speed."""
    turn = 2.0 * np.pi * shaft_hz * np.arange(int(RATE * duration)) / RATE
    return np.asarray(sum(np.cos(k * turn + k) for k in (1, 2, 4, 5, 6, 8)))


def test_lines_of_the_shaft_are_left_out_at_the_speed_that_was_found(impulse_train):
    turns_at = 1.01 * SHAFT  # 101 turns in 4 s, so that each line is one component
    signal = impulse_train(1.0, duration=4.0, shaft_hz=turns_at, snr_db=3.0) + of_shaft(turns_at, 4.0)
    found = analyse(signal, RATE, KNOWN)
    assert found.kinematics == KNOWN.at(found.speed.shaft_hz)
    assert found.speed.shaft_hz == pytest.approx(turns_at, rel=1e-3)
    multiples = [k * turns_at for k in (4, 5, 6, 8)]
    assert min(standing(found.all_envelope_lines, multiples)) > 20.0
    assert max(standing(found.envelope_lines, multiples)) < 3.0
    assert min(standing(found.vibration_with_shaft[0], multiples)) > 20.0
    assert max(standing(found.vibration, multiples)) < 3.0


@pytest.mark.parametrize("followed", [False, True])
def test_mains_are_left_out_where_they_are_lines_and_what_lies_there_at_a_changing_speed_is_not(followed):
    """Noise that swells 100 times a second, or 100 times in 24 turns of a shaft that makes 24 in the mean."""
    time = np.arange(80_000) / RATE
    angle = 2.0 * np.pi * (18.0 * time + 1.5 * time**2)
    swells = angle * 100.0 / 24.0 if followed else 2.0 * np.pi * 100.0 * time
    signal = (1.0 + 0.8 * np.cos(swells)) * np.random.default_rng(2).standard_normal(time.size)
    found = analyse(signal, RATE, KNOWN.at(24.0), turning=Turning(angle) if followed else None)
    assert standing(found.all_envelope_lines, [100.0])[0] > 20.0
    assert (standing(found.envelope_lines, [100.0])[0] > 20.0) == followed


def test_combs_of_another_shaft_are_left_out_at_a_speed_that_is_as_stated(impulse_train):
    signal = impulse_train(2.13, duration=4.0, snr_db=0.0) + of_shaft(SHAFT, 4.0)
    found = analyse(signal, RATE, KNOWN)
    assert found.speed.shaft_hz == pytest.approx(SHAFT, rel=1e-3)
    assert min(standing(found.all_envelope_lines, [2.13 * SHAFT * k for k in (1, 2, 3)])) > 15.0
    assert max(standing(found.envelope_lines, [2.13 * SHAFT * k for k in (1, 2, 3)])) < 3.0


def test_a_comb_of_a_quarter_of_bpfo_is_no_fault_of_sixteen_balls(impulse_train):
    """Four turns of the cage pass for it, which no comb of another shaft may; one of the race is looked for apart."""
    known = bearing_kinematics(16, 71.5e-3, 8.407e-3, math.radians(15.17), SHAFT)
    comb, fault = (
        analyse(impulse_train(order, duration=4.0, snr_db=0.0) + of_shaft(SHAFT, 4.0), RATE, known)
        for order in (known.bpfo / 4.0, known.bpfo)
    )
    assert comb.outer.evidence.max() < 8.0 < 50.0 < fault.outer.evidence.max()


@pytest.mark.parametrize("share", [0.96, 1.04])
def test_a_fault_at_a_speed_far_from_the_nominal_one_is_no_comb_of_another_shaft(impulse_train, share):
    nominal, turns_at = replace(KNOWN, speed_within=NOMINAL_WITHIN), share * SHAFT
    signal = impulse_train(KNOWN.bpfo, duration=4.0, shaft_hz=turns_at, snr_db=0.0) + of_shaft(turns_at, 4.0)
    assert analyse(signal, RATE, nominal).outer.evidence.max() > 100.0


def test_a_family_of_a_race_pays_for_the_places_searched_and_for_the_slip_that_it_takes():
    found, step = noise(0.5), 0.1
    centre, tolerance = found.race_window("outer")
    excess = np.ones((1, 8000))
    excess[0, np.round(1.015 * centre * np.arange(1, 5) / step).astype(int)] = 40.0
    family = found.race_family(lines_in(excess, step), "outer")
    off = family.fundamental[0] / centre - 1.0
    assert off == pytest.approx(0.015, abs=1e-3)
    # Four harmonics, a component each; slip usually moves a family by 1.2 %.
    price = math.log(2.0 * tolerance * centre * 4.0 / step) + 0.5 * (off / 0.012) ** 2
    assert family.evidence[0] == pytest.approx(family.parts[0].sum() - price, rel=1e-9)


@pytest.mark.parametrize(
    "known",
    [
        KNOWN,
        bearing_kinematics(16, 71.5e-3, 8.407e-3, math.radians(15.17), SHAFT),
        bearing_kinematics(8, 28.499e-3, 6.746e-3, 0.0, SHAFT),
        bearing_kinematics(19, 180e-3, 24e-3, math.radians(10.0), SHAFT),
    ],
)
def test_decoys_are_the_strongest_families_in_any_band_far_from_what_a_bearing_makes(known, monkeypatch):
    asked = []

    def listening(analysis, order):
        asked.append(order)
        return Family(np.array([1.0, order, 2.0]), np.zeros((3, 4)), np.zeros(3))

    monkeypatch.setattr(Analysis, "envelope_family", listening)
    found = analyse(np.random.default_rng(0).standard_normal(20_000), RATE, known).decoys
    assert found.tolist() == [max(order, 2.0) for order in asked]
    made = [part * share for part in (known.bpfo, known.bpfi, 2.0 * known.ball_spin) for share in RATIOS]
    free = [order for order in DECOYS if all(abs(order / one - 1.0) >= 0.05 for one in made)]
    assert asked == free[:8]
    assert len(free) < len(DECOYS)
