import math

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching

from labels.event_scores import EventScores, match_events, tolerance_of_arc


@pytest.mark.parametrize("seed", range(20))
def test_the_matching_is_as_large_as_any_can_be(seed):
    generator = np.random.default_rng(seed)
    found, true = generator.uniform(0.0, 1.0, 30), generator.uniform(0.0, 1.0, 25)
    tolerance = generator.uniform(0.005, 0.05)
    allowed = csr_array((np.abs(found[:, None] - true[None, :]) <= tolerance).astype(int))
    largest = int((maximum_bipartite_matching(allowed) >= 0).sum())  # Hopcroft and Karp's algorithm
    assert match_events(found, true, tolerance).matched == largest


def test_each_event_is_matched_once():
    scores = match_events(np.array([1.0, 1.001, 1.002]), np.array([1.001]), 0.01)
    assert (scores.matched, scores.found, scores.true) == (1, 3, 1)
    assert (scores.precision, scores.recall) == (pytest.approx(1 / 3), 1.0)
    assert scores.f1 == pytest.approx(0.5)  # 2 · (1/3) · 1 / (1/3 + 1)


def test_scores_add_up_and_nothing_gives_nothing():
    total = EventScores(1, 2, 3) + EventScores(2, 2, 2)
    assert total == EventScores(3, 4, 5)
    assert np.isnan(EventScores(0, 0, 0).f1)
    assert EventScores(0, 0, 4).recall == 0.0


@pytest.mark.parametrize(
    ("scores", "precision", "recall", "f1"),
    [
        (EventScores(0, 3, 4), 0.0, 0.0, 0.0),
        (EventScores(0, 0, 4), math.nan, 0.0, 0.0),
        (EventScores(0, 3, 0), 0.0, math.nan, 0.0),
        (EventScores(0, 0, 0), math.nan, math.nan, math.nan),
        (EventScores(3, 4, 6), 0.75, 0.5, 0.6),
    ],
)
def test_only_what_there_is_nothing_to_share_has_no_score(scores, precision, recall, f1):
    found = (scores.precision, scores.recall, scores.f1)
    assert found == pytest.approx((precision, recall, f1), nan_ok=True)


def test_a_tolerance_in_arc_is_a_share_of_the_pass():
    assert tolerance_of_arc(0.1, 0.02, 0.5) == pytest.approx(0.004)


def test_an_event_at_the_very_tolerance_is_matched():
    assert match_events(np.array([1.0]), np.array([1.5]), 0.5).matched == 1
    assert match_events(np.array([1.0]), np.array([1.5]), np.nextafter(0.5, 0.0)).matched == 0
