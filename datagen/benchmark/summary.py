"""Scores of a tested corpus."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.model_scores import Calibration, ConditionScores, Confusion, MinusRule, Scores
from datagen.benchmark.results import CorpusScores
from datagen.benchmark.verdicts import REJECTED, RULE, Tested, Verdicts
from labels.classifier.reliability import calibration_error, reliability
from labels.classifier.scores import (
    accuracy,
    accuracy_against,
    area_interval,
    balanced_accuracy,
    bootstrap,
    confusion,
    exact_interval,
    paired_difference,
)
from labels.interval import Interval
from labels.schema import CONDITIONS, LOCATIONS, UNKNOWN
from physics.arrays import Array
from physics.bearing import RACES

AGAINST = ("snr_db", "speed_rpm", "extent_mm", "extent_spacing")
CALIBRATION_DRAWS = 500
# In so few bands no fault is found: of simple simulated ones whose lines stand 12 dB out, 0 of 6, of 80 % and more in
# seven or fifteen bands.
FEW_BANDS = 3


def race_balance(truth: Any, said: Any) -> float:
    """Balanced accuracy over outer and inner; whatever else is said of such a record is an error."""
    return balanced_accuracy(truth, said, RACES)


def summarise(tested: Tested) -> CorpusScores:
    """Scores of the rule and of each model on one corpus.

    A fault that could not be judged counts as an error in every accuracy, that of the race included; the area under the
    ROC and the calibration leave out records without a score, healthy or not.
    """
    rule = tested.verdicts[0]
    return CorpusScores(
        corpus=str(tested.chosen.folder),
        imported=tested.chosen.imported,
        records=len(tested.chosen.labels),
        locations={name: int((tested.truth == name).sum()) for name in (*LOCATIONS, UNKNOWN)},
        rejections=dict(Counter(facts.reason for facts in tested.facts if facts.reason)),
        levelled=_taken_out(tested, "jumps"),
        despiked=_taken_out(tested, "glitches"),
        shocks_cut=_taken_out(tested, "shocks"),
        in_mains={race: sum(race in facts.in_mains for facts in tested.facts) for race in RACES},
        in_shaft={race: sum(race in facts.in_shaft for facts in tested.facts) for race in RACES},
        few_bands=sum(0 < facts.bands <= FEW_BANDS for facts in tested.facts),
        far_from_stated=sum(facts.far_from_stated for facts in tested.facts),
        models={verdicts.name: _scores(tested, verdicts, rule) for verdicts in tested.verdicts},
    )


def _taken_out(tested: Tested, what: str) -> dict[str, int]:
    """How many records had any "jumps", "glitches" or "shocks" (`what`) taken out, and how many in all."""
    counts = [getattr(facts, what) for facts in tested.facts]
    return {"records": sum(count > 0 for count in counts), what: sum(counts)}


def _scores(tested: Tested, said: Verdicts, rule: Verdicts) -> Scores:
    truth, scored, owner = tested.truth, tested.truth != UNKNOWN, tested.owner
    faulty, healthy = np.isin(truth, RACES), truth == "none"
    ranked = scored & np.isfinite(said.score)
    alarms = healthy & np.isin(said.location, RACES)
    learned = said.name != RULE
    return Scores(
        faults_balanced_accuracy=bootstrap(
            race_balance, truth[faulty], said.location[faulty], strata=truth[faulty], groups=owner[faulty]
        ),
        location_balanced_accuracy=bootstrap(
            balanced_accuracy, truth[scored], said.location[scored], strata=truth[scored], groups=owner[scored]
        ),
        race_accuracy=bootstrap(accuracy, truth[faulty], said.race[faulty], groups=owner[faulty]),
        detection_auc=area_interval(faulty[ranked], said.score[ranked], groups=owner[ranked]),
        healthy=int(healthy.sum()),
        false_alarms=int(alarms.sum()),
        false_alarm_share=_alarm_share(alarms[healthy], owner[healthy]),
        healthy_bearings=_known_bearings(tested, healthy),
        alarming_bearings=_known_bearings(tested, alarms),
        healthy_of_unknown_bearing=int((tested.chosen.labels["bearing_id"][healthy] == UNKNOWN).sum()),
        rejected=int((said.location == REJECTED).sum()),
        confusion=_confusion(truth, said.location, (*LOCATIONS, UNKNOWN), LOCATIONS),
        minus_rule=_against_rule(tested, said, rule) if learned else None,
        calibration=_calibration(tested, said) if learned else None,
        condition=_condition(tested, said) if learned else None,
        accuracy_against=_against(tested, said),
    )


def _confusion(
    truth: NDArray[np.str_], said: NDArray[np.str_], rows: tuple[str, ...], answers: tuple[str, ...]
) -> Confusion:
    """Counts of the truth in `rows` against the `answers` and what is rejected."""
    columns = (*answers, REJECTED)
    return Confusion(rows, columns, confusion(truth, said, rows, columns).tolist())


def _known_bearings(tested: Tested, chosen: NDArray[np.bool_]) -> int:
    """Of how many bearings the `chosen` (R,) records are, apart from those of which it is unknown."""
    names = tested.chosen.labels["bearing_id"][chosen]
    return int(names[names != UNKNOWN].nunique())


def _alarm_share(alarms: NDArray[np.bool_], owner: NDArray[np.int64]) -> Interval:
    """Share of healthy verdicts (N,) that call a spall with its exact interval; draws of one record count as one."""
    if not alarms.size:
        return Interval(math.nan, math.nan, math.nan)
    share, records = float(alarms.mean()), np.unique(owner).size
    return exact_interval(share * records, records)


def _against_rule(tested: Tested, said: Verdicts, rule: Verdicts) -> MinusRule:
    """Paired differences of the model and the rule."""
    truth = tested.truth
    ranked = (truth != UNKNOWN) & np.isfinite(said.score) & np.isfinite(rule.score)
    faulty = np.isin(truth, RACES)
    race, owner = truth[faulty], tested.owner[faulty]
    return MinusRule(
        faults_balanced_accuracy=paired_difference(
            race_balance, race, said.location[faulty], rule.location[faulty], strata=race, groups=owner
        ),
        race_accuracy=paired_difference(accuracy, race, said.race[faulty], rule.race[faulty], groups=owner),
        detection_auc=area_interval(
            faulty[ranked], said.score[ranked], rule.score[ranked], groups=tested.owner[ranked]
        ),
    )


def _calibration(tested: Tested, said: Verdicts) -> Calibration | None:
    """Reliability of the probability of a spall, with healthy records and faults weighing the same, as in training;
    None unless there are both.

    Chance adds to the calibration error of every draw, so the interval of a small error may lie above the error itself.
    """
    known = (tested.truth != UNKNOWN) & np.isfinite(said.probability[:, 0])
    spall, probability = np.isin(tested.truth[known], RACES), 1.0 - said.probability[known, 0]
    if np.unique(spall).size < 2:
        return None
    error = bootstrap(
        calibration_error, spall, probability, strata=spall, groups=tested.owner[known], draws=CALIBRATION_DRAWS
    )
    return Calibration(
        reliability=reliability(spall, probability),
        calibration_error=error,
    )


def _condition(tested: Tested, said: Verdicts) -> ConditionScores | None:
    """How well line and extended spalls are distinguished, of those whose size is known; None unless there are two
    of the conditions."""
    known = tested.classes != UNKNOWN
    conditions = np.array([name.split()[0] for name in tested.classes])[known]
    if np.unique(conditions).size < 2:
        return None
    called, owner = said.condition[known], tested.owner[known]
    return ConditionScores(
        bootstrap(balanced_accuracy, conditions, called, strata=conditions, groups=owner),
        _confusion(conditions, called, CONDITIONS, CONDITIONS),
    )


def _against(tested: Tested, said: Verdicts) -> dict[str, list[dict[str, float]]]:
    faulty = np.isin(tested.truth, RACES)
    right = (said.location == tested.truth)[faulty]
    tables = {}
    for name in AGAINST:
        quantity: Array = tested.chosen.labels[name].to_numpy(np.float64)[faulty]
        if np.unique(quantity[np.isfinite(quantity)]).size >= 2:
            tables[name] = accuracy_against(quantity, right, groups=tested.owner[faulty])
    return tables
