"""The calibration fitted anew to a small corpus: it must come out whole, however little such a fit knows."""

from __future__ import annotations

import shutil
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import parse_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from datagen.sizing import fit, fit_stages
from datagen.sizing.estimators import default_estimator
from datagen.sizing.fit_limits import most_doubt, reach
from datagen.sizing.fit_stages import FittedGuess
from datagen.sizing.sized_records import sized_records
from datagen.sizing.training_rows import trials
from datagen.sizing.trial_columns import TrialColumns
from labels.spall_size.estimation.calibration import Calibration, Guess
from labels.spall_size.estimation.estimator import SizeEstimator
from labels.spall_size.size_estimate import SizeOutcome
from physics.arrays import Array


@pytest.fixture(scope="module")
def small_ladder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Twenty-four records of as many bearings, all for training, a quarter of them healthy."""
    folder = tmp_path_factory.mktemp("ladder") / "corpus"
    defect = {
        "condition": {"choice": ["healthy", "line"], "weights": [1, 3]},
        "profile": "ball_path",
        "extent_spacing": {"uniform": [0.1, 0.4]},
        "depth_um": 100,
    }
    part = {"name": "p", "records": 24, "machine": {"rig": "gearbox"}, "operation": {"speed_rpm": 1500}}
    recipe = parse_recipe(
        {
            "name": "small",
            "seed": 6,
            "signal": {"rate_hz": 65536, "duration_s": 0.3},
            "store": {"clean": True},
            "split": {"train": 1.0, "validation": 0.0, "test": 0.0},
            "part": [part | {"defect": defect}],
        },
        Path("recipe.toml"),
    )
    assert generate(recipe, folder, engine=Engine(workers=1)).complete
    return folder


def columns(**changes: object) -> TrialColumns:
    """Four trials as stored, of as many bearings: a clean one and a noisy one with events, two without."""
    gone = np.nan
    four = TrialColumns(
        bearing=np.array(["a", "b", "c", "d"]), stored=np.ones(4, dtype=np.bool_),
        clean=np.array([True, False, True, False]), asked=np.array([True, True, False, False]),
        typical=np.ones(4, dtype=np.bool_), true_lag=np.array([20.0, 30.0, gone, 1.9]),
        lag=np.array([20.0, 30.0, gone, 1.9]), arc=np.array([0.1, 0.2, gone, 0.01]), period=np.full(4, 100.0),
    )  # fmt: skip
    return replace(four, **changes)  # type: ignore[arg-type]


def test_the_reach_holds_ninety_per_cent_of_the_usual_errors_that_are_known() -> None:
    missed = np.concatenate([np.arange(101.0), [np.nan, 1e6]])  # the 90 % quantile of 0 to 100 is 90
    usual = np.append(np.ones(102, dtype=np.bool_), False)
    assert reach(missed, usual) == pytest.approx(90.0)
    with pytest.raises(BadInput, match="no reach"):
        reach(missed, np.zeros(103, dtype=np.bool_))


def test_masks_say_which_trials_a_stage_looks_at() -> None:
    four = columns(true_lag=np.array([1.9, 2.0, 2.9, 3.0]))
    assert four.eventless.tolist() == [True, False, False, False]
    assert four.decided.tolist() == [True, False, False, True]
    assert columns().eventless.tolist() == [False, False, True, True]
    assert columns().decided.all()
    flags = {
        "stored": [False, True, True, True, True, True],
        "clean": [True, True, False, True, True, True],
        "asked": [True, True, True, False, True, True],
        "typical": [True, True, True, True, False, True],
    }
    six = columns(true_lag=np.full(6, np.nan), **{name: np.array(values) for name, values in flags.items()})
    assert six.eventless.tolist() == [False, True, True, True, True, True]
    assert six.as_stored.tolist() == [False, True, True, True, False, True]
    assert six.asked_as_stored.tolist() == [False, True, True, False, False, True]
    assert six.asked_clean.tolist() == [True, True, False, False, False, True]


def test_the_most_doubt_leaves_nearly_all_trials_without_events_unanswered() -> None:
    error, expected = np.array([0.01, 0.5, np.nan, 9.0]), np.array([0.1, 0.2, 0.3, 0.8])
    assert most_doubt(columns(), error, expected) == pytest.approx(0.3 + 0.02 * 0.5)  # 2 % of the way from 0.3 to 0.8
    # Clean ones that would be 50 % wrong up to there are cut off behind the last that keeps the mean below 4.5 %.
    clean = np.array([True, True, False, False])
    assert most_doubt(columns(clean=clean), error, expected) == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"bearing": np.array(["a", "a", "b", "b"])}, "bearings = 2: too few"),
        ({"true_lag": np.full(4, 20.0)}, "no record without events"),
        ({"lag": np.array([20.0, np.nan, np.nan, np.nan])}, "too few bearings with events that are known"),
        ({"arc": np.array([0.1, np.nan, np.nan, -0.1])}, "too few bearings with events that are known"),
        ({"typical": np.array([False, False, True, True]), "lag": np.array([20.0, 30.0, np.nan, np.nan])}, "reach"),
    ],
)
def test_trials_that_do_not_suffice_are_refused_before_the_first_stage(
    change: dict[str, object], problem: str, small_ladder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.setattr(TrialColumns, "of", classmethod(lambda *_: columns(**change)))
    monkeypatch.setattr(fit, "trials", lambda *_: [])
    monkeypatch.setattr(fit, "fit_calibration", lambda *_: pytest.fail("it was fitting already"))
    assert fit.main([str(small_ladder), "--out", str(tmp_path / "c.npz")]) == 2
    assert problem in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["CORPUS", "CORPUS"], "--out"),  # the last is a corpus and no file
        (["CORPUS", "--out", "CORPUS"], "this is a folder"),
        (["CORPUS", "--out", "CORPUS/none/c.npz"], "no such folder"),
        (["CORPUS", "--out", "c.npz", "--workers", "0"], "--workers = 0"),
        (["CORPUS", "CORPUS/shards", "--out", "c.npz"], "shards"),
        (["TESTS", "--out", "c.npz"], "no records to learn from"),
        (["--out", "c.npz"], "CORPUS"),
    ],
)
def test_arguments_that_cannot_be_used_are_refused_before_any_work(
    arguments: list[str], problem: str, small_ladder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    tests = tmp_path / "tests"
    shutil.copytree(small_ladder, tests)
    index = tests / "index.csv"
    index.write_text(index.read_text().replace(",train,", ",test,"))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(fit, "trials", lambda *_: pytest.fail("it was at work already"))
    with pytest.raises(SystemExit) if problem in ("--out", "CORPUS") else nullcontext() as refused:
        places = [one.replace("CORPUS", str(small_ladder)).replace("TESTS", str(tests)) for one in arguments]
        assert fit.main(places) == 2
    assert refused is None or refused.value.code == 2
    assert problem in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["tests"]


@pytest.mark.parametrize("name", ["calibration.npz", "calibration"])
def test_the_file_is_whole_under_the_name_that_was_given(
    name: str, small_ladder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fit, "trials", lambda *_: [])
    monkeypatch.setattr(TrialColumns, "of", classmethod(lambda *_: columns()))
    monkeypatch.setattr(fit, "fit_calibration", lambda *_: default_estimator().calibration)
    (tmp_path / name).write_text("old")
    assert fit.main([str(small_ladder), "--out", str(tmp_path / name)]) == 0
    with np.load(tmp_path / name) as file:
        again = Calibration.from_arrays({key: file[key] for key in file.files})
    assert again.with_load.most == default_estimator().calibration.with_load.most
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_file_that_cannot_be_finished_leaves_the_old_one(
    small_ladder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(fit, "trials", lambda *_: [])
    monkeypatch.setattr(TrialColumns, "of", classmethod(lambda *_: columns()))
    monkeypatch.setattr(fit, "fit_calibration", lambda *_: default_estimator().calibration)
    monkeypatch.setattr("datagen.files.atomic.os.fsync", full)
    (tmp_path / "c.npz").write_text("old")
    assert fit.main([str(small_ladder), "--out", str(tmp_path / "c.npz")]) == 2
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("c.npz", "old")]


class Names:
    """What was learned from some trials: it says of any pairs which bearings these were of."""

    def __init__(self, made: list[SimpleNamespace]) -> None:
        self.bearings = {trial.bearing_id for trial in made}

    def predict(self, features: object) -> set[str]:
        return self.bearings


def test_pairs_are_scored_by_what_was_learned_from_other_bearings(monkeypatch: pytest.MonkeyPatch) -> None:
    bearing = np.repeat(["a", "b", "c", "d", "e"], 3)
    evidence = SimpleNamespace(pairs=SimpleNamespace(features=None))
    made: Any = [SimpleNamespace(bearing_id=name, evidence=evidence) for name in bearing.tolist()]
    monkeypatch.setattr(fit_stages, "_pair_score", Names)
    found: Any = fit_stages.fit_pair_score(made, bearing)
    assert found.trees.bearings == set("abcde")  # the model that is kept has learned from all
    for name, others in zip(bearing.tolist(), found.scores, strict=True):
        assert name not in others
        assert len(others) in (3, 4)


class Watched:
    """Regressions that are asked out of fold alone, and of which bearings the rows are that they are asked about."""

    def __init__(self) -> None:
        self.groups: list[str] = []

    def fit(self, *_: object) -> None:
        """Nothing that could be asked."""

    def out_of_fold(self, rows: Array, aim: Array, used: Array, groups: Array, weight: object = None) -> Array:
        self.groups = groups.tolist()
        return np.asarray(aim)


def test_pairs_are_ranked_by_what_was_learned_from_other_bearings(monkeypatch: pytest.MonkeyPatch) -> None:
    lags = {"a": [3.0, 5.0], "b": [7.0, 9.0, 11.0], "c": [13.0]}
    monkeypatch.setattr(fit_stages, "leading_view", lambda evidence, *_: evidence)
    monkeypatch.setattr(fit_stages, "leading_rows", lambda view: np.zeros((view.lag.size, 2)))
    watched = Watched()
    monkeypatch.setattr(fit_stages, "RANK", watched)
    made: Any = [
        SimpleNamespace(
            evidence=SimpleNamespace(
                **dict.fromkeys(("entry", "exit", "lag", "lag_arc"), np.array(lag)), order=np.arange(len(lag))
            ),
            situation=None,
            quality=np.arange(len(lag)),
        )
        for lag in lags.values()
    ]
    found = fit_stages.fit_rank(made, [np.zeros(0)] * 3, np.array(list(lags)))
    assert watched.groups == ["a", "a", "b", "b", "b", "c"]
    assert found.lag.tolist() == [5.0, 11.0, 13.0]  # those of the best quality


def test_guesses_learn_the_lag_less_whole_passes_and_reach_over_the_records_given_a_size(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lag, doubts = np.array([10.0, 30.0, 5.0, 5.0]), np.array([0.1, 0.9, 0.5, 0.5])
    asked = []

    def guessed(rows: Array, error: Array, bearing: Array) -> FittedGuess:
        asked.append(error)
        nothing: Any = None
        return FittedGuess(Guess(nothing, nothing, 1.0), np.zeros(4), np.array([1.0, 5.0, 7.0, 9.0]))

    monkeypatch.setattr(fit, "fit_rank", lambda *_: SimpleNamespace(trees=None, lag=lag, lag_arc=lag / 100, rows=None))
    monkeypatch.setattr(fit, "fit_guess", guessed)
    monkeypatch.setattr(fit, "fit_doubt", lambda *_: SimpleNamespace(trees=None, expected=doubts))
    longer = columns(true_lag=np.array([120.0, 30.0, np.nan, 1.9]))  # by a whole pass
    judgement, _ = fit._judgement([], longer, [])
    np.testing.assert_allclose(asked[0], np.log(np.array([20.0, 30.0, np.nan, 1.9]) / lag))
    np.testing.assert_allclose(asked[1], np.log(np.array([0.1, 0.2, np.nan, 0.01]) / (lag / 100)))
    # The clean one is wrong by more than is allowed, so no more is answered than it; intervals reach as far as it does.
    assert judgement.most == pytest.approx(0.1)
    assert judgement.lag.reach == judgement.arc.reach == pytest.approx(1.0)


@pytest.mark.slow
def test_trials_know_which_pairs_are_the_events(small_ladder: Path) -> None:
    made = trials(small_ladder, ("train",), 1)
    whole = [trial for trial in made if trial.evidence.alignment.place.max() > 0.8 * 0.3 * 65536]
    assert len([trial for trial in made if trial.stored]) == 24  # as stored
    assert len(whole) == 2 * 24  # and with noise
    assert len(made) > 2 * 24 + 12  # and a part, if that holds passes enough
    assert all(trial.clean == trial.stored for trial in made)  # the corpus has no noise
    for trial in made:  # spalls are at least a tenth of a spacing long, so that five samples are the only bar
        assert trial.asked == (trial.true_lag >= 5.0 and trial.true_lag >= trial.evidence.mean.period / 50.0)
    with_events = [trial for trial in made if np.isfinite(trial.lag)]
    assert len(with_events) > 20
    for trial in with_events:
        best = trial.quality.argmax()
        if trial.quality[best] > 0.9:  # by its definition within 1.3 % of the lag beyond half a sample
            near = 0.5 + 0.013 * trial.lag
            assert trial.evidence.pairs.lag[best] == pytest.approx(trial.lag, rel=0.0, abs=near)


@pytest.mark.slow
def test_a_fit_to_few_records_gives_a_calibration_that_estimates(small_ladder: Path, tmp_path: Path) -> None:
    assert fit.main([str(small_ladder), "--out", str(tmp_path / "calibration.npz"), "--workers", "1"]) == 0
    with np.load(tmp_path / "calibration.npz") as file:
        learned = Calibration.from_arrays({name: file[name] for name in file.files})
    estimator = SizeEstimator(learned)
    estimates = [estimator.estimate(one.acceleration, one.rate, one.situation) for one in sized_records(small_ladder)]
    assert len(estimates) == 24
    assert {one.outcome for one in estimates} <= {SizeOutcome.ESTIMATED, SizeOutcome.NO_EVENT_PAIR}
    assert all(one.extent_interval[0] < one.extent < one.extent_interval[1] for one in estimates if one.found)
