"""What is measured of the envelopes of noise that is modulated as stated."""

import numpy as np
import pytest

from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics
from labels.features.modulation import measure

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)
RATE, SIZE = 20_000.0, 100_000
TURN = 2.0 * np.pi * 25.0 * np.arange(SIZE) / RATE


def measured(modulation):
    """What is measured in noise whose power is modulated (T,)."""
    signal = np.sqrt(1.0 + modulation) * np.random.default_rng(1).standard_normal(SIZE)
    return measure(analyse(signal, RATE, KNOWN))


def cage_sidebands(order):
    """What is measured of the inner race's cage sidebands in noise with lines at BPFI ± `order`."""
    return measured(0.4 * np.cos(KNOWN.bpfi * TURN) * (1.0 + np.cos(order * TURN)))["inner_cage"]


def test_cage_sidebands_lie_a_cage_frequency_from_their_line():
    # The cage turns at 0.40 of the shaft.
    assert cage_sidebands(KNOWN.ftf) > 3.0
    for other in (0.5, 1.4, 2.0):
        assert cage_sidebands(other * KNOWN.ftf) < cage_sidebands(KNOWN.ftf) - 2.0


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_sideband_a_shaft_frequency_to_either_side_of_the_line_counts(side):
    lines = np.cos(KNOWN.bpfi * TURN)
    beside, elsewhere = (lines + 0.7 * np.cos((KNOWN.bpfi + side * order) * TURN) for order in (1.0, 1.4))
    assert measured(0.5 * beside)["inner_sidebands"] > measured(0.5 * elsewhere)["inner_sidebands"] + 2.0


@pytest.mark.parametrize(
    ("name", "order", "other"),
    [
        # The ball meets both races in a turn of its own.
        ("ball_evidence", 2.0 * KNOWN.ball_spin, KNOWN.ball_spin),
        ("cage_evidence", KNOWN.ftf, 1.0 - KNOWN.ftf),
        ("shaft_modulation", 1.0, 1.4),
    ],
)
def test_each_part_of_the_bearing_shows_at_its_own_frequency(name, order, other):
    there, elsewhere = (measured(0.6 * np.cos(each * TURN))[name] for each in (order, other))
    assert there > 3.0
    assert elsewhere < there - 2.0


def test_the_slip_of_a_line_is_told_in_per_cent_and_the_lead_of_the_inner_race_only_where_it_leads():
    for race, order in (("outer", KNOWN.bpfo), ("inner", KNOWN.bpfi)):
        # Harmonics of the shaft, which tell its speed, and a line 1 % off.
        shaft = sum(0.1 * np.cos(k * TURN + k) for k in (1, 2, 3, 4))
        found = measured(shaft + 0.5 * np.cos(0.99 * order * TURN if race == "outer" else 1.01 * order * TURN))
        assert found[f"{race}_slip"] == pytest.approx(1.0, abs=0.3)  # a line is placed to a hundredth of an order
        lead = found["inner_evidence"] - found["outer_evidence"]
        assert (lead > 0.0) == (race == "inner")
        assert found["inner_lead_evidence"] == pytest.approx(max(lead, 0.0))


def test_the_spread_is_told_by_a_band_that_three_quarters_do_not_exceed():
    # Of 15 bands (the whole, halves, quarters, eighths) 8 hold the upper half, and 4 the uppermost eighth.
    noise, modulated = np.random.default_rng(2).standard_normal((2, SIZE))
    above = np.fft.rfft(np.sqrt(1.0 + 0.6 * np.cos(KNOWN.bpfo * TURN)) * modulated)
    spread = {}
    for share in (0.5, 0.9):
        edge = int(share * 0.95 * above.size)  # features see 0.95 of half the rate
        spectrum = np.concatenate([np.fft.rfft(noise)[:edge], above[edge:]])
        spread[share] = measure(analyse(np.fft.irfft(spectrum, SIZE), RATE, KNOWN))["outer_spread"]
    assert spread[0.5] > 3.0
    assert spread[0.9] < spread[0.5] - 1.0


def test_a_line_alone_has_no_others_and_a_third_harmonic_alone_no_first():
    for harmonic in (1, 3):  # the second lies on the mains
        found = measured(0.6 * np.cos(harmonic * KNOWN.bpfo * TURN))
        assert found["outer_evidence"] > 3.0
        assert found["outer_others"] < found["outer_evidence"] - 1.0
        assert (found["outer_first"] > 3.0) == (harmonic == 1)
