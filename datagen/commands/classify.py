"""`spallgen classify`: learn from one corpus, score on others."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from datagen.benchmark.options import SAVE, TEST_ON, TRAIN, TRANSFER_ROWS, Learning, Options, Scoring
from datagen.commands.grouped import grouped
from datagen.commands.program import JsonFile, command, show_tables, write_json
from datagen.commands.progress_display import show_steps
from datagen.counts import bracketed, counted
from datagen.files.places import require_results_folder
from datagen.judging.stated_speed import SPEED_ERROR
from datagen.processes import MOST_WORKERS
from labels.interval import Interval
from labels.schema import HEALTHY, LOCATIONS, UNKNOWN

if TYPE_CHECKING:
    from datagen.benchmark.model_scores import Scores
    from datagen.benchmark.plan import Benchmark
    from datagen.benchmark.results import CorpusResults, CorpusScores, Results

Option, Argument = typer.Option, typer.Argument
AS_USUAL = Options()
IN_MAINS = (
    "balls may pass the {race} race at a multiple of 50 or 60 Hz, which is not counted: a fault of it is hardly seen "
    "then"
)
IN_SHAFT = (
    "balls pass the {race} race at a multiple of the shaft's speed, which is not counted: a fault of it is hardly seen "
    "unless the cage slips"
)
FEW_BANDS = (
    "balls pass so fast for the bandwidth that is looked at that impacts ring into each other: a fault is hardly seen; "
    "see --bandwidth"
)
FAR_FROM_STATED = (
    "the shaft was found about as far from its stated speed as is searched: if that is wrong by still more, lines of "
    "one race are taken for those of the other"
)
Train = Annotated[
    Path,
    Option(
        TRAIN,
        metavar="DIR|FILE",
        help="Simulated corpus to learn from, or a file that --save wrote; transfer-rows are the features of the "
        "corpus transfer, which come with the program; impulse-trains, or impulse-trains-without-INGREDIENT, to "
        "compare with signals without contact physics, which are made on the spot (docs/own_estimators.md).",
    ),
]
Folders = Annotated[list[Path] | None, Option(TEST_ON, metavar="DIR", help="Corpus to score on; may be given again.")]
Save = Annotated[Path | None, Option(SAVE, metavar="FILE", help="Save what was learned; --train FILE takes it later.")]
More = Annotated[list[Path] | None, Argument(metavar="DIR", help="More corpora to score on.")]
# The options that stand for the fields of Learning and Scoring, by their names.
OPTIONS = {
    "learner": Option(help="Model to train: forest, logistic, boosting or all."),
    "estimator": Option(metavar="MODULE:NAME", help="Your own scikit-learn estimator, or a function."),
    "input": Option("--input", help="Input of your estimator: features or windows."),
    "bandwidth": Option(metavar="HZ", help="Limit every record to this; 20000 or 0.95 of half its rate if not given."),
    "speed_error": Option(
        metavar="SHARE", help=f"Largest relative error of the shaft speeds used in training, 0 to {SPEED_ERROR}."
    ),
    "first": Option(metavar="N", min=1, help="Learn from only the first N records."),
    "reject": Option(
        "--reject",
        min=0.0,
        max=1.0,
        help="Reject a record if its most likely answer has a lower probability than this.",
    ),
    "noise_db": Option(
        metavar="DB,DB",
        help="Also score recordings, of corpora with faults, with white noise added at these signal-to-noise ratios.",
    ),
    "noise_draws": Option(metavar="N", min=1, help="How many times that noise is drawn."),
}
Curve = Annotated[bool, Option(help="Also learn from fractions of the corpus.")]
Workers = Annotated[
    int,
    Option(
        metavar="N",
        min=1,
        max=MOST_WORKERS,
        help="Processes that compute features; few by default, as each holds a record in memory.",
    ),
]
Out = Annotated[Path | None, Option("--out", metavar="DIR", help="Folder for report.json, report.png and report.csv.")]


@command("spallgen classify --test out/my_machine --out out/said")
@grouped(OPTIONS)
def classify(
    train: Train = Path(TRANSFER_ROWS),
    test: Folders = None,
    more: More = None,
    learning: Learning = AS_USUAL.learning,
    scoring: Scoring = AS_USUAL.scoring,
    learning_curve: Curve = False,
    workers: Workers = 2,
    save: Save = None,
    out: Out = None,
    json_file: JsonFile = None,
) -> None:
    """Learn health and fault location from a simulated corpus; score the models on corpora, simulated or imported.

    A corpus that shares virtual bearings with the one to learn from (the same folder, or a corpus of a recipe with the
    same seed) is divided by its label split, so that no bearing is both learned from and scored. Every run on imported
    recordings is logged in their folder, in scored_runs.jsonl. A file written by --save is a pickle, which can run any
    program when it is loaded: use only your own.
    """
    from datagen.benchmark.plan import Benchmark
    from datagen.benchmark.request import checked

    asked = Benchmark(
        train=train,
        tests=(*(test or []), *(more or [])),
        options=Options(learning, scoring),
        learning_curve=learning_curve,
        workers=workers,
        save=save,
    )
    benchmark = checked(asked)
    if out is not None:
        require_results_folder(out)
    results = _run(benchmark, out)
    write_json(json_file, results.to_dict())
    print_results(results.tests)
    print_learning_curve(results)


def _run(benchmark: Benchmark, out: Path | None) -> Results:
    from datagen.benchmark.classify import run

    with show_steps() as listener:
        results = run(benchmark, listener)
    if out is not None:
        from datagen.benchmark.predictions import prediction_table
        from datagen.drawing.classifier_sheet import scores_png
        from datagen.files.results import results_folder, write_files

        models = list(results.tests[0].scores.models) if results.tests else []
        table = prediction_table(models, [(test.scores.corpus, test.predictions) for test in results.tests])
        write_files(results_folder(out), "report", scores_png(results), results.to_dict(), table)
    return results


def print_results(tests: list[CorpusResults]) -> None:
    """Print the scores of every corpus, and the answers about records that are not scored."""
    from datagen.commands.tables import verdict_table

    for test in tests:
        found = test.scores
        print(f"{found.corpus}: {counted(found.records, 'record')}: {_of_each(found.locations)}")
        scored = any(found.locations.get(location) for location in LOCATIONS)
        if not scored:
            print("  no scores  the true class of no record is known")
        for name, scores in found.models.items() if scored else ():
            print(f"  {name:10} {score_line(scores)}")
        for reason, count in found.rejections.items():
            print(f"  rejected   {count}: {reason}")
        print_mended(found)
        print_doubts(found)
        for noisy in test.noise if scored else ():
            for name, scores in noisy.scores.models.items():
                print(f"  {name:10} {noisy.snr_db:g} dB: {score_line(scores)}")
        unscored = [prediction for prediction in test.predictions if prediction.truth not in LOCATIONS]
        if unscored:
            show_tables([verdict_table(unscored, list(found.models))])


def print_doubts(found: CorpusScores) -> None:
    """Print how many records of a corpus may have a fault that is not seen, or were judged at a wrong speed."""
    for name, counts, meaning in (("in mains", found.in_mains, IN_MAINS), ("in shaft", found.in_shaft, IN_SHAFT)):
        for race, count in counts.items():
            if count:
                print(f"  {name}   {count}: {meaning.format(race=race)}")
    if found.few_bands:
        print(f"  few bands  {found.few_bands}: {FEW_BANDS}")
    if found.far_from_stated:
        print(f"  speeds     {found.far_from_stated}: {FAR_FROM_STATED}")


def print_learning_curve(results: Results) -> None:
    """Print the learning curve of every model, if one was asked for."""
    for model, points in results.learning_curve.items():
        for point in points:
            score = _interval(Interval(point["value"], point["low"], point["high"]))
            print(f"learning curve: {model} {score} from {counted(point['bearings'], 'virtual bearing')}")


def print_mended(found: CorpusScores) -> None:
    """Print what was taken out of the signals of a corpus before features were computed."""
    jumps, glitches, shocks = found.levelled["jumps"], found.despiked["glitches"], found.shocks_cut["shocks"]
    if jumps:
        print(f"  levelled   {counted(jumps, 'jump')} in {counted(found.levelled['records'], 'record')}")
    if glitches:
        print(f"  despiked   {counted(glitches, 'glitch', 'es')} in {counted(found.despiked['records'], 'record')}")
    if shocks:
        print(f"  shocks cut {shocks} in {counted(found.shocks_cut['records'], 'record')}")


def score_line(scores: Scores) -> str:
    """The scores of one model in one line."""
    parts = [f"{word} {_interval(found)}" for word, found in scores.headline.items()]
    share = bracketed(scores.false_alarm_share)
    counts = (
        f"false alarms {scores.false_alarms}/{scores.healthy}{share}{_bearings(scores)}",
        f"rejected {scores.rejected}",
    )
    if scores.calibration:
        error = scores.calibration.calibration_error
        parts.append(f"calibration error {error.value:.3f}{bracketed(error)}")
    return ", ".join([*parts, *counts])


def _of_each(locations: Mapping[str, int]) -> str:
    """How many records there are of each true location that any has, in the words of people."""
    words = {"none": HEALTHY, UNKNOWN: "not scored"}
    return ", ".join(f"{count} {words.get(location, location)}" for location, count in locations.items() if count)


def _bearings(scores: Scores) -> str:
    """How many of the healthy bearings had a false alarm, and of how many healthy records the bearing is unknown; empty
    without healthy records."""
    known, unknown = scores.healthy_bearings, scores.healthy_of_unknown_bearing
    parts = [f"{scores.alarming_bearings}/{known} bearings"] if known else []
    if unknown:
        parts.append(f"{unknown} of unknown bearings" if known else "bearings unknown")
    return f" ({', '.join(parts)})" if parts else ""


def _interval(found: Interval) -> str:
    if not math.isfinite(found.value):
        return "–"
    return f"{found.value:.3f}{bracketed(found)}"
