"""A known size on the same machine moves other sizes a little towards it, and never far."""

import math

import pytest

from labels.spall_size.known_size import corrected, known_size_factor
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome


def test_a_size_told_rightly_changes_nothing():
    assert known_size_factor(0.1, 0.1) == 1.0


@pytest.mark.parametrize("ratio", [1.02, 1.5, 10.0])
def test_the_factor_goes_towards_the_known_size_and_is_bounded(ratio):
    up, down = known_size_factor(1.0, ratio), known_size_factor(ratio, 1.0)
    assert 1.0 < up <= 1.00251  # a quarter of a per cent
    assert up * down == pytest.approx(1.0, rel=1e-12)


def test_a_correction_scales_every_extent_and_leaves_the_lag():
    estimate = SizeEstimate(SizeOutcome.ESTIMATED, "m", "outer", lag=1e-3, lag_interval=(9e-4, 2e-3), extent=0.1,
                        extent_interval=(0.08, 0.12), extent_mm=2.0, extent_mm_interval=(1.6, 2.4),
                        candidates=(0.1, 0.6))  # fmt: skip
    made = corrected(estimate, 1.1)
    assert (made.extent, made.extent_mm) == pytest.approx((0.11, 2.2))
    assert made.extent_interval == pytest.approx((0.088, 0.132))
    assert made.extent_mm_interval == pytest.approx((1.76, 2.64))
    assert made.candidates == pytest.approx((0.11, 0.61))  # still a ball spacing of 0.5 apart
    assert (made.lag, made.lag_interval) == (estimate.lag, estimate.lag_interval)


@pytest.mark.parametrize(
    ("known", "counted"), [(1.04, 1.04), (1.0 / 1.04, 1.0 / 1.04), (1.5, math.exp(0.05)), (1.0 / 1.5, math.exp(-0.05))]
)
def test_a_twentieth_of_the_error_is_taken_for_the_machines_and_of_five_per_cent_at_most(known, counted):
    assert known_size_factor(1.0, known) == pytest.approx(counted**0.05, rel=1e-12)


def test_no_correction_makes_a_spall_longer_than_the_longest_that_is_reported():
    estimate = SizeEstimate(SizeOutcome.ESTIMATED, "m", "outer", lag=1e-3, lag_interval=(9e-4, 2e-3), extent=2.6,
                        extent_interval=(2.5, 2.7), extent_mm=26.0, extent_mm_interval=(25.0, 27.0),
                        candidates=(2.6, 3.1))  # fmt: skip
    assert corrected(estimate, 1.02).candidates == pytest.approx((2.652,))  # 3.152 is more than half the race
    longest = corrected(estimate, 1.5)
    assert longest.candidates == (math.pi,)
    assert (longest.extent, longest.extent_mm) == pytest.approx((math.pi, 10.0 * math.pi))
