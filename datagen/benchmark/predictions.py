"""What was said of each record, as plain numbers for JSON and as a table."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from datagen.benchmark.record_rows import RecordFacts
from datagen.benchmark.verdicts import Tested, Verdicts
from datagen.files.text_tables import csv_text
from labels.classifier.classes import condition_probability, location_probability
from labels.schema import CONDITIONS, LOCATIONS

FACTS = (
    "record",
    "recording",
    "bearing_id",
    "truth",
    "rejected",
    *RecordFacts().shown(),
    "found_speed_rpm",
)
SAID = ("location", "condition", "score", "alarm")


@dataclass(frozen=True)
class ModelAnswer:
    """What one model says about a record: the location, a score, and the alarm above which a spall is called, but where
    rows disagree (0 if the record's lines alone raise it); and, if the model gives probabilities, the condition and
    those of LOCATIONS and CONDITIONS by name. Numbers are NaN without features."""

    location: str
    score: float
    alarm: float
    condition: str | None = None
    location_probability: dict[str, float] | None = None
    condition_probability: dict[str, float] | None = None

    def to_dict(self) -> dict[str, Any]:
        """As a report holds it: probabilities only where there are any."""
        return {name: value for name, value in asdict(self).items() if value is not None}


@dataclass(frozen=True)
class Prediction:
    """What is known about a record, and the answer of each of the `models`.

    `truth` is its location, `rejected` why it was rejected ("" if it was not). So many jumps were `levelled`, glitches
    replaced (`despiked`) and `shocks_cut`. `in_mains` and `in_shaft` name the races whose faults hide among multiples
    of the mains and of the shaft's speed ("", "outer", "inner" or "outer inner"). So many `bands` were searched for
    modulation (0 without features), and `found_speed_rpm` is the shaft speed at which lines were looked for (None
    without features).
    """

    record: int
    recording: str
    bearing_id: str
    truth: str
    rejected: str
    levelled: int
    despiked: int
    shocks_cut: int
    in_mains: str
    in_shaft: str
    bands: int
    found_speed_rpm: float | None
    models: dict[str, ModelAnswer]

    @property
    def facts(self) -> dict[str, Any]:
        """All by name but what the models say."""
        return {name: getattr(self, name) for name in FACTS}

    def to_dict(self) -> dict[str, Any]:
        """As a report holds it: the answer of each model stands by its name beside the facts."""
        return self.facts | {name: answer.to_dict() for name, answer in self.models.items()}


def record_predictions(tested: Tested) -> list[Prediction]:
    """What was said of every record, in the order of the labels."""
    labels = tested.chosen.labels
    known = zip(labels["record"], labels["recording"], labels["bearing_id"], labels["location"], strict=True)
    return [
        Prediction(
            record=int(record),
            recording=str(recording),
            bearing_id=str(bearing),
            truth=str(location),
            rejected=facts.reason,
            **facts.shown(),
            found_speed_rpm=None if facts.found_rpm is None else float(f"{facts.found_rpm:.6g}"),
            models={said.name: _answer(said, place) for said in tested.verdicts},
        )
        for place, ((record, recording, bearing, location), facts) in enumerate(zip(known, tested.facts, strict=True))
    ]


def _answer(said: Verdicts, place: int) -> ModelAnswer:
    """What a model says of the record in that place."""
    numbers = str(said.location[place]), float(said.score[place]), float(said.alarm[place])
    if not len(said.probability):
        return ModelAnswer(*numbers)
    probability = said.probability[place : place + 1]
    return ModelAnswer(
        *numbers,
        condition=str(said.condition[place]),
        location_probability=dict(zip(LOCATIONS, location_probability(probability)[0].tolist(), strict=True)),
        condition_probability=dict(zip(CONDITIONS, condition_probability(probability)[0].tolist(), strict=True)),
    )


def prediction_table(models: Sequence[str], corpora: Iterable[tuple[str, Sequence[Prediction]]]) -> str:
    """CSV of the predictions of `corpora`, each given by its folder and its predictions.

    It has one row a record: what is known of it, and the answers of the `models`; probabilities are left to the JSON.
    """
    columns = ["corpus", *FACTS, *(f"{model}_{what}" for model in models for what in SAID)]
    rows = []
    for corpus, predictions in corpora:
        for prediction in predictions:
            said = [getattr(prediction.models[model], what) for model in models for what in SAID]
            numbers = [f"{value:.6g}" if isinstance(value, float) else value for value in said]
            rows.append([corpus, *prediction.facts.values(), *numbers])
    return csv_text(columns, rows)
