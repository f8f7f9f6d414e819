"""Combs of other shafts, on spectra of noise with lines at written places."""

import dataclasses

import numpy as np
import pytest

from labels.features.analysis import analyse
from labels.features.combs import without_combs
from labels.features.families import find_family
from labels.features.foreign_combs import foreign_combs
from labels.features.kinematics import bearing_kinematics
from labels.features.race_combs import race_combs

STEP, SHAFT, COUNT = 0.1, 30.0, 8000
BEARING = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, SHAFT)
BANDS = 7


def spectrum(*lines, height=40.0, seed=0):
    """Exponential noise (BANDS, COUNT) with `lines` (Hz) of that `height` over it in every band."""
    excess = np.random.default_rng(seed).exponential(size=(BANDS, COUNT))
    at = np.round(np.array(lines) / STEP).astype(int)
    excess[:, at[at < COUNT]] += height
    return excess


def combs(excess, step=STEP, doubt=0.0):
    """Rates (Hz) of the combs in a spectrum of which everything is readable."""
    return foreign_combs(excess, step, BEARING, np.ones(excess.shape[-1], dtype=bool), doubt)


def without(excess, step=STEP):
    return without_combs(excess, step, combs(excess, step), SHAFT)


def multiples(rate, count):
    return [k * rate for k in range(1, count + 1)]


@pytest.mark.parametrize("order", [0.173, 0.31, 0.55, 1.37, 2.13])
@pytest.mark.parametrize("seed", [1, 2])
def test_a_comb_is_found_at_its_rate_and_its_lines_are_set_to_the_floor(order, seed):
    rate = order * SHAFT
    excess = spectrum(*multiples(rate, 200), seed=seed)
    assert combs(excess) == pytest.approx([rate], abs=STEP / 10)
    left = without(excess)
    at = np.round(np.array([k * rate for k in range(1, 24)]) / STEP).astype(int)
    assert np.all(left[:, at[at < COUNT]] == 1.0)
    away = np.abs(np.arange(COUNT) * STEP / rate % 1.0 - 0.5) < 0.3
    assert np.array_equal(left[:, away], excess[:, away])


def test_a_line_close_beside_one_of_a_comb_is_left():
    rate, place = 0.31 * SHAFT, round(17 * 0.31 * SHAFT / STEP) + 5
    excess = spectrum(*multiples(rate, 200), place * STEP)
    assert combs(excess) == pytest.approx([rate], abs=STEP / 10)
    assert np.all(without(excess)[:, place] > 20.0)


def test_lines_of_a_comb_that_varies_are_taken_out_as_far_as_they_reach():
    rate = 1.37 * SHAFT
    away = np.abs(np.arange(COUNT) * STEP / rate - np.round(np.arange(COUNT) * STEP / rate)) * rate
    excess = spectrum() + 60.0 * np.exp(-0.5 * (away / (2.0 * STEP)) ** 2) * (np.arange(COUNT) * STEP > 0.5 * rate)
    assert combs(excess) == pytest.approx([rate], abs=STEP / 5)
    assert np.all(without(excess)[:, : round(8.5 * rate / STEP)].mean(axis=0) < 5.0)


def test_a_comb_whose_every_other_line_is_strong_is_told_by_all():
    rate = 0.31 * SHAFT
    excess = spectrum(*multiples(rate, 200), height=15.0)
    strong = np.round(np.array(multiples(2.0 * rate, 100)) / STEP).astype(int)
    excess[:, strong[strong < COUNT]] += 200.0
    assert combs(excess)[0] == pytest.approx(rate, abs=STEP / 10)


def test_no_part_of_a_comb_is_slower_than_what_is_looked_for():
    found = combs(spectrum(*multiples(0.115 * SHAFT, 250)))
    assert found[0] == pytest.approx(0.230 * SHAFT, abs=STEP / 10)
    assert min(found) > 0.12 * SHAFT


@pytest.mark.parametrize("missing", [(2, 3, 6, 10), (2, 3, 6, 10, 13)])
def test_of_sixteen_lines_a_comb_may_lack_four_and_not_five(missing):
    rate = 0.55 * SHAFT
    found = combs(spectrum(*(k * rate for k in range(1, 17) if k not in missing)))
    assert found == (pytest.approx([rate], abs=STEP / 10) if len(missing) == 4 else [])


def test_two_shafts_are_both_found():
    excess = spectrum(*multiples(0.31 * SHAFT, 200), *multiples(1.37 * SHAFT, 60))
    assert sorted(combs(excess)) == pytest.approx([0.31 * SHAFT, 1.37 * SHAFT], abs=STEP / 10)


def test_lines_that_were_taken_out_do_not_speak_against_a_comb():
    """Thirteen lines of a comb stand out of a spectrum that holds 19; the others lie where something was taken out."""
    rate = 1.37 * SHAFT
    excess = spectrum(*multiples(rate, 19))
    at = np.arange(COUNT) * STEP
    taken_out = np.zeros(COUNT, dtype=bool)
    for k in (1, 2, 3, 5, 6, 7):
        taken_out |= np.abs(at - k * rate) < 5.0 * STEP
    excess[:, taken_out] = 1.0
    assert foreign_combs(excess, STEP, BEARING, ~taken_out) == pytest.approx([rate], abs=STEP / 10)
    assert combs(excess) == []


def test_what_a_bearing_makes_at_another_speed_is_no_comb_where_the_speed_is_in_doubt():
    """The second harmonic of a shaft that turns 2 % faster than stated."""
    excess = spectrum(*multiples(2.04 * SHAFT, 12))
    assert combs(excess, doubt=0.022) == []
    assert combs(excess) == pytest.approx([2.04 * SHAFT], abs=STEP / 10)


@pytest.mark.parametrize("part", [3, 5, 8])
def test_no_comb_holds_every_line_of_a_shaft_whose_speed_is_in_doubt(part):
    """Every third, fifth or eighth line is one of a shaft that turns 2 % faster than stated."""
    rate = 1.02 * SHAFT / part
    excess = spectrum(*multiples(rate, 200))
    assert combs(excess) == pytest.approx([rate], abs=STEP / 10)
    turns = 1.02 * SHAFT / np.array(combs(excess, doubt=0.022))  # of the comb in one of the shaft
    assert np.all(np.abs(turns - np.round(turns)) > 0.1)


def test_the_six_lines_of_a_comb_that_a_short_spectrum_holds_do_not_speak_against_it():
    """They are a tenth of its components: lines that stood out by chance so often would be six in a row too likely."""
    known, step, count = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0), 1.0, 220
    excess, rate = np.ones((1, count)), 1.31 * 25.0
    for place in np.arange(1, 7) * rate:
        away = np.arange(count) - place
        excess[0] += 40.0 * np.where(np.abs(away) < 1.0, np.cos(0.5 * np.pi * away) ** 2, 0.0)
    found = foreign_combs(excess, step, known, np.ones(count, bool))
    assert found == pytest.approx([rate], rel=0.01)


@pytest.mark.parametrize("seed", range(5))
def test_noise_has_none(seed):
    assert combs(spectrum(seed=seed)) == []


def faulty(carrier, turns, cages):
    """Lines of a fault: harmonics 1 to 6 of the `carrier` (orders) with that many sidebands of shaft and cage."""
    beside = [j + k * BEARING.ftf for j in range(-turns, turns + 1) for k in range(-cages, cages + 1)]
    return [(i * carrier + away) * SHAFT for i in range(1, 7) for away in beside if i * carrier + away > 0.0]


@pytest.mark.parametrize(
    "lines",
    [
        faulty(BEARING.bpfo * 0.99, 2, 2),
        faulty(BEARING.bpfi * 1.01, 5, 1),
        faulty(2.0 * BEARING.ball_spin, 1, 3),
        # Here they fill a comb by chance, which only their being known as those of the fault shows.
        faulty(BEARING.bpfo * 1.0028, 2, 2),
        faulty(BEARING.bpfo * 1.0056, 2, 2),
        faulty(BEARING.bpfi * 0.9973, 5, 1),
        faulty(2.0 * BEARING.ball_spin * 1.0145, 1, 3),
        multiples(BEARING.ftf * SHAFT, 100),
        multiples((1.0 - BEARING.ftf) * SHAFT, 60),
        multiples(2.0 * BEARING.ftf * SHAFT, 40),
        multiples(SHAFT, 30),
        multiples(0.5 * SHAFT, 60),
        multiples(1.5 * SHAFT, 20),
        multiples(2.0 * SHAFT, 15),
    ],
    ids=[
        "outer race", "inner race", "ball", "outer race in fifths", "outer race in rows", "inner race in rows",
        "ball in rows", "cage over outer", "cage over inner", "cage twice a turn", "shaft", "half the shaft",
        "three halves of the shaft", "shaft twice a turn",
    ],
)  # fmt: skip
def test_what_a_bearing_makes_is_no_comb_of_another_shaft(lines):
    assert combs(spectrum(*lines)) == []


def test_a_comb_beside_a_fault_leaves_the_faults_lines():
    fault = faulty(BEARING.bpfo, 1, 0)
    excess = spectrum(*fault, *multiples(0.31 * SHAFT, 200))
    assert combs(excess) == pytest.approx([0.31 * SHAFT], abs=STEP / 10)
    carriers = np.round(np.array(multiples(BEARING.bpfo * SHAFT, 6)) / STEP).astype(int)
    assert np.count_nonzero(without(excess)[0, carriers] > 20.0) >= 4


def test_a_record_of_few_turns_tells_none():
    coarse = 0.15 * SHAFT
    excess = np.random.default_rng(0).exponential(size=(BANDS, 200))
    excess[:, ::15] += 40.0  # at multiples of 2.25 orders
    assert combs(excess, coarse) == []
    assert np.array_equal(without(excess, coarse), excess)


def test_a_spectrum_that_holds_only_rates_of_the_bearing_tells_none():
    """Between four components and a fifth of the spectrum lie 0.39 to 0.41 orders, which are of the cage."""
    excess = np.random.default_rng(0).exponential(size=(BANDS, 24))
    assert combs(excess, 0.0975 * SHAFT) == []


def test_families_are_looked_for_without_the_combs_of_other_shafts(impulse_train):
    order = 0.55
    found = analyse(impulse_train(order, duration=6.0, shaft_hz=SHAFT, snr_db=-3.0), 20_000.0, BEARING)
    whole = find_family(found.all_envelope_lines, order * SHAFT, 0.01, SHAFT, 0.01)
    assert whole.evidence.max() > 100.0
    assert found.envelope_family(order).evidence.max() < 5.0


@pytest.mark.parametrize("order", [1.04 * BEARING.bpfo / 2.0, 1.04 * BEARING.ftf * 2.0])
def test_a_comb_beside_what_a_bearing_makes_is_taken_out_once_the_speed_is_found(order, impulse_train):
    """It lies within what the stated speed leaves open, so it does not move the speed, which the shaft's lines tell."""
    signal = impulse_train(order, duration=6.0, shaft_hz=SHAFT, snr_db=-3.0)
    turned = 2.0 * np.pi * SHAFT * np.arange(signal.size) / 20_000.0
    lines = sum(np.sin(multiple * turned) for multiple in (1, 2, 3))
    found = analyse(signal + signal.std() * lines, 20_000.0, BEARING)
    assert found.speed.shaft_hz == pytest.approx(SHAFT, rel=1e-4)
    assert find_family(found.all_envelope_lines, order * SHAFT, 0.01, SHAFT, 0.01).evidence.max() > 100.0
    assert found.envelope_family(order).evidence.max() < 5.0


def race(excess):
    return race_combs(excess, STEP, BEARING, np.ones(excess.shape[-1], dtype=bool))


@pytest.mark.parametrize(("order", "part"), [("bpfo", 4), ("bpfo", 5), ("bpfi", 4), ("bpfi", 8)])
def test_a_comb_of_which_some_lines_pass_for_those_of_a_race_is_told(order, part):
    rate = getattr(BEARING, order) * SHAFT / part
    found = race(spectrum(*multiples(rate, 24)))
    assert found[0] == pytest.approx(rate, abs=STEP / 10)
    # Some of its lines may pass for those of the other race too.
    assert np.ptp(found) < STEP / 10


@pytest.mark.parametrize(
    "lines",
    [
        faulty(BEARING.bpfo * 0.99, 2, 2),
        faulty(BEARING.bpfi * 1.01, 5, 1),
        multiples(0.5 * BEARING.bpfo * SHAFT, 30),
        multiples(0.5 * BEARING.bpfi * SHAFT, 30),
        multiples(BEARING.ftf * SHAFT, 100),
        multiples((1.0 - BEARING.ftf) * SHAFT, 60),
        multiples(0.5 * SHAFT, 60),
        faulty(BEARING.bpfo, 0, 0) + multiples(0.31 * SHAFT, 8),
    ],
    ids=[
        "outer race", "inner race", "half of BPFO", "half of BPFI", "cage over outer", "cage over inner",
        "half the shaft", "a slower comb that fades before the second line of the race",
    ],
)  # fmt: skip
def test_what_a_bearing_makes_is_no_part_of_a_slower_comb(lines):
    assert race(spectrum(*lines)) == []


def test_a_comb_is_told_by_the_lines_before_it_fades():
    """Trains whose intervals vary keep their lowest lines only: here three that pass for those of a race, of six."""
    rate = BEARING.bpfo * SHAFT / 4
    found = race(spectrum(*multiples(rate, 13)))
    assert found[0] == pytest.approx(rate, abs=STEP / 10)
    assert np.ptp(found) < STEP / 10  # six pass for one of BPFI too


def test_lines_half_as_high_between_those_of_a_race_are_no_comb():
    rate = BEARING.bpfo * SHAFT / 3
    excess = spectrum(*multiples(rate, 24), height=8.0)
    own = np.round(np.array(multiples(3 * rate, 7)) / STEP).astype(int)
    excess[:, own] += 40.0
    assert race(excess) == []


def test_knocks_that_pass_for_a_race_at_a_wrong_speed_move_no_nominal_speed(impulse_train):
    """Every fourth knock comes when a ball would pass the inner race of a shaft 4 % faster than the nominal one."""
    nominal = dataclasses.replace(BEARING, speed_within=0.05)
    order = 1.04 * nominal.bpfi / 4.0
    found = analyse(impulse_train(order, duration=2.0, shaft_hz=SHAFT, snr_db=0.0), 20_000.0, nominal)
    assert found.speed.shaft_hz == pytest.approx(SHAFT, rel=0.003)
    assert found.race_family(found.envelope_lines, "inner").evidence.max() < 8.0
