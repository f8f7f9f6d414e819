"""Log odds: closed forms, ends and the way back."""

import numpy as np
import pytest

from labels.classifier.log_odds import EDGE, logit, probability_of


def test_odds_of_nine_to_one_are_nine_tenths():
    assert logit(np.array([0.5, 0.9])) == pytest.approx([0.0, np.log(9.0)], abs=1e-15)
    assert probability_of(np.log([1.0, 9.0])) == pytest.approx([0.5, 0.9], rel=1e-15)


def test_certainty_is_kept_off_the_ends():
    end = np.log((1.0 - EDGE) / EDGE)
    assert logit(np.array([0.0, 1.0])) == pytest.approx([-end, end], rel=1e-12)


def test_probabilities_stay_between_0_and_1_however_large_the_log_odds():
    assert probability_of(np.array([-800.0, 800.0])).tolist() == [0.0, 1.0]
    assert probability_of(np.array([-40.0]))[0] == pytest.approx(np.exp(-40.0), rel=1e-12)
