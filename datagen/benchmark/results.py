"""What a run of `classify` gives back, and how its report holds it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from datagen.benchmark.model_scores import Scores
from datagen.benchmark.options import Options
from datagen.benchmark.predictions import Prediction


@dataclass(frozen=True)
class CorpusScores:
    """Scores of every model, the rule first, on the `records` of a `corpus` (its folder).

    `locations` counts the records by their true location, `rejections` by the reason why none of them can be judged;
    `levelled`, `despiked` and `shocks_cut` count the jumps, glitches and shocks taken out, and the records that had
    any; `in_mains` and `in_shaft` count the records in which the faults of a race hide among multiples of the mains
    and of the shaft's speed, `few_bands` those in which ball passes leave room for three bands at most, and
    `far_from_stated` those whose shaft was found at the edge of what is searched beside its stated speed.
    """

    corpus: str
    imported: bool
    records: int
    locations: dict[str, int]
    rejections: dict[str, int]
    levelled: dict[str, int]
    despiked: dict[str, int]
    shocks_cut: dict[str, int]
    in_mains: dict[str, int]
    in_shaft: dict[str, int]
    few_bands: int
    far_from_stated: int
    models: dict[str, Scores]

    def to_dict(self) -> dict[str, Any]:
        """As a report holds them."""
        return vars(self) | {"models": {name: scores.to_dict() for name, scores in self.models.items()}}


@dataclass(frozen=True)
class NoisyScores:
    """Scores with white noise added at a ratio `snr_db` (dB), all `draws` of it together."""

    snr_db: float
    draws: int
    scores: CorpusScores

    def to_dict(self) -> dict[str, Any]:
        """As a report holds them: level and draws stand like the scores."""
        return {"snr_db": self.snr_db, "draws": self.draws} | self.scores.to_dict()


@dataclass(frozen=True)
class CorpusResults:
    """Of one corpus the scores, what was said of every record, and the scores at every level of added noise."""

    scores: CorpusScores
    predictions: list[Prediction]
    noise: list[NoisyScores]

    def to_dict(self) -> dict[str, Any]:
        """As a report holds them: the rest stands like the scores."""
        return self.scores.to_dict() | {
            "predictions": [prediction.to_dict() for prediction in self.predictions],
            "noise": [noisy.to_dict() for noisy in self.noise],
        }


@dataclass(frozen=True)
class Results:
    """What `classify` found: `train` is what was learned from, `tests` has the results of each corpus tested.

    `facts` follow from learning alone: plain numbers by name, as they are kept with what was learned. The run took so
    many `seconds`.
    """

    train: str
    options: Options
    facts: dict[str, Any]
    tests: list[CorpusResults]
    seconds: float

    @property
    def importances(self) -> dict[str, dict[str, float]]:
        """How much each model uses each feature, those used most first."""
        found: dict[str, dict[str, float]] = self.facts["importances"]
        return found

    @property
    def learning_curve(self) -> dict[str, list[dict[str, Any]]]:
        """Points of the learning curve of each model; none if it was not asked for."""
        found: dict[str, list[dict[str, Any]]] = self.facts.get("learning_curve", {})
        return found

    def to_dict(self) -> dict[str, Any]:
        """As a report holds them: the facts stand like the rest."""
        return {
            "train": self.train,
            "options": self.options.to_dict(),
            **self.facts,
            "tests": [test.to_dict() for test in self.tests],
            "seconds": self.seconds,
        }
