"""Signals seen at even angles of a shaft whose speed changes."""

import numpy as np
import pytest

from labels.features.analysis import analyse
from labels.features.conditioning import condition
from labels.features.kinematics import bearing_kinematics
from labels.features.orders import measure as measure_orders
from labels.features.turning import Turning

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 20.0)
RATE, DURATION = 20_000.0, 4.0
TIME = np.arange(int(RATE * DURATION)) / RATE


def speeding(start, stop):
    """Angle (T,), rad, of a shaft whose speed goes evenly from one number of turns a second to another."""
    return 2.0 * np.pi * (start * TIME + 0.5 * (stop - start) * TIME**2 / DURATION)


def impacts(order, angle, seed=0):
    """A tone that rings at every `order`-th of a turn, in as much noise again ten times over (−10 dB)."""
    generator = np.random.default_rng(seed)
    passes = np.arange(0.3, angle[-1] / (2.0 * np.pi) * order)
    force = np.zeros(TIME.size)
    force[(np.interp(passes * 2.0 * np.pi / order, angle, TIME) * RATE).astype(int)] = 1.0
    ringing = np.exp(-900.0 * TIME[:200]) * np.sin(2.0 * np.pi * 2200.0 * TIME[:200])
    signal = np.convolve(force, ringing)[: TIME.size]
    return signal / signal.std() + np.sqrt(10.0) * generator.standard_normal(TIME.size)


@pytest.mark.parametrize(("start", "stop"), [(20.0, 20.0), (14.0, 26.0), (26.0, 14.0), (30.0, 10.0)])
def test_an_order_of_a_changing_speed_becomes_a_single_component(start, stop):
    angle = speeding(start, stop)
    signal = 0.7 * np.cos(3.0 * angle + 0.4)
    seen = Turning(angle).evenly(np.fft.rfft(signal), signal.size, 600)
    amplitude = 2.0 * np.abs(np.fft.rfft(seen * (1.0 - np.cos(2.0 * np.pi * np.arange(seen.size) / seen.size))))
    amplitude /= seen.size
    # 80 turns in the record, so order 3 is component 240; the window leaves its neighbours half as high.
    assert Turning(angle).revolutions == pytest.approx(80.0, rel=1e-6)
    assert amplitude[240] == pytest.approx(0.7, rel=0.01)  # as the ends do not meet, the spline errs there
    assert np.delete(amplitude[:600], [239, 240, 241]).max() < 0.02


@pytest.mark.parametrize(("race", "other"), [("outer", "inner"), ("inner", "outer")])
@pytest.mark.parametrize(("start", "stop"), [(14.0, 26.0), (24.0, 16.0)])
def test_the_race_is_heard_at_a_changing_speed_and_only_with_the_angle(race, other, start, stop):
    angle = speeding(start, stop)
    signal = impacts(KNOWN.bpfo if race == "outer" else KNOWN.bpfi, angle)
    followed, unfollowed = analyse(signal, RATE, KNOWN, turning=Turning(angle)), analyse(signal, RATE, KNOWN)
    assert getattr(followed, race).evidence.max() > 100.0  # noise alone has a few nats
    assert getattr(followed, race).evidence.max() > 2.0 * getattr(followed, other).evidence.max()
    assert getattr(followed, race).evidence.max() > 5.0 * getattr(unfollowed, race).evidence.max()


@pytest.mark.parametrize(("start", "stop"), [(14.0, 26.0), (24.0, 16.0)])
def test_noise_and_mains_have_no_family_at_a_changing_speed(start, stop):
    hum = 1.0 + 0.8 * np.cos(2.0 * np.pi * 100.0 * TIME)
    signal = hum * np.random.default_rng(3).standard_normal(TIME.size)
    found = analyse(signal, RATE, KNOWN, turning=Turning(speeding(start, stop)))
    assert max(found.outer.evidence.max(), found.inner.evidence.max()) < 10.0


def test_an_even_speed_is_heard_alike_with_and_without_its_angle():
    shaft = sum(np.cos(k * speeding(20.0, 20.0) + k) for k in (1, 2, 3, 4))
    signal = impacts(KNOWN.bpfo, speeding(20.0, 20.0)) + 0.3 * shaft
    followed, unfollowed = (
        analyse(signal, RATE, KNOWN, turning=Turning(speeding(20.0, 20.0))),
        analyse(signal, RATE, KNOWN),
    )
    # Where it is not followed, the speed is found to a few parts in ten thousand, and the line with it.
    assert np.log1p(followed.outer.evidence.max()) == pytest.approx(np.log1p(unfollowed.outer.evidence.max()), abs=0.2)
    followed_orders, unfollowed_orders = measure_orders(followed), measure_orders(unfollowed)
    assert followed_orders["shaft_evidence"] == pytest.approx(unfollowed_orders["shaft_evidence"], rel=0.05)
    assert followed_orders["shaft_velocity"] == pytest.approx(unfollowed_orders["shaft_velocity"], abs=0.02)


def test_lines_of_the_shaft_are_found_at_a_changing_speed_and_the_mean_speed_is_exact():
    angle = speeding(14.0, 26.0)
    signal = sum(np.cos(k * angle + k) for k in (1, 2, 3)) + np.random.default_rng(1).standard_normal(TIME.size)
    followed = analyse(signal, RATE, KNOWN.at(19.7), turning=Turning(angle))
    assert followed.speed.shaft_hz == pytest.approx(20.0, rel=1e-6)
    assert followed.speed.evidence > 20.0
    assert measure_orders(followed)["shaft_velocity"] > np.log10(0.9)
    assert measure_orders(analyse(signal, RATE, KNOWN))["shaft_velocity"] < np.log10(0.3)


@pytest.mark.parametrize("begin", [0.0, 1000.0])
def test_a_few_samples_at_an_even_speed_are_seen_where_they_are(begin):
    """A hundred samples of five turns and of the third harmonic of these: one sample is 15 % of its period."""
    turn = 2.0 * np.pi * 5.0 * np.arange(100) / 100
    turning = Turning(begin + turn)
    seen = turning.evenly(np.fft.rfft(np.cos(3.0 * turn + 0.4)), 100, 20)
    assert turning.revolutions == pytest.approx(5.0, rel=1e-9)
    # The spline runs between ten samples a period or more: its error is a part in a thousand.
    assert seen == pytest.approx(np.cos(6.0 * np.pi * 5.0 * np.arange(seen.size) / seen.size + 0.4), abs=3e-3)


@pytest.mark.parametrize(
    "angle", [[0.0, 1.0, 0.9, 2.0], [0.0, 1.0, 1.0, 2.0], [0.0], [0.0, np.nan, 2.0], [[0.0, 1.0], [0.0, 1.0]]]
)
def test_a_shaft_that_turns_back_or_stands_still_has_no_turning(angle):
    with pytest.raises(ValueError, match="has to grow"):
        Turning(np.array(angle))


def test_no_line_moves_a_speed_that_is_known_by_its_angle():
    """What another shaft, 1.5 % faster, does: harmonics as loud as those of the shaft that is followed would be."""
    other = sum(np.cos(k * 1.015 * speeding(20.0, 20.0) + k) for k in (1, 2, 3, 4, 6, 8))
    signal = other + 0.3 * np.random.default_rng(1).standard_normal(TIME.size)
    followed, unfollowed = (
        analyse(signal, RATE, KNOWN, turning=turning) for turning in (Turning(speeding(20.0, 20.0)), None)
    )
    assert unfollowed.speed.shaft_hz == pytest.approx(20.3, rel=1e-3)
    assert followed.speed.shaft_hz == pytest.approx(20.0, rel=1e-6)


def test_the_race_is_looked_for_where_a_known_speed_puts_it_though_no_line_of_the_shaft_is_heard():
    quiet = np.random.default_rng(5).standard_normal(TIME.size)
    followed, unfollowed = (
        analyse(quiet, RATE, KNOWN, turning=Turning(speeding(14.0, 26.0))),
        analyse(quiet, RATE, KNOWN),
    )
    assert unfollowed.race_window("outer")[1] > 1.2 * followed.race_window("outer")[1]


def test_only_the_turning_of_the_samples_that_are_used_counts():
    # 80 021 is prime: the transform is of the 80 000 samples before.
    angle = 2.0 * np.pi * (14.0 * np.arange(80_021) / RATE + 1.5 * (np.arange(80_021) / RATE) ** 2)
    found = analyse(np.random.default_rng(6).standard_normal(80_021), RATE, KNOWN, turning=Turning(angle))
    assert found.given.shaft_hz == pytest.approx(20.0, rel=1e-6)


def test_no_more_components_are_seen_at_even_angles_than_there_are():
    quiet = np.random.default_rng(5).standard_normal(2000)
    for turning in (None, Turning(speeding(14.0, 26.0)[:2000])):
        found = condition(quiet, RATE, 5000.0, turning)
        assert (found.slow(10_000).size, found.slow(300).size) == (found.raw.size, 300) == (501, 300)


@pytest.mark.parametrize(("start", "stop"), [(14.0, 26.0), (1.0, 39.0)])
def test_an_order_that_is_nearly_the_last_asked_for_is_whole_where_the_shaft_turns_fastest(start, stop):
    angle = speeding(start, stop)
    seen = Turning(angle).evenly(np.fft.rfft(np.cos(7.0 * angle)), angle.size, 600)
    # Order 7 of 80 turns is component 560; read without a window, as it is a whole number of periods.
    assert 2.0 * np.abs(np.fft.rfft(seen))[560] / seen.size == pytest.approx(1.0, abs=0.02)
