"""A signal at a lower rate: nothing folded back, nothing delayed, and its ends kept."""

import numpy as np
import pytest

from physics.response.resampling import decimate


@pytest.mark.parametrize("factor", [1, 2, 4, 7])
def test_a_level_is_kept_up_to_both_ends(factor):
    level = np.array([3.0, -1.0])
    lowered = decimate(np.tile(level, (1003, 1)), factor)
    assert lowered.shape == (-(-1003 // factor), 2)
    assert lowered == pytest.approx(np.tile(level, (lowered.shape[0], 1)), rel=1e-12)  # rounding


@pytest.mark.parametrize("factor", [2, 5])
@pytest.mark.parametrize(
    ("share", "height"), [(0.02, 1.0), (0.5, 1.0), (0.84, 1.0), (0.95, 0.5), (1.06, 0.0), (1.3, 0.0)]
)
def test_tones_below_the_edge_of_the_new_band_pass_without_delay_and_those_above_it_are_gone(factor, share, height):
    turned = np.pi * share / factor * np.arange(4000)[:, None] + np.array([0.3, 2.0])
    middle = slice(60, -60)  # the filter reaches 24 samples to both sides
    expected = height * np.cos(turned)[::factor]
    found = decimate(np.cos(turned), factor)
    # Kaiser's window of 80 dB and 48 new samples goes from 1 to 0 over 0.21 of the new band; 80 dB are 1e-4.
    assert np.abs(found - expected)[middle].max() < 1.2e-4
