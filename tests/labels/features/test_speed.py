"""What the passing balls say of the speed of the shaft."""

import numpy as np
import pytest

from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics
from labels.features.speed import _families_term

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)


@pytest.mark.parametrize(("race", "share"), [("bpfo", 1.015), ("bpfo", 0.985), ("bpfi", 1.015)])
def test_the_likeliest_speed_is_the_one_at_which_the_cage_does_not_slip(impulse_train, race, share):
    signal = impulse_train(getattr(KNOWN, race), shaft_hz=25.0 * share, duration=2.0, snr_db=10.0)
    factors = np.linspace(0.978, 1.022, 89)
    term = _families_term(analyse(signal, 20_000.0, KNOWN).envelopes, KNOWN, factors)
    # The third harmonic is read to a component of 0.5 Hz: 0.2 % of 270 Hz.
    assert factors[term.argmax()] == pytest.approx(share, abs=0.004)
