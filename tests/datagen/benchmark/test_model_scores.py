"""Reports hold the scores of a model as plain numbers, and only those that apply."""

from datagen.benchmark.model_scores import Calibration, ConditionScores, MinusRule
from labels.interval import Interval

OF_ALL = [
    "faults_balanced_accuracy",
    "location_balanced_accuracy",
    "race_accuracy",
    "detection_auc",
    "healthy",
    "false_alarms",
    "false_alarm_share",
    "healthy_bearings",
    "alarming_bearings",
    "healthy_of_unknown_bearing",
    "rejected",
    "confusion",
]
HALF = Interval(0.5, 0.25, 0.75)
HALF_HELD = {"value": 0.5, "low": 0.25, "high": 0.75}


def test_what_does_not_apply_is_not_in_a_report(made_scores):
    assert list(made_scores().to_dict()) == [*OF_ALL, "accuracy_against"]


def test_parts_of_a_group_stand_beside_the_other_scores(made_scores):
    scores = made_scores(
        detection_auc=HALF,
        minus_rule=MinusRule(HALF, HALF, HALF),
        calibration=Calibration({"predicted": [0.1]}, Interval(0.0, 0.0, 0.2)),
        condition=ConditionScores(HALF, made_scores().confusion),
    )
    found = scores.to_dict()
    assert list(found) == [
        *OF_ALL,
        "minus_rule",
        "reliability",
        "calibration_error",
        "calibration_error_interval",
        "condition_balanced_accuracy",
        "condition_confusion",
        "accuracy_against",
    ]
    assert found["detection_auc"] == found["minus_rule"]["race_accuracy"] == HALF_HELD
    assert found["calibration_error"] == 0.0
    assert found["calibration_error_interval"] == {"low": 0.0, "high": 0.2}
