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
