"""The report of a run: what stands in it, in which order, and that all of it is plain."""

import json

from datagen.benchmark.options import Options
from datagen.benchmark.predictions import ModelAnswer, Prediction
from datagen.benchmark.results import CorpusResults, CorpusScores, NoisyScores, Results
from datagen.files.plain import plain_json
from labels.interval import Interval

HALF = Interval(0.5, 0.25, 0.75)
OF_A_CORPUS = [
    "corpus",
    "imported",
    "records",
    "locations",
    "rejections",
    "levelled",
    "despiked",
    "shocks_cut",
    "in_mains",
    "in_shaft",
    "few_bands",
    "far_from_stated",
    "models",
]


def test_a_report_holds_plain_numbers_wherever_scores_are_and_parts_of_a_group_like_the_rest(made_scores):
    scores = CorpusScores(
        "out/a", True, 1, {"none": 1}, {}, {}, {}, {}, {}, {}, 0, 0, {"rule": made_scores(detection_auc=HALF)}
    )
    said = Prediction(
        3, "x", "b", "none", "", 0, 0, 0, "", "inner", 15, 1798.5, {"rule": ModelAnswer("none", 0.5, 1.0)}
    )
    test = CorpusResults(scores, [said], [NoisyScores(-5.0, 2, scores)])
    results = Results("out/t", Options(), {"training_records": 7, "importances": {}}, [test], 1.5)
    found = json.loads(plain_json(results.to_dict()))
    assert list(found) == ["train", "options", "training_records", "importances", "tests", "seconds"]
    assert found["options"]["speed_error"] == 0.02
    assert (found["train"], found["training_records"], found["seconds"]) == ("out/t", 7, 1.5)
    (held,) = found["tests"]
    assert list(held) == [*OF_A_CORPUS, "predictions", "noise"]
    (noisy,) = held["noise"]
    assert list(noisy) == ["snr_db", "draws", *OF_A_CORPUS]
    assert (noisy["snr_db"], noisy["draws"], noisy["corpus"], noisy["records"]) == (-5.0, 2, "out/a", 1)
    assert held["models"]["rule"] == noisy["models"]["rule"]
    assert held["models"]["rule"]["detection_auc"] == {"value": 0.5, "low": 0.25, "high": 0.75}
    assert "minus_rule" not in held["models"]["rule"]
    facts = {"record": 3, "recording": "x", "bearing_id": "b", "truth": "none", "rejected": ""}
    counts = {
        "levelled": 0,
        "despiked": 0,
        "shocks_cut": 0,
        "in_mains": "",
        "in_shaft": "inner",
        "bands": 15,
        "found_speed_rpm": 1798.5,
    }
    assert held["predictions"] == [facts | counts | {"rule": {"location": "none", "score": 0.5, "alarm": 1.0}}]


def test_results_without_a_learning_curve_have_none():
    assert Results("out/t", Options(), {"importances": {}}, [], 1.0).learning_curve == {}


def test_the_points_of_a_learning_curve_are_those_of_the_facts():
    curve = {"forest": [{"records": 10}]}
    assert Results("out/t", Options(), {"learning_curve": curve}, [], 1.0).learning_curve == curve
