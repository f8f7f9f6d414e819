"""The scores of one model on one set of records, and how a report holds them."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from labels.interval import Interval


@dataclass(frozen=True)
class Confusion:
    """Counts (R, C) of records by their true class, in `rows`, and by the class they are given, in `columns`."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    counts: list[list[int]]


@dataclass(frozen=True)
class Calibration:
    """Reliability of the probability of a spall by `labels.classifier.reliability`, and its error."""

    reliability: dict[str, list[float]]
    calibration_error: Interval

    def to_dict(self) -> dict[str, Any]:
        """As a report holds it: the interval of the error stands beside it."""
        error = asdict(self.calibration_error)
        return {
            "reliability": self.reliability,
            "calibration_error": error.pop("value"),
            "calibration_error_interval": error,
        }


@dataclass(frozen=True)
class ConditionScores:
    """How well healthy records, line and extended spalls are distinguished."""

    condition_balanced_accuracy: Interval
    condition_confusion: Confusion


@dataclass(frozen=True)
class MinusRule:
    """Paired differences of a model and the rule on the same records."""

    faults_balanced_accuracy: Interval
    race_accuracy: Interval
    detection_auc: Interval


@dataclass(frozen=True)
class Scores:
    """What one model scores on one set; None where something does not apply, as calibration to the rule.

    Numbers are of records or, where they say so, of bearings. `accuracy_against` has the accuracy over faults by
    quantity, in bins of it.
    """

    faults_balanced_accuracy: Interval
    location_balanced_accuracy: Interval
    race_accuracy: Interval
    detection_auc: Interval
    healthy: int
    false_alarms: int
    false_alarm_share: Interval
    healthy_bearings: int
    alarming_bearings: int
    healthy_of_unknown_bearing: int
    rejected: int
    confusion: Confusion
    minus_rule: MinusRule | None
    calibration: Calibration | None
    condition: ConditionScores | None
    accuracy_against: dict[str, list[dict[str, float]]]

    @property
    def headline(self) -> dict[str, Interval]:
        """The three scores that are shown first, each by a short word."""
        return {"faults": self.faults_balanced_accuracy, "race": self.race_accuracy, "AUC": self.detection_auc}

    def to_dict(self) -> dict[str, Any]:
        """As a report holds them: what does not apply is left out, and parts of a group stand like scores alone."""
        found: dict[str, Any] = {}
        for name, value in asdict(self).items():
            if name == "calibration" and self.calibration is not None:
                found |= self.calibration.to_dict()
            elif value is not None:
                found |= value if name == "condition" else {name: value}
        return found
