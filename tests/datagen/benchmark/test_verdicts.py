"""What is said of records, and how draws of noise are pooled."""

from dataclasses import astuple, replace
from pathlib import Path

import numpy as np
import pandas
import pytest
from scipy.stats import binomtest

from datagen.benchmark.chosen import ChosenRecords
from datagen.benchmark.corpus_rows import CorpusRows
from datagen.benchmark.options import Options
from datagen.benchmark.predictions import ModelAnswer, Prediction, prediction_table, record_predictions
from datagen.benchmark.record_rows import RecordFacts
from datagen.benchmark.results import CorpusResults, NoisyScores, Results
from datagen.benchmark.rows import Rows
from datagen.benchmark.summary import summarise
from datagen.benchmark.training import Model
from datagen.benchmark.verdicts import REJECTED, Judges, pool, vote
from datagen.commands.classify import print_learning_curve, print_results, score_line
from datagen.commands.tables import verdict_table
from labels.classifier.alarm import CLEARNESS, Alarm
from labels.classifier.log_odds import logit, probability_of
from labels.classifier.rule import Rule
from labels.features.table import FEATURE_NAMES

RULE = Rule(2.0)


class Said:
    """An estimator that gives stated probabilities, one row after another."""

    def __init__(self, probability):
        self.probability = np.array(probability)

    def __call__(self, table):
        return self.probability


def rows_of(table, record, axis=None):
    """Rows without added noise, of one axis if none is given."""
    size = len(record)
    axis = np.zeros(size, dtype=np.int64) if axis is None else axis
    return Rows(table, record, axis, np.zeros(size, dtype=bool))


def corpus(locations):
    """Labels and empty rows of records at those locations, all line spalls or healthy."""
    size = len(locations)
    labels = pandas.DataFrame(
        {
            "record": np.arange(size),
            "recording": [str(record) for record in range(size)],
            "bearing_id": "b",
            "location": locations,
            "condition": ["healthy" if name == "none" else "line" for name in locations],
            **{name: np.linspace(1.0, 2.0, size) for name in ("snr_db", "speed_rpm", "extent_mm", "extent_spacing")},
        }
    )
    return labels, CorpusRows(rows_of(np.zeros((size, len(FEATURE_NAMES))), np.arange(size)))


def judge(labels, rows, model, doubt=0.0, rule=RULE):
    return Judges(rule, [model], doubt).judge(ChosenRecords(Path("made-up"), labels, imported=True), rows)


def judged(locations, probability, doubt=0.0, alarm=0.5):
    return judge(*corpus(locations), Model("said", Said(probability), alarm), doubt)


def test_what_is_said_is_rejected_by_its_own_probability():
    probability = [[0.70, 0.28, 0.02, 0.0, 0.0], [0.05, 0.95, 0.0, 0.0, 0.0], [0.9, 0.05, 0.05, 0.0, 0.0]]
    # The first passes an alarm of 0.2 and is called outer, of which it has a probability of 0.28.
    kept, doubted = (judged(["outer"] * 3, probability, doubt, 0.2).verdicts[1] for doubt in (0.0, 0.5))
    assert kept.location.tolist() == ["outer", "outer", "none"]
    assert doubted.location.tolist() == [REJECTED, "outer", "none"]
    assert doubted.condition.tolist() == [REJECTED, "line", "healthy"]


def test_probabilities_of_a_prediction_are_summed_over_classes_under_the_names_of_location_and_condition():
    # Healthy, line outer, line inner, extended outer, extended inner.
    said = record_predictions(judged(["outer"], [[0.1, 0.2, 0.05, 0.5, 0.15]]))[0].models["said"]
    assert said.location_probability == pytest.approx({"none": 0.1, "outer": 0.7, "inner": 0.2}, rel=1e-12)
    assert said.condition_probability == pytest.approx({"healthy": 0.1, "line": 0.25, "extended": 0.65}, rel=1e-12)


def test_ten_draws_of_the_same_noise_tell_no_more_than_one():
    locations = ["outer", "inner"] * 12
    generator = np.random.default_rng(2)
    probability = generator.dirichlet([1.0, 2.0, 2.0, 0.5, 0.5], len(locations))
    one = judged(locations, probability)
    once, pooled = (summarise(found).models["said"] for found in (one, pool([one] * 10)))
    for name in ("faults_balanced_accuracy", "race_accuracy"):
        assert astuple(getattr(pooled, name)) == pytest.approx(astuple(getattr(once, name)))
        differences = [astuple(getattr(scores.minus_rule, name))[1:] for scores in (pooled, once)]
        assert differences[0] == pytest.approx(differences[1])
    # A third as wide if draws were records; where two bins meet, one record more or less makes little difference.
    widths = [
        np.mean([row["high"] - row["low"] for row in scores.accuracy_against["snr_db"]]) for scores in (once, pooled)
    ]
    assert widths[1] > 0.8 * widths[0] > 0.1


def test_neither_do_healthy_records_drawn_ten_times():
    locations = ["outer", "inner", "none"] * 8
    probability = np.random.default_rng(2).dirichlet([2.0, 2.0, 2.0, 0.5, 0.5], len(locations))
    one = judged(locations, probability)
    once, pooled = (summarise(found).models["said"] for found in (one, pool([one] * 10)))
    for name in ("faults_balanced_accuracy", "race_accuracy", "location_balanced_accuracy", "detection_auc"):
        assert astuple(getattr(pooled, name)) == pytest.approx(astuple(getattr(once, name))), name
    for found, expected in (
        (pooled.calibration.calibration_error, once.calibration.calibration_error),
        (pooled.condition.condition_balanced_accuracy, once.condition.condition_balanced_accuracy),
        (pooled.minus_rule.detection_auc, once.minus_rule.detection_auc),
    ):
        assert astuple(found)[1:] == pytest.approx(astuple(expected)[1:])


def test_races_all_of_whose_records_are_right_are_bounded_race_by_race():
    probability = np.zeros((10, 5))
    probability[:8, 1] = probability[8:, 2] = 1.0
    found = summarise(judged(["outer"] * 8 + ["inner"] * 2, probability)).models["said"].faults_balanced_accuracy
    assert (found.value, found.high) == (1.0, 1.0)
    # Least mean of the shares c·8 and c·2 that ten right answers still have once in forty: (c·8)^8 (c·2)^2 = 0.025.
    share = (0.025 / (8.0**8 * 2.0**2)) ** 0.1
    assert found.low == pytest.approx(5.0 * share)


def test_pooled_draws_keep_what_each_draw_says_of_every_record():
    one = judged(["none", "outer"], np.array([[0.9, 0.1, 0, 0, 0], [0.2, 0.8, 0, 0, 0]]))
    other = replace(one, facts=(RecordFacts(in_mains=("inner",), glitches=3), RecordFacts(in_mains=("outer",))))
    pooled, draws = pool([one, other]), (one, other)
    for name in ("truth", "classes", "facts"):
        assert list(getattr(pooled, name)) == [value for draw in draws for value in getattr(draw, name)], name
    for said, of_draws in zip(pooled.verdicts, zip(*(draw.verdicts for draw in draws), strict=True), strict=True):
        assert said.name == of_draws[0].name
        for name in ("location", "condition", "race", "score", "alarm", "probability"):
            together = [part for draw in of_draws for part in np.asarray(getattr(draw, name)).tolist()]
            assert getattr(said, name).tolist() == together, name
    assert list(pooled.chosen.labels.index) == [*one.chosen.labels.index, *other.chosen.labels.index]


def test_the_reliability_of_a_corpus_weighs_healthy_and_faulty_alike():
    locations = ["none"] * 10 + ["outer"] * 90
    # One in ten of either side has the probability of the other: calibrated at equal priors, odds nine to one.
    spall = np.where(np.arange(100) < 10, 0.1, 0.9)
    spall[[0, *range(10, 19)]] = 0.9, *[0.1] * 9
    found = summarise(judged(locations, np.column_stack([1 - spall, spall, *np.zeros((3, 100))])))
    assert found.models["said"].calibration.calibration_error.value == pytest.approx(
        0.0, abs=1e-5
    )  # votes keep 1e-6 for every class


def test_spalls_of_known_race_and_unknown_size_have_a_reliability_with_an_interval():
    locations, spall = ["none"] * 20 + ["inner"] * 20, np.repeat([0.3, 0.8], 20)
    labels, rows = corpus(locations)
    labels.loc[20:, "condition"] = "unknown"
    model = Model("said", Said(np.column_stack([1 - spall, np.zeros((40, 1)), spall, np.zeros((40, 2))])), 0.5)
    said = summarise(judge(labels, rows, model)).models["said"]
    found = said.calibration
    assert found.reliability["observed"] == [0.0, 1.0]
    assert found.calibration_error.value == pytest.approx(0.25, abs=1e-5)  # 0.3 of none and 0.2 of all
    # Every draw is the same: what 0 of 20 in either half leaves room for.
    assert 0.0 < found.calibration_error.low < 0.25 < found.calibration_error.high < 1.0
    assert said.condition is None


def test_false_alarms_have_the_exact_interval_however_often_their_noise_was_drawn():
    spall = np.where(np.arange(12) < 1, 0.9, 0.1)
    one = judged(["none"] * 10 + ["outer"] * 2, np.column_stack([1 - spall, spall, *np.zeros((3, 12))]))
    once, pooled = (summarise(found).models["said"] for found in (one, pool([one] * 4)))
    share = binomtest(1, 10).proportion_ci()
    assert (once.false_alarms, pooled.false_alarms) == (1, 4)
    for found in (once, pooled):
        assert list(astuple(found.false_alarm_share)) == pytest.approx([0.1, share.low, share.high], rel=1e-9)


def test_each_record_is_told_with_its_alarm_its_reason_and_its_glitches():
    labels, rows = corpus(["outer", "none", "inner"])
    rows = CorpusRows(
        rows.rows[:2],
        {
            0: RecordFacts(
                in_mains=("outer",), in_shaft=("inner",), bands=3, found_rpm=1798.51234, far_from_stated=True
            ),
            1: RecordFacts(glitches=4, shocks=2, bands=4),
            2: RecordFacts("too short", jumps=1),
        },
    )
    model = Model("said", Said([[0.2, 0.8, 0.0, 0.0, 0.0], [0.9, 0.1, 0.0, 0.0, 0.0]]), 0.7)
    tested = judge(labels, rows, model)
    summary = summarise(tested)
    assert summary.rejections == {"too short": 1}
    assert summary.levelled == {"records": 1, "jumps": 1}
    assert summary.despiked == {"records": 1, "glitches": 4}
    assert summary.shocks_cut == {"records": 1, "shocks": 2}
    assert summary.in_mains == {"outer": 1, "inner": 0}
    assert summary.in_shaft == {"outer": 0, "inner": 1}
    assert summary.few_bands == 1
    assert summary.far_from_stated == 1
    first, second, third = predictions = record_predictions(tested)
    assert (first.rejected, second.despiked, third.levelled, third.rejected) == ("", 4, 1, "too short")
    assert (first.found_speed_rpm, third.found_speed_rpm) == (1798.51, None)
    assert (first.in_mains, second.in_mains) == ("outer", "")
    assert (first.in_shaft, second.in_shaft) == ("inner", "")
    assert [prediction.bands for prediction in predictions] == [3, 4, 0]
    assert first.models["rule"].alarm == RULE.threshold
    assert first.models["said"].alarm == pytest.approx(0.7)
    assert np.isnan(third.models["said"].alarm)
    text = prediction_table(["rule", "said"], [("made-up", predictions)])
    assert "\r" not in text
    table = text.splitlines()
    assert table[0].startswith(
        "corpus,record,recording,bearing_id,truth,rejected,levelled,despiked,shocks_cut,in_mains,in_shaft,bands,"
        "found_speed_rpm,rule_location,rule_condition,rule_score,rule_alarm,said_location,said_condition,said_score,"
    )
    # Six digits; three probabilities of 0 are taken as 1e-6, so healthy keeps 0.2 / 1.000003.
    assert table[1].endswith(",outer,line,0.800001,0.7")
    assert ",too short,1,0,0,,,0,,rejected,,nan,nan,rejected,rejected,nan,nan" in table[3]
    answers = [prediction.models for prediction in predictions]
    assert [said["said"].condition for said in answers] == ["line", "healthy", "rejected"]
    assert all(said["rule"].condition is None and "condition" not in said["rule"].to_dict() for said in answers)


def with_unjudged_records():
    """Six records of each kind told apart by their score, and after each kind four records that have no features."""
    kinds, looked_at = np.repeat(["none", "outer", "inner"], 10), np.tile(np.arange(10) < 6, 3)
    labels, rows = corpus(kinds.tolist())
    table = np.zeros((18, len(FEATURE_NAMES)))
    table[6:12, FEATURE_NAMES.index("outer_strength")] = table[12:, FEATURE_NAMES.index("inner_strength")] = 2.0
    rejected = dict.fromkeys(np.flatnonzero(~looked_at).tolist(), RecordFacts("too short"))
    rows = CorpusRows(rows_of(table, np.flatnonzero(looked_at)), rejected)
    healthy, outer, inner = [0.8, 0.1, 0.1, 0.0, 0.0], [0.2, 0.8, 0.0, 0.0, 0.0], [0.2, 0.0, 0.8, 0.0, 0.0]
    model = Model("said", Said([healthy] * 6 + [outer] * 6 + [inner] * 6), 0.5)
    return judge(labels, rows, model), ~looked_at


def test_nothing_is_said_of_a_record_without_features():
    tested, unjudged = with_unjudged_records()
    for said in tested.verdicts:
        assert set(said.race[unjudged]) == set(said.location[unjudged]) == {REJECTED}
        assert np.isnan([said.score[unjudged], said.alarm[unjudged]]).all()
        assert np.isfinite([said.score[~unjudged], said.alarm[~unjudged]]).all()
    assert np.isnan(tested.verdicts[1].probability[unjudged]).all()
    last = record_predictions(tested)[-1].models
    assert np.isnan(last["rule"].score)
    assert np.isnan(list(last["said"].location_probability.values())).all()


def test_a_record_of_a_stopped_machine_is_rejected_whatever_its_lines_and_its_probability():
    labels, _ = corpus(["outer"])
    table = np.zeros((1, len(FEATURE_NAMES)))
    table[0, FEATURE_NAMES.index("outer_strength")] = 2.0
    rows = CorpusRows(rows_of(table, np.array([0])), {0: RecordFacts("machine stopped")})
    tested = judge(labels, rows, Model("said", Said([[0.2, 0.8, 0.0, 0.0, 0.0]]), 0.5))
    for said in tested.verdicts:
        assert (said.location[0], said.condition[0], said.race[0]) == (REJECTED, REJECTED, "outer")
        assert np.isfinite([said.score[0], said.alarm[0]]).all()


def test_faults_that_nobody_could_judge_are_errors_of_race_but_have_no_rank_and_no_calibration():
    models = summarise(with_unjudged_records()[0]).models
    for scores in models.values():
        assert scores.race_accuracy.value == pytest.approx(0.6)
        assert scores.faults_balanced_accuracy.value == pytest.approx(0.6)
        assert scores.detection_auc.value == 1.0  # all that has a score is told apart
    assert models["said"].calibration.calibration_error.value == pytest.approx(
        0.2, abs=1e-5
    )  # 0.2 of none and 0.8 of all
    assert sum(models["said"].calibration.reliability["records"]) == 18
    assert models["said"].minus_rule.detection_auc.value == 0.0
    assert models["said"].minus_rule.race_accuracy.value == 0.0


def test_where_nothing_could_be_judged_there_is_neither_area_nor_calibration():
    labels, rows = corpus(["none", "outer", "inner"])
    rows = CorpusRows(rows.rows[:0], dict.fromkeys(range(3), RecordFacts("too short")))
    tested = judge(labels, rows, Model("said", None, 0.5))  # which nobody asks about nothing
    said = summarise(tested).models["said"]
    assert said.race_accuracy.value == 0.0
    assert np.isnan(said.detection_auc.value)
    assert said.calibration is None


def test_a_class_is_called_where_the_rows_pass_their_alarm_and_healthy_else():
    # The likeliest class of all is healthy in each; what counts is the alarm, and then the likeliest spall.
    said = Said([[0.52, 0.1, 0.38, 0.0, 0.0], [0.6, 0.3, 0.1, 0.0, 0.0]])
    table, records = np.zeros((2, len(FEATURE_NAMES))), np.arange(3)
    _, called, alarm = vote(Model("said", said, 0.45), rows_of(table, records[:2]), records)
    assert called.tolist() == ["line inner", "healthy", "healthy"]  # the last has no rows
    assert np.isnan(alarm).tolist() == [False, False, True]


def test_an_alarm_must_be_passed_and_not_only_reached():
    probability = [[0.5, 0.5, 0.0, 0.0, 0.0], [0.49, 0.51, 0.0, 0.0, 0.0]]
    assert judged(["outer"] * 2, probability).verdicts[1].location.tolist() == ["none", "outer"]


def test_the_rows_of_a_record_agree_on_its_alarm():
    model = Model("said", Said([[0.5, 0.5, 0.0, 0.0, 0.0]] * 2), Alarm(0.2, 0.8))
    table = np.zeros((2, len(FEATURE_NAMES)))
    table[1, FEATURE_NAMES.index(CLEARNESS)] = 1.0
    _, _, alarm = vote(model, rows_of(table, np.array([0, 0])), np.array([0]))
    assert alarm[0] == pytest.approx(0.5)  # the logits of 0.2 and 0.8 cancel


def test_a_record_is_called_for_its_lines_alone_whatever_its_probability():
    model = Model("said", Said([[0.9, 0.04, 0.06, 0.0, 0.0]] * 4), Alarm(0.5, 0.5, 4.0))
    table = np.zeros((4, len(FEATURE_NAMES)))
    # Two rows a record: their mean height is 5 (2.5 and 10) in the first, 3.9 in the second.
    table[:, FEATURE_NAMES.index("inner_strength")] = np.log([2.5, 10.0, 3.9, 3.9])
    _, called, alarm = vote(model, rows_of(table, np.array([0, 0, 1, 1])), np.arange(3))
    assert called.tolist() == ["line inner", "healthy", "healthy"]  # the last has no rows
    assert alarm[:2].tolist() == [0.0, pytest.approx(0.5)]
    assert np.isnan(alarm[2])


def test_a_quiet_axis_does_not_outvote_a_clear_one():
    """Log odds of 3 and −1 lie 5/3 above an alarm at even odds where the clear axis counts twice, not 1; an estimator
    of the user's, whose alarm knows nothing of axes, is heard evenly."""
    level = np.array([-1.0, 3.0, -1.0, 3.0])
    spall = probability_of(level)
    said = Said(np.column_stack([1.0 - spall, spall, *np.zeros((3, 4))]))
    rows = rows_of(np.zeros((4, len(FEATURE_NAMES))), np.array([0, 0, 1, 1]), np.array([0, 1, 0, 0]))
    for several, names in ((1.6, ["line outer", "line outer"]), (1.7, ["healthy", "line outer"])):
        model = Model("said", said, Alarm(0.5, 0.5, several=several))
        votes, called, alarm = vote(model, rows, np.arange(2))
        assert called.tolist() == names  # the rows of record 1 are windows of one axis: a mean of 1
        np.testing.assert_allclose(logit(alarm), [several, 0.0], atol=1e-9)
    assert np.log(votes[0, 1] / votes[0, 0]) == pytest.approx(5.0 / 3.0)
    labels, _ = corpus(["outer", "outer"])
    judgement = judge(labels, CorpusRows(rows), model)
    assert judgement.verdicts[1].location.tolist() == ["none", "outer"]
    votes, _, _ = vote(Model("own", said, 0.5), rows, np.arange(2))
    assert np.log(votes[0, 1] / votes[0, 0]) == pytest.approx(1.0)


def test_of_several_axes_the_rule_lowers_the_height_and_lines_alone_too():
    labels, _ = corpus(["inner", "inner"])
    table = np.zeros((3, len(FEATURE_NAMES)))
    table[:, FEATURE_NAMES.index("inner_strength")] = np.log([8.0, 1.0, 4.0])  # 4 high by the vote, either record
    rows = CorpusRows(rows_of(table, np.array([0, 0, 1]), np.array([0, 1, 0])))
    model = Model("said", Said([[0.9, 0.04, 0.06, 0.0, 0.0]] * 3), Alarm(0.5, 0.5, 3.0, height_several=1.5))
    rule, said = judge(labels, rows, model, rule=Rule(3.0, 1.5)).verdicts
    np.testing.assert_allclose(rule.score, [4.0 / 1.5, 4.0])
    assert rule.location.tolist() == said.location.tolist() == ["none", "inner"]


def test_the_race_named_is_the_likelier_one_even_where_no_spall_is_called():
    sure = [[0.2, 0.8, 0.0, 0.0, 0.0], [0.2, 0.0, 0.8, 0.0, 0.0]]
    unsure = [[0.9, 0.06, 0.04, 0.0, 0.0], [0.9, 0.04, 0.06, 0.0, 0.0]]
    said = judged(["outer", "inner"] * 2, sure + unsure).verdicts[1]
    assert said.race.tolist() == ["outer", "inner"] * 2
    assert said.location.tolist() == ["outer", "inner", "none", "none"]


def test_alarming_bearings_are_the_healthy_ones_with_an_alarm_counted_once():
    labels, rows = corpus(["none"] * 5 + ["outer"])
    labels["bearing_id"] = ["one", "one", "two", "three", "three", "faulty"]
    spall = np.array([0.9, 0.9, 0.1, 0.1, 0.9, 0.9])
    model = Model("said", Said(np.column_stack([1 - spall, spall, *np.zeros((3, 6))])), 0.5)
    found = summarise(judge(labels, rows, model)).models["said"]
    assert (found.healthy, found.false_alarms) == (5, 3)
    assert (found.healthy_bearings, found.alarming_bearings) == (3, 2)


@pytest.mark.parametrize(
    ("bearings", "counts", "words"),
    [
        (["a", "a", "b", "c"], (3, 2, 0), " (2/3 bearings)"),
        (["a", "a", "unknown", "unknown"], (1, 1, 2), " (1/1 bearings, 2 of unknown bearings)"),
        (["unknown"] * 4, (0, 0, 4), " (bearings unknown)"),
    ],
)
def test_unknown_bearings_are_not_counted_as_one(bearings, counts, words):
    labels, rows = corpus(["none"] * 4)
    labels["bearing_id"] = bearings
    spall = np.array([0.9, 0.1, 0.9, 0.1])
    model = Model("said", Said(np.column_stack([1 - spall, spall, *np.zeros((3, 4))])), 0.5)
    tested = judge(labels, rows, model)
    found = summarise(tested).models["said"]
    names = ("healthy_bearings", "alarming_bearings", "healthy_of_unknown_bearing")
    assert tuple(getattr(found, name) for name in names) == counts
    assert f"{words}, rejected 0" in score_line(found)


def test_what_is_said_of_a_record_of_unknown_health_is_no_false_alarm():
    outer, healthy = [0.05, 0.95, 0.0, 0.0, 0.0], [0.95, 0.05, 0.0, 0.0, 0.0]
    locations = ["none", "none", "ball", "unknown", "outer"]
    found = summarise(judged(locations, [outer, healthy, outer, outer, outer])).models["said"]
    assert (found.healthy, found.false_alarms) == (2, 1)
    assert found.confusion.counts[-1] == [0, 2, 0, 0]  # beside them, called outer


def test_what_is_said_of_records_that_are_not_scored_is_told_record_by_record(capsys):
    outer, healthy = [0.05, 0.95, 0.0, 0.0, 0.0], [0.9, 0.1, 0.0, 0.0, 0.0]
    tested = judged(["none", "unknown", "ball"], [healthy, outer, healthy])
    print_results([CorpusResults(summarise(tested), record_predictions(tested), [])])
    shown = capsys.readouterr().out
    assert ": 3 records: 1 healthy, 2 not scored\n" in shown
    lines = [line for line in shown.splitlines() if "│" in line]
    assert len(lines) == 2
    assert "unknown" in lines[0]
    assert "outer (0.95 > 0.50)" in lines[0]
    assert "ball" in lines[1]
    assert "none (0.10 ≤ 0.50)" in lines[1]


def test_speeds_that_are_probably_wrong_are_told_below_the_scores(capsys):
    tested = judged(["none", "outer"], [[0.9, 0.1, 0.0, 0.0, 0.0], [0.05, 0.95, 0.0, 0.0, 0.0]])
    for far in (0, 2):
        tested = replace(tested, facts=[RecordFacts(far_from_stated=place < far) for place in range(2)])
        print_results([CorpusResults(summarise(tested), record_predictions(tested), [])])
        assert ("  speeds     2: the shaft was found about as far from" in capsys.readouterr().out) == bool(far)


def test_what_was_taken_out_and_what_hides_is_told_below_the_scores(capsys):
    tested = judged(["none", "outer", "inner"], [[0.9, 0.1, 0.0, 0.0, 0.0]] * 3)
    facts = (
        RecordFacts(jumps=2, in_mains=("inner",)),
        RecordFacts(jumps=1, glitches=5, shocks=7),
        RecordFacts("too short", in_mains=("inner", "outer")),
    )
    told = (
        "  rejected   1: too short\n",
        "  levelled   3 jumps in 2 records\n",
        "  despiked   5 glitches in 1 record\n",
        "  shocks cut 7 in 1 record\n",
        "  in mains   1: balls may pass the outer race at a multiple of 50 or 60 Hz",
        "  in mains   2: balls may pass the inner race at a multiple of 50 or 60 Hz",
    )
    for found in (facts, (RecordFacts(),) * 3):
        tested = replace(tested, facts=found)
        print_results([CorpusResults(summarise(tested), record_predictions(tested), [])])
        shown = capsys.readouterr().out
        assert [line in shown for line in told] == [found is facts] * len(told)
        for word in ("rejected  ", "levelled  ", "despiked  ", "shocks cut", "in mains  "):
            assert (f"  {word} " in shown) == (found is facts)
        assert "│" not in shown  # all are scored


def test_scores_in_added_noise_are_told_with_its_level_where_there_are_any(capsys):
    for locations, scored in ((["none", "outer"], True), (["unknown", "ball"], False)):
        tested = judged(locations, [[0.9, 0.1, 0.0, 0.0, 0.0], [0.05, 0.95, 0.0, 0.0, 0.0]])
        noisy = NoisyScores(-12.5, 3, summarise(tested))
        print_results([CorpusResults(summarise(tested), record_predictions(tested), [noisy])])
        assert ("  said       -12.5 dB: faults 1.000" in capsys.readouterr().out) == scored


def test_scores_in_added_noise_are_those_with_the_noise(capsys):
    healthy, outer = [0.9, 0.1, 0.0, 0.0, 0.0], [0.05, 0.95, 0.0, 0.0, 0.0]
    tested, deaf = (judged(["none", "outer"], [healthy, second]) for second in (outer, healthy))
    print_results(
        [CorpusResults(summarise(tested), record_predictions(tested), [NoisyScores(0.0, 1, summarise(deaf))])]
    )
    shown = capsys.readouterr().out
    assert "  said       faults 1.000" in shown
    assert "  said       0 dB: faults 0.000" in shown


def test_false_alarms_are_told_of_the_healthy_records_and_rejections_of_all():
    """Two of five healthy records are called faulty, one is rejected as in doubt, and so is one of two faults."""
    healthy, outer, doubt = [0.9, 0.1, 0.0, 0.0, 0.0], [0.05, 0.95, 0.0, 0.0, 0.0], [0.02, 0.49, 0.49, 0.0, 0.0]
    tested = judged(["none"] * 5 + ["outer"] * 2, [healthy, healthy, outer, outer, doubt, outer, doubt], 0.5)
    found = summarise(tested).models["said"]
    assert (found.false_alarms, found.healthy, found.rejected) == (2, 5, 2)
    line = score_line(found)
    assert "false alarms 2/5 [" in line
    assert line.endswith(", rejected 2")


def test_a_learning_curve_is_told_point_by_point_with_its_interval_where_it_has_one(capsys):
    nan = float("nan")
    points = [
        {"bearings": 1, "value": nan, "low": nan, "high": nan},
        {"bearings": 4, "value": 0.5, "low": nan, "high": nan},
        {"bearings": 8, "value": 0.75, "low": 0.6, "high": 0.875},
    ]
    print_learning_curve(Results("made-up", Options(), {"learning_curve": {"said": points}}, [], 1.0))
    assert capsys.readouterr().out.splitlines() == [
        "learning curve: said – from 1 virtual bearing",
        "learning curve: said 0.500 from 4 virtual bearings",
        "learning curve: said 0.750 [0.600, 0.875] from 8 virtual bearings",
    ]


def test_models_have_no_scores_where_the_class_of_no_record_is_known(capsys):
    outer, healthy = [0.05, 0.95, 0.0, 0.0, 0.0], [0.9, 0.1, 0.0, 0.0, 0.0]
    for locations, said in (["unknown", "ball"], False), (["none", "ball"], True):
        tested = judged(locations, [outer, healthy])
        print_results([CorpusResults(summarise(tested), record_predictions(tested), [])])
        shown = capsys.readouterr().out
        assert ("no scores  the true class of no record is known" in shown) != said
        assert ("  said       faults –" in shown) == said


def test_doubt_rejects_what_is_less_likely_than_it_by_however_little():
    probability = [[0.02, 0.49, 0.49, 0.0, 0.0], [0.02, 0.51, 0.47, 0.0, 0.0]]
    assert judged(["outer"] * 2, probability, 0.5).verdicts[1].location.tolist() == [REJECTED, "outer"]


@pytest.mark.parametrize(
    ("location", "score", "message"),
    [
        ("none", 0.71, "none (0.71 ≤ 0.73)"),
        ("outer", 0.8, "outer (0.80 > 0.73)"),
        ("outer", 0.7299, "outer (0.73 ≈ 0.73)"),
        ("rejected", 0.5, "rejected"),
    ],
)
def test_an_answer_stands_beside_the_probability_and_the_alarm_that_made_it(location, score, message):
    where = {"none": 1.0 - score, "outer": score, "inner": 0.0}
    answers = {
        "forest": ModelAnswer(location, score, 0.73, location_probability=where),
        "rule": ModelAnswer("inner", 30.0, 9.0),
    }
    table = verdict_table(
        [Prediction(0, "a", "b", "unknown", "", 0, 0, 0, "", "", 15, None, answers)], ["forest", "rule"]
    )
    columns = {str(column.header): list(column.cells) for column in table.columns}
    assert (columns["forest"], columns["rule"]) == ([message], ["inner"])
    assert "a spall, and the alarm above which one is called" in str(table.caption)
