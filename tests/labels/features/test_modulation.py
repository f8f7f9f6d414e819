"""Sidebands in the envelopes of noise that is modulated as stated."""

import numpy as np

from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics
from labels.features.modulation import measure

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)


def cage_sidebands(order):
    """What is measured of the inner race's cage sidebands in noise with lines at BPFI ± `order`."""
    rate, size = 20_000.0, 100_000
    turn = 2.0 * np.pi * 25.0 * np.arange(size) / rate
    passing = 0.4 * np.cos(KNOWN.bpfi * turn) * (1.0 + np.cos(order * turn))
    signal = np.sqrt(1.0 + passing) * np.random.default_rng(1).standard_normal(size)
    return measure(analyse(signal, rate, KNOWN))["inner_cage"]


def test_cage_sidebands_lie_a_cage_frequency_from_their_line():
    # The cage turns at 0.40 of the shaft.
    assert cage_sidebands(KNOWN.ftf) > 3.0
    for other in (0.5, 1.4, 2.0):
        assert cage_sidebands(other * KNOWN.ftf) < cage_sidebands(KNOWN.ftf) - 2.0
