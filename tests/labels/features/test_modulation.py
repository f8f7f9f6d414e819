"""What is measured of the envelopes of noise that is modulated as stated."""

from dataclasses import replace

import numpy as np
import pytest

from labels.features.analysis import Analysis, analyse
from labels.features.families import Family
from labels.features.kinematics import bearing_kinematics
from labels.features.lines import lines_in
from labels.features.modulation import line_strength, measure

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


@pytest.mark.parametrize("faster", [1.0, 1.01])
def test_the_slip_of_a_line_is_told_in_per_cent_and_the_lead_of_the_inner_race_only_where_it_leads(faster):
    turn = faster * TURN
    for race, order in (("outer", KNOWN.bpfo), ("inner", KNOWN.bpfi)):
        # Harmonics of the shaft, which tell its speed, and a line 1 % off.
        shaft = sum(0.1 * np.cos(k * turn + k) for k in (1, 2, 3, 4))
        found = measured(shaft + 0.5 * np.cos(0.99 * order * turn if race == "outer" else 1.01 * order * turn))
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


def told_of(families: dict[str, Family], excess: dict[float, float] | None = None, **depth: float) -> dict[str, float]:
    """What is measured where these `families` were found, in envelopes that are level but for the `excess` at some
    orders and the depths of modulation at some components of the fourth band."""
    found = noise()
    level, depths = np.ones_like(found.envelopes.excess), np.zeros_like(found.envelopes.depth)
    for order, height in (excess or {}).items():
        level[:, round(order * 25.0 / found.envelopes.step)] = height
    for component, height in depth.items():
        depths[3, int(component[1:])] = height
    vars(found).update(families, envelopes=replace(found.envelopes, excess=level, depth=depths))
    return measure(found)


def noise() -> Analysis:
    return analyse(np.random.default_rng(1).standard_normal(SIZE), RATE, KNOWN)


def family(evidence: list[float], parts: list[list[float]], order: float) -> Family:
    """A family at one `order` in all bands, with this evidence in the first of 15 bands."""
    rest = 15 - len(evidence)
    return Family(np.pad(evidence, (0, rest)), np.pad(parts, ((0, rest), (0, 0))), np.full(15, order * 25.0))


def test_each_of_what_is_told_of_a_family_is_from_the_band_that_shows_most_of_it():
    # The first band has the most evidence and all of it in one harmonic, the second more in its other ones.
    found = told_of({"outer": family([10.0, 8.0], [[9.5, 0.5, 0.0, 0.0], [2.0, 2.0, 2.0, 2.0]], 4.0)})
    assert found["outer_evidence"] == pytest.approx(np.log(11.0))
    assert found["outer_others"] == pytest.approx(np.log(7.0))
    assert found["outer_first"] == pytest.approx(np.log(10.5))


def test_sidebands_count_though_they_lie_on_lines_of_the_shaft():
    found = told_of({"inner": family([1.0], [[1.0] * 4], 4.0)}, {3.0: 101.0, 5.0: 101.0})
    # A sideband is read over ±0.02 orders, 5 components: a mean of (101 + 4) / 5, of 5 / 1.5 independent ones.
    assert found["inner_sidebands"] == pytest.approx(np.log1p(2.0 * 5.0 / 1.5 * (20.0 - np.log(21.0))), rel=0.02)


def test_the_depth_is_the_largest_within_a_component_of_the_first_line():
    # 4 orders of 25 Hz are component 500, 0.2 Hz apart.
    found = told_of({"outer": family([1.0], [[1.0] * 4], 4.0)}, c498=0.9, c499=0.4, c500=0.1)
    assert found["outer_depth"] == pytest.approx(np.log(0.4))


def test_of_the_decoys_one_tells_the_median_and_one_the_largest():
    found = noise()
    vars(found)["decoys"] = np.array([0.0, 1.0, 2.0, 30.0, 100.0])
    told = measure(found)
    assert (told["decoy_evidence"], told["largest_decoy"]) == pytest.approx((np.log(3.0), np.log(101.0)))


def test_the_strength_of_a_family_is_the_mean_amplitude_of_its_first_three_lines():
    excess = np.ones((2, 4000))
    # Read over ±0.75 components, which are the line and a quarter of either neighbour: means of 16, 9, 4 and 667.
    for k, mean in enumerate((16.0, 9.0, 4.0, 667.0), 1):
        excess[1, 700 * k] = 1.5 * mean - 0.5
    assert line_strength(lines_in(excess, 0.1), 70.0, 0.02) == pytest.approx((4.0 + 3.0 + 2.0) / 3.0)
