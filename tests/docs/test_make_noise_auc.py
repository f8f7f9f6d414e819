"""Areas of faults in noise against healthy recordings of other sets, on scores made by hand."""

import json

import make_noise_auc
import numpy as np
import pytest
from make_noise_auc import Ranked, areas, together
from transfer_page import NOISE_AUC, PAGE


def ranked(prefix, rule, learner):
    names = np.array([f"{prefix}/{place}" for place in range(len(rule))])
    return Ranked(names, {"rule": np.array(rule, dtype=float), "forest": np.array(learner, dtype=float)})


FAULTY = ranked("f", [5, 6, 7, 8, 1, 9], [0.9, 0.8, 0.95, 0.7, 0.9, 0.99])
HEALTHY = ranked("h", [2, 3, 4, 0, 2, 3], [0.1, 0.2, 0.85, 0.3, 0.1, 0.2])


def test_the_area_is_the_share_of_pairs_in_which_the_fault_scores_higher():
    found = areas(FAULTY, HEALTHY)
    # By the rule the fault of 1 loses to all healthy ones but that of 0; by the forest 0.8 and 0.7 lose to 0.85.
    assert found["rule"]["area"]["value"] == pytest.approx(31 / 36)
    assert found["forest"]["area"]["value"] == pytest.approx(34 / 36)
    difference = found["forest"]["minus_rule"]
    assert difference["value"] == pytest.approx(3 / 36)
    assert difference["low"] < 3 / 36 < difference["high"]
    assert "minus_rule" not in found["rule"]


def test_verdicts_without_a_score_are_left_out():
    unheard = ranked("u", [np.nan, 100.0], [0.99, np.nan])
    assert areas(together([FAULTY, unheard]), HEALTHY)["forest"]["minus_rule"]["value"] == pytest.approx(3 / 36)


def test_draws_of_a_recording_are_drawn_together():
    doubled = areas(together([FAULTY] * 3), together([HEALTHY] * 3))["rule"]["area"]
    assert doubled == areas(FAULTY, HEALTHY)["rule"]["area"]  # not narrower for three times as many verdicts


def test_the_page_holds_the_table_of_the_stored_areas():
    table = make_noise_auc.table(json.loads(NOISE_AUC.read_text(encoding="utf-8")))
    assert f"-->\n{table}\n<!--" in PAGE.read_text(encoding="utf-8")
