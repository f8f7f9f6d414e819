"""What the passing balls say of the speed of the shaft."""

from dataclasses import replace

import numpy as np
import pytest

from labels.features.analysis import analyse
from labels.features.envelopes import EnvelopeSpectra
from labels.features.kinematics import MEASURED_WITHIN, NOMINAL_WITHIN, Kinematics, bearing_kinematics
from labels.features.lines import lines_in
from labels.features.speed import Speed, families_term, refine_speed, sharpened, unambiguous_harmonics

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)


@pytest.mark.parametrize(("race", "share"), [("bpfo", 1.015), ("bpfo", 0.985), ("bpfi", 1.015)])
def test_the_likeliest_speed_is_the_one_at_which_the_cage_does_not_slip(impulse_train, race, share):
    signal = impulse_train(getattr(KNOWN, race), shaft_hz=25.0 * share, duration=2.0, snr_db=10.0)
    factors = np.linspace(0.978, 1.022, 89)
    term = families_term(analyse(signal, 20_000.0, KNOWN).envelopes, KNOWN, factors)
    # The third harmonic is read to a component of 0.5 Hz: 0.2 % of 270 Hz.
    assert factors[term.argmax()] == pytest.approx(share, abs=0.004)


@pytest.mark.parametrize("share", [1.0, 0.9912, 1.0137])
def test_a_shaft_that_knocks_tells_its_speed_to_a_component_of_the_highest_harmonic(impulse_train, share):
    """Seven turns a second over 10 s: of harmonic 47, up to which the envelope is read, a component is 0.03 %."""
    known = bearing_kinematics(19, 180e-3, 24e-3, np.radians(10.0), 7.0)
    signal = impulse_train(1.0, rate=10_240.0, duration=10.0, shaft_hz=7.0 * share, snr_db=3.0)
    found = analyse(signal, 10_240.0, known).speed.shaft_hz
    assert found == pytest.approx(7.0 * share, rel=3e-4)


@pytest.mark.parametrize("share", [0.955, 1.0, 1.035])
def test_a_nominal_speed_may_be_off_by_the_slip_of_a_motor_and_a_measured_one_may_not(impulse_train, share):
    signal = impulse_train(1.0, duration=2.0, shaft_hz=25.0 * share, snr_db=3.0)
    nominal = replace(KNOWN, speed_within=NOMINAL_WITHIN)
    assert analyse(signal, 20_000.0, nominal).speed.shaft_hz == pytest.approx(25.0 * share, rel=1e-3)
    assert analyse(signal, 20_000.0, KNOWN).speed.shaft_hz == pytest.approx(25.0, rel=1.001 * MEASURED_WITHIN)


@pytest.mark.parametrize(("order", "moves"), [(1.001, True), (12.012, False)])
def test_many_harmonics_move_the_speed_and_one_family_of_lines_does_not(impulse_train, order, moves):
    """A knock once a turn of a shaft 0.1 % faster than thought, and what knocks at 12 times that."""
    found = analyse(impulse_train(order, duration=8.0, snr_db=10.0), 20_000.0, KNOWN)
    turning = lines_in(found.envelopes.excess[:1], found.envelopes.step)
    factor = sharpened(found.vibration_with_shaft[0], turning, KNOWN, 1.0, 0.002)
    assert factor == (pytest.approx(1.001, abs=2e-4) if moves else 1.0)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("knocks_hz", [41.0, 27.0])
def test_knocks_of_another_shaft_do_not_move_the_speed(impulse_train, knocks_hz, seed):
    """Five times 41 Hz is six turns, six times 41 Hz BPFO without slip, of a shaft 2 to 4 % faster than stated."""
    known = bearing_kinematics(16, 71.5e-3, 8.407e-3, np.radians(15.17), 2000.0 / 60.0)
    order = knocks_hz / known.shaft_hz
    signal = impulse_train(order, duration=1.0, shaft_hz=known.shaft_hz, snr_db=0.0, seed=seed)
    assert analyse(signal, 20_000.0, known).speed.shaft_hz == pytest.approx(known.shaft_hz, rel=3e-3)


# 6203: BPFO 3.05 and BPFI 4.95; UER204: BPFI 4.93; ZA-2115: BPFO 7.09 orders of the shaft.
NEAR_WHOLE_ORDERS = {
    "bpfo of a 6203": (bearing_kinematics(8, 28.499e-3, 6.746e-3, 0.0, 29.95), "bpfo"),
    "bpfi of a 6203": (bearing_kinematics(8, 28.499e-3, 6.746e-3, 0.0, 29.95), "bpfi"),
    "bpfi of a UER204": (bearing_kinematics(8, 34.55e-3, 7.92e-3, 0.0, 35.0), "bpfi"),
    "bpfo of a ZA-2115": (bearing_kinematics(16, 71.5e-3, 8.407e-3, np.radians(15.17), 33.3), "bpfo"),
}


@pytest.mark.parametrize("within", [MEASURED_WITHIN, NOMINAL_WITHIN])
@pytest.mark.parametrize("case", NEAR_WHOLE_ORDERS)
def test_lines_of_a_race_near_a_multiple_of_the_shaft_are_not_taken_for_it(impulse_train, case, within):
    """Taken for harmonics of the shaft they would be left out of the envelope, and a clear spall would go unseen."""
    bearing, race = NEAR_WHOLE_ORDERS[case]
    known = replace(bearing, speed_within=within)
    signal = impulse_train(getattr(known, race), duration=5.0, shaft_hz=known.shaft_hz, snr_db=3.0)
    found = analyse(signal, 20_000.0, known)
    assert found.speed.shaft_hz == pytest.approx(known.shaft_hz, rel=3e-3)
    family = found.outer if race == "bpfo" else found.inner
    assert family.evidence.max() > 25.0  # nats; noise alone gives a family a few


# BPFI 4.95, 4.93 and 8.91 orders of the shaft.
NEAR_WHOLE_BPFI = {
    "6203": bearing_kinematics(8, 28.499e-3, 6.746e-3, 0.0, 15.0),
    "UER204": bearing_kinematics(8, 34.55e-3, 7.92e-3, 0.0, 37.5),
    "ZA-2115": bearing_kinematics(16, 71.5e-3, 8.407e-3, np.radians(15.17), 33.3),
}


@pytest.mark.parametrize("slip", [0.0, 0.004, 0.008])
@pytest.mark.parametrize("within", [MEASURED_WITHIN, NOMINAL_WITHIN])
@pytest.mark.parametrize("bearing", NEAR_WHOLE_BPFI)
def test_sidebands_of_an_inner_race_near_a_multiple_of_the_shaft_are_not_taken_for_it(
    impulse_train, bearing, within, slip
):
    """The load zone sets lines beside BPFI, a turn apart. Where they lie close to multiples of the shaft, the shaft was
    found where all of them were its multiples, and left out of the envelope."""
    known = replace(NEAR_WHOLE_BPFI[bearing], speed_within=within)
    order = (1.0 - slip) * known.bpfi
    signal = impulse_train(order, duration=4.0, shaft_hz=known.shaft_hz, snr_db=3.0, modulation=1.0)
    found = analyse(signal, 20_000.0, known)
    assert found.speed.shaft_hz == pytest.approx(known.shaft_hz, rel=4e-3)
    assert found.inner.evidence.max() > 25.0


def test_harmonics_that_a_line_of_a_race_may_lie_on_tell_no_speed():
    known = NEAR_WHOLE_ORDERS["bpfo of a 6203"][0]
    # 3 and 6 lie 1.7 % below one and two BPFO, 5 1.1 % above BPFI, 4 and 6 as far above BPFI a turn less and more.
    assert np.flatnonzero(unambiguous_harmonics(known)).tolist() == [0, 1, 6, 7]


@pytest.mark.parametrize(("within", "hidden"), [(MEASURED_WITHIN, [5, 6, 7]), (NOMINAL_WITHIN, [4, 5, 6, 7, 8])])
def test_the_less_a_speed_is_known_the_more_harmonics_a_line_of_a_race_may_lie_on(within, hidden):
    # BPFO 3.8 and BPFI 6.2: 5, 6 and 7 lie 0.2 below BPFI and what is a turn beside it, which slip moves by 0.17 and a
    # speed 2.2 % off by 0.11 to 0.16; 4 and 8 lie 5.3 % above one and two BPFO.
    known = Kinematics(10, 0.24, 2.3, 25.0, within)
    assert (known.bpfo, known.bpfi) == pytest.approx((3.8, 6.2))
    assert (1 + np.flatnonzero(~unambiguous_harmonics(known))).tolist() == hidden


def test_the_evidence_of_a_speed_is_that_of_the_shafts_harmonics_at_it():
    """Lines at 1 to 8 times 25.2 Hz, of which 7 may be one of two BPFO = 7.17, in a spectrum of 0.1 Hz a component."""
    excess, quiet = np.ones((1, 8000)), np.ones((1, 8000))
    excess[0, 252 * np.arange(1, 9)] = 40.0
    envelopes = EnvelopeSpectra(0.1, quiet, quiet, np.zeros(1), np.array([[0.0, 1.0]]))
    found = refine_speed(lines_in(excess, 0.1), envelopes, KNOWN)
    nats = 27.0 - 1.0 - np.log(27.0)  # over 1.5 components a mean of (40 + 0.5) / 1.5
    assert found.shaft_hz == pytest.approx(25.2, rel=1e-6)
    assert found.evidence == pytest.approx(7.0 * 12.0 * np.log1p(nats / 12.0), rel=1e-6)
    assert found.of_others == pytest.approx(6.0 / 7.0 * found.evidence, rel=1e-6)
    none = pytest.approx(0.0, abs=1e-20)
    assert refine_speed(lines_in(quiet, 0.1), envelopes, KNOWN) == Speed(25.0, none, none)


@pytest.mark.parametrize(("mains", "stated"), [(60.0, 29.4), (50.0, 24.6), (49.97, 24.6)])
def test_hum_does_not_draw_the_speed_of_a_motor_to_the_synchronous_one(mains, stated):
    """Twice and four times the synchronous speed of a motor of two pairs of poles, and the hum's third harmonic."""
    hum = [(k * mains, height) for k, height in ((1, 1.0), (2, 0.5), (3, 0.3))]
    assert speed_found(hum, replace(KNOWN, shaft_hz=stated)) == stated


@pytest.mark.parametrize("shaft_hz", [24.5, 24.3])
def test_hum_does_not_hold_a_nominal_speed_at_the_synchronous_one(shaft_hz):
    """A motor of nominally 1500 rpm that turns a little slower, and higher hum at even multiples of 25 Hz."""
    hum = [(50.0 * k, 1.0) for k in range(1, 5)]
    lines = [*hum, *((k * shaft_hz, 0.3) for k in range(1, 5))]
    found = speed_found(lines, replace(KNOWN, speed_within=NOMINAL_WITHIN))
    assert found == pytest.approx(shaft_hz, abs=0.05)  # the fourth harmonic, to a component of 0.25 Hz


@pytest.mark.parametrize("shaft_hz", [25.05, 24.95, 30.03])
@pytest.mark.parametrize("off", [0.03, -0.03])
def test_a_shaft_that_turns_near_the_synchronous_speed_is_found(shaft_hz, off):
    """Its even harmonics count as the mains' up to the eighth, of which the third to fifth speak for another speed."""
    lines = [(k * shaft_hz, 1.0 / k) for k in range(1, 9)]
    known = replace(KNOWN, shaft_hz=shaft_hz * (1.0 + off), speed_within=NOMINAL_WITHIN)
    assert speed_found(lines, known) == pytest.approx(shaft_hz, rel=1e-3)


def speed_found(lines, known):
    """The speed (Hz) that is found in 4 s of lines at these frequencies (Hz) and amplitudes, in noise of RMS 1."""
    time = np.arange(80_000) / 20_000.0
    signal = sum(height * np.sin(2.0 * np.pi * hertz * time) for hertz, height in lines)
    return analyse(signal + np.random.default_rng(3).standard_normal(time.size), 20_000.0, known).speed.shaft_hz


@pytest.mark.parametrize(
    ("within", "heights", "moves"),
    [
        (NOMINAL_WITHIN, [14.0], False),
        (NOMINAL_WITHIN, [30.0], True),
        (MEASURED_WITHIN, [30.0], False),
        (MEASURED_WITHIN, [14.0, 20.0], True),
        (MEASURED_WITHIN, [9.0, 20.0], False),
    ],
)
def test_the_less_a_speed_is_known_the_more_a_line_has_to_stand_out_to_move_it(within, heights, moves):
    """Harmonics of 25.2 Hz, of height 9, 14 or 30 and 2.5, 5.1 or 10.3 nats: chance has 3 among speeds within 2.2 %,
    and 6.8 among those within 5 %. A measured speed is not moved by the highest alone.

    Over 1.5 components the mean is r = (height + 0.5) / 1.5; of r − 1 − ln r nats what exceeds 12 counts by its
    logarithm.
    """
    excess, quiet = np.ones((1, 8000)), np.ones((1, 8000))
    excess[0, 252 * np.arange(1, len(heights) + 1)] = heights
    envelopes = EnvelopeSpectra(0.1, quiet, quiet, np.zeros(1), np.array([[0.0, 1.0]]))
    found = refine_speed(lines_in(excess, 0.1), envelopes, replace(KNOWN, speed_within=within)).shaft_hz
    assert found == (pytest.approx(25.2, abs=0.05) if moves else 25.0)  # half a component


def test_many_lines_tell_the_speed_and_not_the_highest_few():
    """Sixteen lines of a shaft 0.2 % faster, and three of what turns 0.2 % slower, a million times as high."""
    excess, quiet = np.ones((1, 16_000)), lines_in(np.ones((1, 16_000)), 0.05)
    excess[0, 501 * np.arange(1, 17)] = 13.0
    excess[0, 499 * np.array([29, 30, 31])] = 1e7
    assert sharpened(lines_in(excess, 0.05), quiet, KNOWN, 1.0, 0.004) == pytest.approx(1.002, abs=1e-4)


def test_a_family_is_looked_for_as_far_off_as_a_wrong_speed_and_slip_move_it_together(impulse_train):
    signal = impulse_train(1.034 * KNOWN.bpfo, duration=2.0, snr_db=10.0)
    factors = np.linspace(0.978, 1.022, 89)
    term = families_term(analyse(signal, 20_000.0, KNOWN).envelopes, KNOWN, factors)
    # At the fastest speed the cage is 1.2 % off: 1.7 deviations of 0.7 %.
    assert factors[term.argmax()] == 1.022
    assert term.max() == pytest.approx(-0.5 * (0.012 / 0.007) ** 2, abs=0.6)  # as read to a component
