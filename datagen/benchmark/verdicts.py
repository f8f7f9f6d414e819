"""Testing: one vote a record, by the rule and by every model, on one corpus."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.chosen import ChosenRecords
from datagen.benchmark.corpus_rows import CorpusRows
from datagen.benchmark.record_rows import RecordFacts
from datagen.benchmark.rows import Rows
from datagen.benchmark.training import Model
from datagen.benchmark.truth import true_classes, true_locations
from labels.classifier.classes import CLASSES, called, location_probability
from labels.classifier.log_odds import logit, probability_of
from labels.classifier.rule import Rule, line_heights
from labels.classifier.votes import averaged, joined
from labels.schema import HEALTHY, LOCATIONS
from physics.arrays import Array

REJECTED = "rejected"
RULE = "rule"


@dataclass(frozen=True)
class Verdicts:
    """What one model says about R records; all shapes (R,) but that of the probabilities.

    `location` is none, outer, inner or rejected; `race` the one it would name if there had to be a spall. `score` rises
    with suspicion, and a spall is called where it passes the `alarm`, but for some records whose rows agree on a spall
    and not on its race or length (see `vote`). `probability` (R, 5) is that of CLASSES, empty for the rule.

    It says nothing about a record without features: the race is "rejected", score, alarm and probabilities are NaN.
    """

    name: str
    location: NDArray[np.str_]
    condition: NDArray[np.str_]
    race: NDArray[np.str_]
    score: Array
    alarm: Array
    probability: Array = field(default_factory=lambda: np.empty((0, len(CLASSES))))


@dataclass(frozen=True)
class Tested:
    """R `chosen` records with what was said of each; in pooled draws of noise a record is there once a draw.

    `truth` and `classes` (R,) are the location and the class that the labels state, `facts` (R) what reading the
    records showed.
    """

    chosen: ChosenRecords
    truth: NDArray[np.str_]
    classes: NDArray[np.str_]
    facts: tuple[RecordFacts, ...]
    verdicts: tuple[Verdicts, ...]

    @property
    def owner(self) -> NDArray[np.int64]:
        """The record (R,) that each verdict is of: draws of one record are drawn together in a bootstrap."""
        return self.chosen.numbers


@dataclass(frozen=True)
class Judges:
    """The rule and the models, which reject a record if their answer about its location has a probability below
    `reject`."""

    rule: Rule
    models: Sequence[Model]
    reject: float = 0.0

    def judge(self, chosen: ChosenRecords, found: CorpusRows) -> Tested:
        """What all say about the `chosen` records, by what was `found` in them.

        All reject a record that cannot be judged or shows no running machine.
        """
        records = chosen.numbers
        facts = tuple(found.facts.get(record, RecordFacts()) for record in records.tolist())
        reasons = np.array([of_record.reason for of_record in facts], dtype=np.str_)
        of_models = (
            _of_model(model, found.asked_for(model.takes_windows), records, reasons, self.reject)
            for model in self.models
        )
        return Tested(
            chosen=chosen,
            truth=true_locations(chosen.labels),
            classes=true_classes(chosen.labels),
            facts=facts,
            verdicts=(_of_rule(self.rule, found.rows, records, reasons), *of_models),
        )


def _of_rule(rule: Rule, rows: Rows, records: NDArray[np.int64], reasons: NDArray[np.str_]) -> Verdicts:
    heights = line_heights(rows.table, rows.record, records, rows.axis, rule.of_several)
    score = rule.score(heights)
    missing = np.isnan(score)
    rejected = missing | (reasons != "")
    location = np.where(rejected, REJECTED, rule.locations(heights))
    condition = np.where(location == "none", HEALTHY, np.where(rejected, REJECTED, "line"))
    race = np.where(missing, REJECTED, rule.races(heights))
    return Verdicts(RULE, location, condition, race, score, np.where(missing, np.nan, rule.threshold))


def _of_model(
    model: Model, rows: Rows, records: NDArray[np.int64], reasons: NDArray[np.str_], reject: float
) -> Verdicts:
    said = vote(model, rows, records)
    named = np.char.split(said.called)  # ["healthy"], or e.g. ["line", "outer"]
    where = location_probability(said.probability)
    place = np.array([LOCATIONS.index(words[1]) if len(words) > 1 else 0 for words in named], dtype=np.int64)
    missing = np.isnan(said.alarm)
    rejected = missing | (reasons != "") | (where[np.arange(place.size), place] < reject)
    condition = np.where(rejected, REJECTED, np.array([words[0] for words in named]))
    location = np.where(rejected, REJECTED, np.array(LOCATIONS)[place])
    race = np.where(missing, REJECTED, np.where(where[:, 1] >= where[:, 2], "outer", "inner"))
    return Verdicts(
        name=model.name,
        location=location,
        condition=condition,
        race=race,
        score=1.0 - where[:, 0],
        alarm=said.alarm,
        probability=said.probability,
    )


class Vote(NamedTuple):
    """What the rows of each of R records agree on: the `probability` (R, 5) of CLASSES and the class `called` (R,).

    `alarm` (R,) is the probability above which a spall is called, 0 where the record's lines alone call it.
    """

    probability: Array
    called: NDArray[np.str_]
    alarm: Array


def vote(model: Model, rows: Rows, records: NDArray[np.int64]) -> Vote:
    """The vote of the rows of each of `records` (R,).

    A spall is called by the mean of the rows' log odds of a spall over their alarms. The probability of a spall is that
    of all classes joined, which is lower where rows disagree on race or length, and so may stay below the alarm then. A
    record without rows is called healthy, with NaN for probabilities and alarm.
    """
    of_rows = model.probability(rows.table) if len(rows) else np.empty((0, len(CLASSES)))
    alarms = logit(model.alarms(rows))
    margins = logit(1.0 - of_rows[:, 0]) - alarms
    shares = model.shares(margins, rows)
    probability = joined(of_rows, rows.record, records, shares)
    margin = averaged(margins, rows.record, records, shares)
    alarm = averaged(alarms, rows.record, records, shares)
    by_lines = model.by_lines_alone(rows, records)
    names = called(probability, (margin > 0.0) | by_lines)
    return Vote(probability, names, np.where(by_lines, 0.0, probability_of(alarm)))


def pool(parts: list[Tested]) -> Tested:
    """Several draws of one corpus, or several parts of it, as one, record after record."""
    import pandas

    said = zip(*(tested.verdicts for tested in parts), strict=True)
    return replace(
        parts[0],
        chosen=replace(parts[0].chosen, labels=pandas.concat([tested.chosen.labels for tested in parts])),
        facts=tuple(of_record for tested in parts for of_record in tested.facts),
        verdicts=tuple(replace(of_one[0], **_joined_arrays(of_one)) for of_one in said),
        **_joined_arrays(parts),
    )


def _joined_arrays(parts: Sequence[Tested] | Sequence[Verdicts]) -> dict[str, Any]:
    """Every field of the `parts` that is an array, of all of them one after the other."""
    arrays = [field.name for field in fields(parts[0]) if isinstance(getattr(parts[0], field.name), np.ndarray)]
    return {name: np.concatenate([getattr(part, name) for part in parts]) for name in arrays}
