"""What was said of each record, as plain numbers for JSON and as a table."""

from __future__ import annotations

import csv
import io
from typing import Any

from datagen.benchmark.verdicts import Tested
from labels.classifier.classes import condition_probability, location_probability
from labels.schema import CONDITIONS, LOCATIONS

FACTS = ("record", "recording", "bearing_id", "truth", "rejected", "despiked", "shocks_cut")
SAID = ("location", "score", "alarm")


def record_predictions(tested: Tested) -> list[dict[str, Any]]:
    """One entry a record: why it was rejected ("" if it was not), how many glitches were drawn over and shocks cut, and
    of each model the location, the score, the alarm above which a spall is called, and probabilities, NaN without
    features."""
    found = []
    for place, (_, row) in enumerate(tested.labels.iterrows()):
        entry: dict[str, Any] = {
            "record": int(row["record"]),
            "recording": str(row["recording"]),
            "bearing_id": str(row["bearing_id"]),
            "truth": str(row["location"]),
            "rejected": str(tested.reasons[place]),
            "despiked": int(tested.glitches[place]),
            "shocks_cut": int(tested.shocks[place]),
        }
        for said in tested.verdicts:
            numbers = str(said.location[place]), float(said.score[place]), float(said.alarm[place])
            entry[said.name] = dict(zip(SAID, numbers, strict=True))
            if len(said.probability):
                own = said.probability[place : place + 1]
                entry[said.name] |= {
                    "location_probability": dict(zip(LOCATIONS, location_probability(own)[0].tolist(), strict=True)),
                    "condition_probability": dict(zip(CONDITIONS, condition_probability(own)[0].tolist(), strict=True)),
                }
        found.append(entry)
    return found


def prediction_table(tests: list[dict[str, Any]]) -> str:
    """CSV of the predictions in summaries of corpora, one row a record; probabilities are left to the JSON."""
    models = list(tests[0]["models"]) if tests else []
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["corpus", *FACTS, *(f"{model}_{what}" for model in models for what in SAID)])
    for test in tests:
        for entry in test["predictions"]:
            said = [entry[model][what] for model in models for what in SAID]
            numbers = [f"{value:.6g}" if isinstance(value, float) else value for value in said]
            writer.writerow([test["corpus"], *(entry[name] for name in FACTS), *numbers])
    return text.getvalue()
