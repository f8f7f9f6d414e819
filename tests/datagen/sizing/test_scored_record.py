"""Of which records a size is asked, of which none may be given, and which are left out of the scores."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from datagen.sizing.record_errors import noise_level
from datagen.sizing.scored_record import ScoredRecord, shortest_lag


@pytest.mark.parametrize(("rate", "shortest"), [(65_536.0, 0.02 / 50.0), (5_000.0, 5.0 / 5_000.0)])
def test_events_must_be_five_samples_and_a_fiftieth_of_a_pass_apart(
    scored: Callable[..., ScoredRecord], rate: float, shortest: float
) -> None:
    assert shortest_lag(rate, 0.02) == pytest.approx(shortest, rel=1e-12)
    assert scored({"rate": rate, "lag": shortest_lag(rate, 0.02)}).scorable
    assert not scored({"rate": rate, "lag": math.nextafter(shortest_lag(rate, 0.02), 0.0)}).has_events


@pytest.mark.parametrize(("spacings", "scorable"), [(0.9, True), (0.91, False), (1.4, False)])
def test_a_spall_in_which_a_whole_ball_spacing_may_hide_is_not_scored(
    scored: Callable[..., ScoredRecord], spacings: float, scorable: bool
) -> None:
    record = scored({"extent_spacing": spacings})
    assert (record.has_events, record.scorable) == (True, scorable)


@pytest.mark.parametrize(("samples", "silent"), [(math.nan, True), (1.9, True), (2.0, False), (4.0, False)])
def test_no_size_may_be_given_without_events_or_of_a_lag_below_two_samples(
    scored: Callable[..., ScoredRecord], samples: float, silent: bool
) -> None:
    lag = {"lag": samples / 65_536.0}
    assert scored(lag).without_event == silent
    assert not scored(lag | {"known": False}).without_event  # of which nobody knows


@pytest.mark.parametrize(("snr_db", "level"), [(math.nan, math.inf), (60.0, math.inf), (59.9, 40.0), (-30.0, -10.0)])
def test_a_record_whose_noise_is_unknown_or_60_db_below_counts_as_clean(
    scored: Callable[..., ScoredRecord], snr_db: float, level: float
) -> None:
    assert noise_level(scored({"snr_db": snr_db})) == level
