"""The vibration as velocity, its cepstrum and its length."""

import numpy as np
import pytest

from labels.features.analysis import Analysis, analyse
from labels.features.kinematics import Kinematics, bearing_kinematics
from labels.features.orders import measure, rahmonics, velocity_power

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)


def noise(seconds: float) -> Analysis:
    return analyse(np.random.default_rng(0).standard_normal(round(20_000.0 * seconds)), 20_000.0, KNOWN)


def test_the_velocity_of_a_tone_is_its_acceleration_over_its_frequency():
    rate, size = 20_000.0, 20_000
    time = np.arange(size) / rate
    tones = sum(np.cos(2.0 * np.pi * frequency * time) for frequency in (110.0, 440.0))
    analysis = analyse(tones + 1e-4 * np.random.default_rng(0).standard_normal(size), rate, KNOWN)
    power = velocity_power(analysis)
    low, high = (power[round(frequency / analysis.record.step)] for frequency in (110.0, 440.0))
    assert low / high == pytest.approx(16.0, rel=1e-3)  # (440 / 110)²; the noise adds some 1e-6
    assert power[: int(0.5 * 25.0 / analysis.record.step)].max() == 0.0


def test_rahmonics_are_read_at_one_and_at_two_periods():
    analysis = noise(1.0)
    cepstrum = np.tile([0.1, -0.1], 10_000)
    rate = cepstrum.size * analysis.record.step
    for period, height in ((1, 4.0), (2, 2.0)):
        cepstrum[round(period * rate / 80.0)] = height
        cepstrum[round(1.02 * period * rate / 80.0)] = 9.0  # beside them
    cepstrum[: round(0.69 * rate / 80.0)] *= 20.0  # and farther off than 0.3 periods of the first
    # The scatter of a normal distribution is 1.4826 times its median size; the mean height of both is 3.
    assert rahmonics(analysis, cepstrum, 80.0) == pytest.approx(np.log1p(3.0 / 0.14826), rel=1e-9)


@pytest.mark.parametrize("seconds", [0.5, 2.0])
def test_a_longer_record_holds_more_turns(seconds):
    # The speed may be refined by up to 2.2 %.
    assert measure(noise(seconds))["turns"] == pytest.approx(np.log(25.0 * seconds), abs=0.023)


def told_of_tones(known: Kinematics = KNOWN, seconds: float = 2.0, **amplitude: float) -> dict[str, float]:
    """What is measured of tones of these accelerations at these orders, in hardly any noise."""
    turn = 2.0 * np.pi * 25.0 * np.arange(round(20_000 * seconds)) / 20_000.0
    quiet = 1e-4 * np.random.default_rng(0).standard_normal(turn.size)
    tones = sum(height * np.cos(float(order[1:]) * turn) for order, height in amplitude.items())
    return measure(analyse(quiet + tones, 20_000.0, known))


def test_the_share_of_the_shaft_counts_its_first_eight_orders():
    # All of it, as a logarithm; of the second 1e-8 is left, and less than 1e-6 is not told.
    assert told_of_tones(_8=1.0)["shaft_velocity"] == pytest.approx(0.0, abs=0.05)
    for order in ("_9", "_11"):
        assert told_of_tones(**{order: 1.0})["shaft_velocity"] == pytest.approx(-6.0, abs=0.05)


@pytest.mark.parametrize("share", [0.1, 1e-3])
def test_a_share_is_of_the_velocity_and_told_as_a_power_of_ten(share):
    # As velocities, 1 on the sixth order of the shaft and the rest beside it.
    beside = np.sqrt((1.0 - share) / share)
    assert told_of_tones(_6=6.0, **{"_6.5": 6.5 * beside})["shaft_velocity"] == pytest.approx(np.log10(share), abs=0.02)


def test_a_line_is_read_one_and_a_half_components_wide_to_either_side_at_least():
    # In a second components lie 1 Hz apart, 0.04 orders; 0.03 orders would leave out those beside the middle.
    found = told_of_tones(seconds=1.0, **{"_6": 1.0, "_5.96": 0.5, "_6.04": 0.5})
    assert found["shaft_velocity"] == pytest.approx(0.0, abs=0.02)


def race_tones(order: float, last: float) -> dict[str, float]:
    """Faint tones at an `order` and its multiples up to the fourth, which tell where it is, and a strong `last` one."""
    return {f"_{k * order}": 0.003 * k for k in (1, 2, 3, 4)} | {f"_{last * order}": 1.0}


# Three BPFO of KNOWN are 0.7 % less than two BPFI; those of this bearing have no lines in common.
APART = bearing_kinematics(9, 39.04e-3, 11.0e-3, 0.0, 25.0)


# Orders 3.24 and 5.76, which lie on components, are 0.2 and 0.1 % off BPFO and BPFI.
@pytest.mark.parametrize(("race", "order", "other"), [("outer", 3.24, "inner"), ("inner", 5.76, "outer")])
def test_each_race_has_its_own_lines_in_the_vibration(race, order, other):
    # Beside the sixth, and as fast, a tone on no line; the faint ones have 0.03 % of that power each.
    found = told_of_tones(APART, **race_tones(order, 6.0), **{f"_{4.5 * order}": 0.75})
    assert found[f"{race}_velocity"] == pytest.approx(np.log10(0.5), abs=0.02)
    assert found[f"{other}_velocity"] < -2.0
    assert found[f"{race}_vibration"] > found[f"{other}_vibration"] + 1.0
    assert found["race_vibration"] == pytest.approx(found["outer_vibration"] - found["inner_vibration"])


def test_a_seventh_line_is_not_looked_at():
    assert told_of_tones(APART, **race_tones(3.24, 7.0))["outer_velocity"] == pytest.approx(0.0, abs=0.05)


def test_each_race_has_a_cepstrum_of_its_own(impulse_train):
    for race, other in (("outer", "inner"), ("inner", "outer")):
        order = KNOWN.bpfo if race == "outer" else KNOWN.bpfi
        found = measure(analyse(impulse_train(order, duration=2.0, snr_db=20.0), 20_000.0, KNOWN))
        assert found[f"{race}_cepstrum"] > found[f"{other}_cepstrum"] + 0.3


def test_the_cepstrum_of_the_shaft_is_read_at_one_and_two_of_its_turns(impulse_train):
    """A knock in every other turn shows at two turns and not at one."""
    silent, knocking = (
        measure(analyse(impulse_train(0.5, duration=4.0, snr_db=snr_db), 20_000.0, KNOWN)) for snr_db in (-60.0, 20.0)
    )
    assert knocking["shaft_cepstrum"] > silent["shaft_cepstrum"] + 0.5


def test_the_evidence_of_the_shaft_is_told_in_logarithms(impulse_train):
    found = analyse(impulse_train(1.0, duration=2.0), 20_000.0, KNOWN)
    assert found.speed.evidence > 50.0
    assert measure(found)["shaft_evidence"] == pytest.approx(np.log(1.0 + found.speed.evidence))
