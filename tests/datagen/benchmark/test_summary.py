"""Scores of a tested corpus."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas
import pytest

from datagen.benchmark.chosen import ChosenRecords
from datagen.benchmark.record_rows import RecordFacts
from datagen.benchmark.summary import summarise
from datagen.benchmark.verdicts import Tested as Judged
from datagen.benchmark.verdicts import Verdicts


def test_the_race_is_scored_of_every_fault_whether_it_raised_the_alarm_or_not():
    said = Verdicts(
        name="model",
        location=np.array(["none", "none", "outer", "rejected", "none"]),
        condition=np.array(["healthy", "healthy", "line", "rejected", "healthy"]),
        race=np.array(["outer", "inner", "outer", "rejected", "outer"]),
        score=np.array([0.1, 0.2, 0.9, np.nan, 0.3]),
        alarm=np.full(5, 0.5),
    )
    rule = replace(said, name="rule")
    truth = np.array(["outer", "outer", "inner", "outer", "none"])
    labels = pandas.DataFrame({"record": range(5), "bearing_id": list("abcde")}).assign(
        snr_db=np.nan, speed_rpm=100.0, extent_mm=np.nan, extent_spacing=np.nan
    )
    tested = Judged(
        chosen=ChosenRecords(Path("corpus"), labels, imported=True),
        truth=truth,
        classes=np.full(5, "unknown"),
        facts=(RecordFacts(),) * 5,
        verdicts=(rule,),
    )
    scores = summarise(tested).models["rule"]
    assert scores.race_accuracy.value == 0.25  # right: the first of four faults; healthy records do not count
    assert scores.faults_balanced_accuracy.value == 0.0
    assert scores.detection_auc.value == pytest.approx(1.0 / 3.0)  # of three faults with a score one is above 0.3


@pytest.fixture(scope="module")
def judged_by_hand():
    """What a rule and a model say of four faults of the outer race, two of the inner one, three healthy records, of
    which one is rejected, and one record of which nobody knows what it is."""
    model = Verdicts(
        name="model",
        location=np.array(["outer", "outer", "outer", "none", "inner", "outer", "none", "inner", "rejected", "outer"]),
        condition=np.array(
            ["line", "line", "extended", "healthy", "line", "extended", "healthy", "line", "rejected", "line"]
        ),
        race=np.array(["outer"] * 4 + ["inner", "outer", "inner", "inner", "outer", "outer"]),
        score=np.array([0.9, 0.8, 0.7, 0.2, 0.6, 0.9, 0.1, 0.65, 0.3, 0.9]),
        alarm=np.full(10, 0.5),
        probability=np.column_stack(
            [1.0 - np.array([0.9, 0.8, 0.7, 0.2, 0.6, 0.9, 0.1, 0.65, 0.3, 0.9]), np.zeros((10, 4))]
        ),
    )
    rule = Verdicts(
        name="rule",
        location=np.array(["outer", "none", "none", "none", "none", "none", "none", "none", "none", "none"]),
        condition=np.array(["line"] + ["healthy"] * 9),
        race=np.array(["outer"] * 3 + ["inner"] + ["outer"] * 6),
        score=np.array([3.0, 1.5, 1.2, 1.1, 1.3, 1.4, 1.6, 1.0, 1.7, 1.0]),
        alarm=np.full(10, 2.0),
    )
    truth = np.array(["outer"] * 4 + ["inner"] * 2 + ["none"] * 3 + ["unknown"])
    classes = ["line outer", "extended outer", "extended outer", "line outer", "line inner", "line inner"]
    labels = pandas.DataFrame({"record": range(10), "bearing_id": [*"aaaabbccc", "unknown"]}).assign(
        snr_db=np.nan, speed_rpm=100.0, extent_mm=[1.0, 1.0, 1.0, 3.0, 3.0, 3.0, *[np.nan] * 4], extent_spacing=0.5
    )
    return Judged(
        chosen=ChosenRecords(Path("corpus"), labels, imported=False),
        truth=truth,
        classes=np.array([*classes, "healthy", "healthy", "healthy", "unknown"]),
        facts=(RecordFacts(),) * 10,
        verdicts=(rule, model),
    )


@pytest.fixture(scope="module")
def counted_by_hand(judged_by_hand):
    """Its scores."""
    return summarise(judged_by_hand)


def test_faults_and_locations_are_counted_by_what_is_said_of_each(counted_by_hand):
    assert counted_by_hand.locations == {"none": 3, "outer": 4, "inner": 2, "unknown": 1}
    found = counted_by_hand.models["model"]
    assert found.faults_balanced_accuracy.value == pytest.approx((3 / 4 + 1 / 2) / 2)
    assert found.location_balanced_accuracy.value == pytest.approx((3 / 4 + 1 / 2 + 1 / 3) / 3)
    assert found.race_accuracy.value == pytest.approx(5 / 6)
    assert found.confusion.rows == ("none", "outer", "inner", "unknown")
    assert found.confusion.counts == [[1, 0, 1, 1], [1, 3, 0, 0], [0, 1, 1, 0], [0, 1, 0, 0]]


def test_healthy_records_are_alarms_rejected_or_left_alone(counted_by_hand):
    found = counted_by_hand.models["model"]
    assert (found.healthy, found.false_alarms, found.rejected) == (3, 1, 1)
    assert (found.healthy_bearings, found.alarming_bearings, found.healthy_of_unknown_bearing) == (1, 1, 0)
    # Healthy records have 0.1, 0.65 and 0.3: of 18 pairs 0.2 lies below two of them and 0.6 below one.
    assert found.detection_auc.value == pytest.approx(15 / 18)


def test_the_rule_is_taken_from_the_model_score_by_score(counted_by_hand):
    minus_rule = counted_by_hand.models["model"].minus_rule
    assert minus_rule.faults_balanced_accuracy.value == pytest.approx(0.625 - (1 / 4 + 0.0) / 2)
    assert minus_rule.race_accuracy.value == pytest.approx(5 / 6 - 3 / 6)
    # The rule's six faults lie above 3, 1, 1, 1, 1 and 1 of the healthy records, which have 1.6, 1.0 and 1.7.
    assert minus_rule.detection_auc.value == pytest.approx(15 / 18 - 8 / 18)


def test_conditions_are_counted_beside_locations(counted_by_hand):
    condition = counted_by_hand.models["model"].condition
    # Of line spalls two of four are called so, of extended ones one of two, of healthy records one of three.
    assert condition.condition_balanced_accuracy.value == pytest.approx((2 / 4 + 1 / 2 + 1 / 3) / 3)
    assert condition.condition_confusion.counts == [[1, 1, 0, 1], [1, 2, 1, 0], [0, 1, 1, 0]]


def test_conditions_are_not_told_apart_where_one_alone_is_known(judged_by_hand):
    known = np.where(judged_by_hand.truth == "outer", "line outer", "line inner")
    lines = replace(judged_by_hand, classes=np.where(judged_by_hand.truth == "none", "unknown", known))
    assert summarise(lines).models["model"].condition is None


def test_accuracy_is_told_against_what_differs_between_records(counted_by_hand):
    against = counted_by_hand.models["model"].accuracy_against
    (small, large) = against["extent_mm"]
    assert (small["at"], small["records"], small["accuracy"]) == (1.0, 3, 1.0)
    assert (large["at"], large["records"], large["accuracy"]) == (3.0, 3, pytest.approx(1 / 3))
    assert set(against) == {"extent_mm"}  # of what is the same of all, nothing is told


def test_healthy_and_faulty_records_weigh_the_same_in_reliability(counted_by_hand):
    reliability = counted_by_hand.models["model"].calibration.reliability
    # In the bin of 0.6 to 0.7 there are one of six faults and one of three healthy records.
    place = reliability["predicted"].index(pytest.approx((0.6 / 6 + 0.65 / 3) / (1 / 6 + 1 / 3)))
    assert reliability["observed"][place] == pytest.approx((1 / 6) / (1 / 6 + 1 / 3))
