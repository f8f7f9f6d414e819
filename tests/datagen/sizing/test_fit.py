"""The calibration fitted anew to a small corpus: it must come out whole, however little such a fit knows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from datagen.recipes.recipe import parse_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from datagen.sizing.fit import OutOfFold, main
from datagen.sizing.sized_records import sized_records
from datagen.sizing.training_rows import trials
from labels.spall_size.calibration import Calibration
from labels.spall_size.estimator import SizeEstimator
from labels.spall_size.size_estimate import SizeOutcome


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


def test_the_reach_holds_ninety_per_cent_of_the_usual_errors_that_are_known() -> None:
    missed = np.concatenate([np.arange(101.0), [np.nan, 1e6]])  # the 90 % quantile of 0 to 100 is 90
    usual = np.append(np.ones(102, dtype=np.bool_), False)
    assert OutOfFold(np.zeros(103), missed).reach(usual) == pytest.approx(90.0)


@pytest.mark.slow
def test_trials_know_which_pairs_are_the_events(small_ladder: Path) -> None:
    made = trials(small_ladder, ("train",))
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
    main([str(small_ladder)], str(tmp_path / "calibration.npz"), workers=1)
    with np.load(tmp_path / "calibration.npz") as file:
        learned = Calibration.from_arrays({name: file[name] for name in file.files})
    estimator = SizeEstimator(learned)
    told = [
        estimator.estimate(one.acceleration, one.rate, one.situation)
        for one in sized_records(small_ladder, load_known=True)
    ]
    assert len(told) == 24
    assert {one.outcome for one in told} <= {SizeOutcome.ESTIMATED, SizeOutcome.NO_EVENT_PAIR}
    assert all(one.extent_interval[0] < one.extent < one.extent_interval[1] for one in told if one.found)
