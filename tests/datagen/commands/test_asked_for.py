"""What commands hand on of what was asked, each option to its own place."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from command_line import run

from datagen.errors import BadInput


@pytest.fixture
def handed_on(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What a command handed on before it was stopped."""
    found: dict[str, Any] = {}

    def stop(asked: Any, *more: Any) -> None:
        found.update(vars(asked), more=more)
        raise BadInput("stopped")

    monkeypatch.setattr("datagen.benchmark.request.checked", stop)
    monkeypatch.setattr("datagen.sizing.corpus_run.score_sizes", stop)
    return found


def test_classify_learns_and_scores_as_it_is_asked(handed_on: dict[str, Any]) -> None:
    options = ["--learner", "forest", "--bandwidth", "8000", "--speed-error", "0.01", "--first", "9", "--reject", "0.4"]
    more = ["--noise-db=-10,0", "--noise-draws", "3", "--learning-curve", "--workers", "5", "--save", "s", "--out", "o"]
    done = run("classify", "--train", "a", "--test", "b", "--test", "c", "d", "e", *options, *more)
    assert done.exit_code == 2
    assert handed_on["train"] == Path("a")
    assert handed_on["tests"] == tuple(map(Path, "bcde"))
    learning, scoring = handed_on["options"].learning, handed_on["options"].scoring
    told = (learning.learner, learning.bandwidth, learning.speed_error, learning.first)
    assert told == ("forest", 8000.0, 0.01, 9)
    assert (scoring.reject, scoring.levels, scoring.noise_draws) == (0.4, (-10.0, 0.0), 3)
    assert [handed_on[name] for name in ("learning_curve", "workers", "save")] == [True, 5, Path("s")]


def test_classify_learns_from_what_comes_with_the_program_by_default(handed_on: dict[str, Any]) -> None:
    assert run("classify", "b").exit_code == 2
    assert (handed_on["train"], handed_on["tests"]) == (Path("transfer-rows"), (Path("b"),))
    assert [handed_on[name] for name in ("learning_curve", "save")] == [False, None]


@pytest.mark.parametrize(("flag", "load_known"), [((), True), (("--blind",), False), (("--load-known",), True)])
def test_size_asks_as_it_is_asked(flag: tuple[str, ...], load_known: bool, handed_on: dict[str, Any]) -> None:
    sizes = ["--known-size", "3=1.5", "--known-size", "4=2"]
    done = run("size", "a", *flag, "--split", "validation", "--workers", "3", "--estimator", "m:C", *sizes)
    assert done.exit_code == 2
    workers, _ = handed_on.pop("more")
    assert workers == 3
    assert handed_on == {
        "folder": Path("a"),
        "estimator": "m:C",
        "load_known": load_known,
        "split": "validation",
        "sizes": {3: 1.5, 4: 2.0},
    }
