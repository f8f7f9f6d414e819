"""`spallgen classify`: learn from one corpus, score on others."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from datagen.commands.program import JsonFile, command, write_json

if TYPE_CHECKING:
    from datagen.benchmark.classify import Benchmark

Folders = Annotated[list[Path], typer.Option("--test", metavar="DIR", help="Corpus to score on; may be given again.")]


@command("spallgen classify --train out/transfer --test out/transfer --test out/cwru --out out/scores")
def classify(
    train: Annotated[Path, typer.Option("--train", metavar="DIR", help="Simulated corpus to learn from.")],
    test: Folders,
    more: Annotated[list[Path] | None, typer.Argument(metavar="[DIR]...", help="More corpora to score on.")] = None,
    learner: Annotated[str, typer.Option(help="forest, logistic, boosting or all.")] = "all",
    estimator: Annotated[
        str | None, typer.Option(metavar="MODULE:NAME", help="Your own scikit-learn estimator, or a function.")
    ] = None,
    inputs: Annotated[str, typer.Option("--input", help="What your estimator gets: features or windows.")] = "features",
    bandwidth: Annotated[
        float | None,
        typer.Option(metavar="HZ", help="Limit every record to this; 20000 or half its rate if not given."),
    ] = None,
    speed_error: Annotated[
        float, typer.Option(metavar="SHARE", help="By how much speeds told in training may be off, 0 to 0.02.")
    ] = 0.02,
    first: Annotated[int | None, typer.Option(metavar="N", min=1, help="Learn from the first N records only.")] = None,
    doubt: Annotated[
        float,
        typer.Option("--reject", min=0.0, max=1.0, help="Reject records of which what is said is less likely."),
    ] = 0.0,
    noise_db: Annotated[
        str, typer.Option(metavar="DB,DB", help="Also score recordings of faults with white noise at these ratios.")
    ] = "",
    noise_draws: Annotated[int, typer.Option(metavar="N", min=1, help="Draws of that noise.")] = 10,
    learning_curve: Annotated[bool, typer.Option(help="Also learn from shares of the corpus.")] = False,
    workers: Annotated[int, typer.Option(metavar="N", min=1, help="Processes that compute features.")] = 2,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder of report.json and .png.")] = None,
    json_file: JsonFile = None,
) -> None:
    """Learn health and location from a simulated corpus and score on corpora, simulated or imported.

    A corpus that is both learned from and tested on is divided by its label split, that is by virtual bearing. Every
    run on imported recordings is logged in their folder, in scored_runs.jsonl.
    """
    from datagen.benchmark.request import benchmark_of
    from datagen.plain import plain_json

    options: dict[str, Any] = {
        "learner": learner, "estimator": estimator, "input": inputs, "bandwidth": bandwidth,
        "speed_error": speed_error, "first": first, "reject": doubt,
        "noise_db": noise_db, "noise_draws": noise_draws,
    }  # fmt: skip
    benchmark = benchmark_of(train, (*test, *(more or [])), options, learning_curve, workers)
    results, pictures = _run(benchmark, out is not None)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        (out / "report.json").write_text(plain_json(results))
        (out / "report.png").write_bytes(pictures)
    write_json(json_file, results)
    _tell(results)


def _run(benchmark: Benchmark, draw: bool) -> tuple[dict[str, Any], bytes]:
    from datagen.benchmark.classify import run

    results, _ = run(benchmark, print)
    if not draw:
        return results, b""
    from datagen.drawing.scores import scores_png

    return results, scores_png(results)


def _tell(results: dict[str, Any]) -> None:
    for test in results["tests"]:
        print(f"{test['corpus']}: {test['records']} records, {test['locations']}")
        for name, scores in test["models"].items():
            print(f"  {name:10} {_line(scores)}")
        for noisy in test["noise"]:
            for name, scores in noisy["models"].items():
                print(f"  {name:10} {noisy['snr_db']:g} dB: {_line(scores)}")


def _line(scores: dict[str, Any]) -> str:
    parts = [
        f"{word} {_interval(scores[key])}"
        for word, key in (("faults", "faults_balanced_accuracy"), ("race", "race_accuracy"), ("AUC", "detection_auc"))
    ]
    return ", ".join(
        [*parts, f"false alarms {scores['false_alarms']}/{scores['healthy']}", f"rejected {scores['rejected']}"]
    )


def _interval(found: dict[str, float]) -> str:
    if not math.isfinite(found["value"]):
        return "–"
    bracket = f" [{found['low']:.3f}, {found['high']:.3f}]" if math.isfinite(found["low"]) else ""
    return f"{found['value']:.3f}{bracket}"
