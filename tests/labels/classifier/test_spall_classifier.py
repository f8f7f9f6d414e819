"""The staged classifier on made-up rows of the feature table."""

import numpy as np
import pytest
from sklearn.base import clone
from sklearn.tree import DecisionTreeClassifier

from labels.classifier.alarm import fit_alarm
from labels.classifier.classes import CLASSES, called, condition_probability, joint_class, location_probability
from labels.classifier.learners import LEARNERS, learner
from labels.classifier.log_odds import logit
from labels.classifier.reliability import calibration_error
from labels.classifier.spall_classifier import FALSE_ALARMS, RISING, SpallClassifier
from labels.classifier.stage import Stage
from labels.features.table import FEATURE_NAMES


def made_up(size, seed, shift=3.0):
    """Rows in which spalls raise one feature, the inner race another and extended spalls a third; two a bearing."""
    generator = np.random.default_rng(seed)
    classes = np.array([CLASSES[place % 5] for place in range(size)])
    table = generator.standard_normal((size, len(FEATURE_NAMES)))
    table[:, FEATURE_NAMES.index("outer_evidence")] += shift * (classes != "healthy")
    table[:, FEATURE_NAMES.index("race_evidence")] += shift * np.char.endswith(classes, "outer")
    table[:, FEATURE_NAMES.index("kurtosis")] += shift * np.char.startswith(classes, "extended")
    return table, classes, np.arange(size) // 2


def fitted_stage(estimator, table, answer, groups, noisy=None, divisions=1):
    noisy = np.zeros(len(answer), dtype=bool) if noisy is None else noisy
    return Stage(estimator, ("no", "yes"), divisions).fit(table, answer, groups, noisy)


@pytest.fixture(scope="module")
def fitted():
    return SpallClassifier("logistic").fit(*made_up(400, 1))


def test_probabilities_sum_to_one_and_their_marginals_agree(fitted):
    probability = fitted.predict_proba(made_up(50, 2)[0])
    np.testing.assert_allclose(probability.sum(axis=1), 1.0, rtol=1e-12)  # up to rounding
    np.testing.assert_allclose(location_probability(probability)[:, 0], condition_probability(probability)[:, 0])
    np.testing.assert_allclose(location_probability(probability).sum(axis=1), 1.0, rtol=1e-12)


def test_a_row_with_lines_higher_than_those_of_healthy_records_is_called_whatever_its_probability(fitted):
    table = np.full((1, len(FEATURE_NAMES)), -3.0)
    assert fitted.predict(table).tolist() == ["healthy"]
    table[0, FEATURE_NAMES.index("outer_strength")] = np.log(1.01 * fitted.alarm_.height)
    assert fitted.predict_proba(table)[0, 0] > 1.0 - fitted.alarm_.at(table)[0]
    assert fitted.predict(table)[0] in CLASSES[1:]


@pytest.mark.parametrize("kind", LEARNERS)
def test_every_learner_learns_what_is_there(kind):
    table, classes, groups = made_up(150, 1)
    stage = fitted_stage(learner(kind), table, classes != "healthy", groups)
    unseen, truth, _ = made_up(200, 2)
    # A shift of three standard deviations leaves 7 % errors at equal odds, if the feature were known beforehand.
    assert np.mean((stage.probability(unseen) > 0.5) == (truth != "healthy")) > 0.85


def test_more_divisions_into_folds_make_held_out_probabilities_hang_less_on_the_seed(monkeypatch):
    table, classes, groups = made_up(200, 3, shift=1.0)

    def spread(divisions):
        held_out = []
        for seed in range(6):
            monkeypatch.setattr("labels.classifier.stage.SEED", seed)
            stage = fitted_stage(learner("logistic"), table, classes != "healthy", groups, divisions=divisions)
            held_out.append(stage.held_out)
        return np.std(held_out, axis=0).mean()

    # The mean of six draws scatters by 0.41 of one; the factor 0.7 leaves room for six seeds' own scatter.
    assert spread(6) < 0.7 * spread(1)


def test_boosting_holds_no_rows_back_however_many_there_are():
    # From 10 000 rows on scikit-learn would by itself stop early on a tenth drawn at random, bearings torn apart.
    rows = np.random.default_rng(5).standard_normal((10_100, 1))
    trees = clone(learner("boosting").parts[0]).fit(rows, rows[:, 0] > 0.0)
    assert trees.n_iter_ == trees.max_iter
    assert trees.validation_score_.size == 0


def test_the_same_seed_gives_the_same_probabilities():
    table, classes, _ = made_up(100, 1)
    one, two = (learner("forest").fit(table, classes).predict_proba(table) for _ in range(2))
    np.testing.assert_array_equal(one, two)


def test_few_healthy_rows_of_unseen_bearings_pass_the_alarm(fitted):
    table, classes, _ = made_up(2000, 3)
    said = fitted.predict(table[classes == "healthy"])
    # 5 % by design, from 80 healthy rows: four of them pass, and four scatters by its root (three times: 13 %).
    assert 0.0 < np.mean(said != "healthy") < 0.13


@pytest.mark.parametrize("kind", ["logistic", "boosting", pytest.param("forest", marks=pytest.mark.slow)])
def test_more_evidence_never_makes_a_spall_less_likely(kind):
    model = SpallClassifier(kind).fit(*made_up(150, 1))
    table, _, _ = made_up(60, 5)
    spall = 1.0 - model.predict_proba(table)[:, 0]
    for name in RISING:
        raised = table.copy()
        raised[:, FEATURE_NAMES.index(name)] += 2.0
        assert np.all(1.0 - model.predict_proba(raised)[:, 0] >= spall - 1e-12)  # up to rounding


def test_the_race_is_told_from_the_families_alone(fitted):
    table, _, _ = made_up(20, 4)
    other = table.copy()
    other[:, FEATURE_NAMES.index("kurtosis")] += 5.0
    one, two = (location_probability(fitted.predict_proba(rows)) for rows in (table, other))
    np.testing.assert_allclose(one[:, 1] / one[:, 2], two[:, 1] / two[:, 2], rtol=1e-9)


def test_the_likeliest_spall_is_named_only_where_there_is_an_alarm():
    probability = np.array([[0.6, 0.1, 0.3, 0.0, 0.0], [0.2, 0.5, 0.3, 0.0, 0.0]])
    assert called(probability, np.array([False, True])).tolist() == ["healthy", "line outer"]
    assert called(probability, np.array([True, True])).tolist() == ["line inner", "line outer"]


def test_unknown_classes_and_learners_are_refused():
    assert joint_class("healthy", "none") == "healthy"
    with pytest.raises(ValueError, match="allowed"):
        joint_class("line", "ball")
    with pytest.raises(ValueError, match="allowed"):
        learner("oracle")


def test_noise_in_which_nothing_is_seen_does_not_blur_what_is_said_without_it():
    table, classes, groups = made_up(400, 6)
    blind = np.random.default_rng(7).standard_normal((800, len(FEATURE_NAMES)))
    noisy = np.arange(1200) >= 400
    given = np.concatenate([table, blind]), np.tile(classes != "healthy", 3), np.tile(groups, 3)
    unseen, truth, _ = made_up(4000, 8)
    wrong = []
    for marked in (None, noisy):
        probability = fitted_stage(learner("logistic"), *given, marked).probability(unseen)
        wrong.append(calibration_error(truth != "healthy", probability))
    # 400 rows set a line of two coefficients to about a tenth; calibrated on noise too, it is far too careful.
    assert wrong[1] < 0.05 < 0.1 < wrong[0]
    for missing, hidden in (("no", classes == "healthy"), ("yes", classes != "healthy")):
        with pytest.raises(ValueError, match=f'"{missing}" is on no record without added noise'):
            fitted_stage(learner("logistic"), table, classes != "healthy", groups, hidden)


@pytest.mark.parametrize("rare", ["healthy", "inner", "extended"])
def test_an_answer_on_one_bearing_alone_is_refused_by_name(rare):
    table, classes, groups = made_up(100, 1)
    of_it = np.flatnonzero(np.char.find(classes, rare) >= 0)
    kept = np.setdiff1d(np.arange(100), of_it[1:])
    with pytest.raises(ValueError, match=f'"{rare}" is on too few virtual bearings, 1; allowed: 2 or more'):
        SpallClassifier("logistic").fit(table[kept], classes[kept], groups[kept])


def test_corpora_without_extended_spalls_leave_that_question_out():
    table, classes, groups = made_up(200, 5)
    lines = ~np.char.startswith(classes, "extended")
    classifier = SpallClassifier("logistic").fit(table[lines], classes[lines], groups[lines])
    assert classifier.predict_proba(table)[:, 3:].max() == 0.0


@pytest.mark.parametrize(("length", "never"), [("extended", slice(1, 3)), ("line", slice(3, 5))])
def test_spalls_of_a_length_that_was_never_seen_are_never_called(length, never):
    classes = np.array(["healthy", f"{length} outer", f"{length} inner"])[np.arange(150) % 3]
    table = np.random.default_rng(0).standard_normal((150, len(FEATURE_NAMES)))
    probability = SpallClassifier("logistic").fit(table, classes, np.arange(150) // 2).predict_proba(table)
    assert probability[:, never].max() == 0.0
    np.testing.assert_allclose(probability.sum(axis=1), 1.0, rtol=1e-12)  # up to rounding


def test_the_same_evidence_in_a_longer_record_never_makes_a_spall_likelier():
    table, classes, groups = made_up(400, 9)
    # Taught otherwise: records of spalls are longer.
    table[:, FEATURE_NAMES.index("turns")] += 2.0 * (classes != "healthy")
    model = SpallClassifier("logistic").fit(table, classes, groups)
    longer = table.copy()
    longer[:, FEATURE_NAMES.index("turns")] += 2.0
    assert np.all(model.predict_proba(longer)[:, 0] >= model.predict_proba(table)[:, 0] - 1e-12)  # up to rounding


def test_more_false_alarms_are_made_where_more_are_allowed(monkeypatch):
    table, classes, groups = made_up(400, 1)
    unseen, truth, _ = made_up(2000, 3)
    called = []
    for share in (0.02, 0.4):
        monkeypatch.setattr("labels.classifier.spall_classifier.FALSE_ALARMS", share)
        model = SpallClassifier("logistic").fit(table, classes, groups)
        called.append(np.mean(model.predict(unseen[truth == "healthy"]) != "healthy"))
    assert called[1] > called[0] + 0.05  # 2 and, where nothing tells clear records from noise, 20 % of 80 rows set it


def test_the_alarm_is_set_on_what_is_said_of_bearings_that_were_not_learned_from(monkeypatch):
    """A tree that knows every row by heart is sure of each of them, and wrong of one in some others."""
    by_heart = DecisionTreeClassifier(random_state=0)
    monkeypatch.setattr("labels.classifier.spall_classifier.learner", lambda *_: by_heart)
    model = SpallClassifier("forest").fit(*made_up(400, 1, shift=1.5))
    unseen, truth, _ = made_up(2000, 3, shift=1.5)
    healthy = unseen[truth == "healthy"]
    assert np.mean(model.predict_proba(healthy)[:, 0] < 0.5) > 0.15
    assert np.mean(model.predict(healthy) != "healthy") < 0.1


def test_the_alarm_is_set_on_healthy_rows_with_their_records_noise_and_axes(monkeypatch):
    given = []

    def kept(*arguments):
        given.extend(arguments)
        return fit_alarm(*arguments)

    monkeypatch.setattr("labels.classifier.spall_classifier.fit_alarm", kept)
    table, classes, groups = made_up(200, 1)
    records, noisy, axes = np.arange(200) // 4 + 7, np.arange(200) % 3 == 1, np.arange(200) % 7
    model = SpallClassifier("logistic").fit(table, classes, groups, records, noisy, axes)
    healthy = classes == "healthy"
    expected = (model.spall_.held_out, table, records, noisy, axes)
    for found, every in zip(given[:5], expected, strict=True):
        np.testing.assert_array_equal(found, every[healthy])
    assert given[5] == FALSE_ALARMS


def test_noise_blurs_no_answer_of_the_three():
    table, classes, groups = made_up(400, 6)
    blind = np.random.default_rng(7).standard_normal((800, len(FEATURE_NAMES)))
    given = np.concatenate([table, blind]), np.tile(classes, 3), np.tile(groups, 3)
    unseen, _, _ = made_up(1000, 8)
    sure = []
    for noisy in (np.arange(1200) >= 400, np.zeros(1200, dtype=bool)):
        probability = SpallClassifier("logistic").fit(*given, noisy=noisy).predict_proba(unseen)
        spall = 1.0 - probability[:, 0]
        parts = (
            spall,
            location_probability(probability)[:, 2] / spall,
            condition_probability(probability)[:, 2] / spall,
        )
        sure.append([np.abs(logit(part)).mean() for part in parts])
    # Calibrated on rows of noise too, in which nothing is seen, each would be far too careful.
    assert np.all(np.array(sure[0]) > 1.5 * np.array(sure[1]))


def test_two_bearings_of_each_answer_are_enough():
    table, classes, _ = made_up(200, 1)
    faulty = classes != "healthy"
    stage = fitted_stage(learner("logistic"), table, faulty, 2 * faulty + np.arange(200) // 5 % 2)
    assert np.mean((stage.held_out > 0.5) == faulty) > 0.85


def test_what_is_held_out_comes_from_no_bearing_that_was_learned_from():
    """Each bearing has two rows that are alike and says nothing of any other: who knows one row knows the other."""
    generator = np.random.default_rng(4)
    groups = np.repeat(np.arange(100), 2)
    table, answer = generator.standard_normal((100, 3))[groups], (generator.uniform(size=100) < 0.5)[groups]
    stage = fitted_stage(DecisionTreeClassifier(random_state=0), table, answer, groups)
    assert np.mean((stage.held_out > 0.5) == answer) < 0.65  # half, and three times its scatter over 100 bearings
