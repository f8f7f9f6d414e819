"""How fast records are judged: features and verdicts of `classify`, and the estimates of `size`.

PYTHONPATH=. python tests/benchmarks/judging.py [--records 1000] [--sizes 40] [--workers 2] writes docs/judging.json and
the tables of docs/pipeline.md: wall clock on a machine that does nothing else, corpora made beforehand and learners
trained; and how large a process becomes.
"""

from __future__ import annotations

import argparse
import json
import statistics
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from datagen.benchmark.chosen import chosen_records
from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.training import COPIES_DB, LOWEST_BANDWIDTH, train_models, train_rule, training_set
from datagen.benchmark.verdicts import Judges
from datagen.corpus import Corpus
from datagen.judging.stated_speed import SPEED_ERROR
from datagen.recipes.recipe import load_recipe
from datagen.runs.generate import generate
from datagen.sizing.estimators import default_estimator
from datagen.sizing.sized_records import sized_records
from datagen.versions import in_words, measured_on
from docs.marked_tables import write_marked
from tests.benchmarks.resident import by_number, largest_resident

ROOT = Path(__file__).resolve().parents[2]
LEARNED_FROM = 160
RESIDENT = (50, 400)
Result = TypeVar("Result")
TRAINING = Reading(speed_error=SPEED_ERROR, lowest_bandwidth=LOWEST_BANDWIDTH, copies_db=COPIES_DB)


def made(name: str, folder: Path, records: list[int]) -> Path:
    """A corpus of these records of the dataset `name`."""
    generate(load_recipe(ROOT / "datasets" / name), folder, records=records)
    return folder


def spread(name: str, count: int) -> list[int]:
    """So many records all over the dataset `name`, of all its parts."""
    return np.linspace(0, load_recipe(ROOT / "datasets" / name).count - 1, count).round().astype(int).tolist()


def timed(work: Callable[[], Result]) -> tuple[float, Result]:
    """Wall-clock seconds of the work, and what came of it."""
    begin = time.perf_counter()
    result = work()
    return time.perf_counter() - begin, result


def classifying(scratch: Path, records: int, workers: int) -> dict[str, float]:
    """Seconds that features and verdicts of `records` of `corpus` take, of one second and two axes each."""
    training = made("transfer", scratch / "transfer", list(range(LEARNED_FROM)))
    labels = Corpus(training).labels
    learned = training_set(training, labels, TRAINING, workers)
    judges = Judges(train_rule(learned), train_models(learned, "all"))
    folder = made("corpus", scratch / "corpus", spread("corpus", records))
    tested = chosen_records(folder, None)
    read_rows(folder, tested.numbers[:48], Reading(), workers)  # what is loaded at first use is there
    features, rows = timed(partial(read_rows, folder, tested.numbers, Reading(), workers))
    verdicts, _ = timed(partial(judges.judge, tested, rows))
    return {"features_s": features, "verdicts_s": verdicts}


def sizing(scratch: Path, records: int) -> dict[str, float]:
    """Median and largest seconds an estimate of a record of `size_ladder` takes, one process, reading not included."""
    folder = made("size_ladder", scratch / "size_ladder", spread("size_ladder", records))
    estimator = default_estimator()
    asked = list(sized_records(folder))
    estimator.estimate(asked[0].acceleration, asked[0].rate, asked[0].situation)
    spent = [timed(partial(estimator.estimate, one.acceleration, one.rate, one.situation))[0] for one in asked]
    return {"median_s": statistics.median(spent), "longest_s": max(spent), "records": len(asked)}


def resident(scratch: Path) -> dict[str, dict[str, float]]:
    """Largest resident size (MB) of a process that judges a corpus by itself, by command and number of records."""
    work = {"features": ("corpus", ("--out", str(scratch / "features.csv"))), "size": ("size_ladder", ())}
    return {
        command: {
            str(records): largest_resident(
                command, str(made(name, scratch / f"{name}_{records}", spread(name, records))), "--workers", "1", *more
            )
            for records in RESIDENT
        }
        for command, (name, more) in work.items()
    }


def page(report: dict[str, Any]) -> str:
    """The tables of the report, measured now or read from its file, as Markdown."""
    classified, sized, largest = report["classify"], report["size"], report["resident_mb"]
    return "\n".join(
        [
            "| what | seconds |",
            "|---|---|",
            f"| features of {report['records']} records of 1 s, two axes, {report['workers']} workers | "
            f"{classified['features_s']:.1f} |",
            f"| verdicts on them by the rule and all three learners | {classified['verdicts_s']:.1f} |",
            f"| size of the spall in one record of 1 s at 65 536 Hz, median of {sized['records']:.0f} | "
            f"{sized['median_s']:.2f} |",
            f"| the longest of them | {sized['longest_s']:.2f} |",
            "",
            "| one process, by records judged | largest resident size |",
            "|---|---|",
            f"| `features` of `corpus` | {by_number(largest['features'])} |",
            f"| `size` of `size_ladder` | {by_number(largest['size'])} |",
            "",
            f"Wall clock. Measured on {in_words(report['made_with'])}.",
        ]
    )


def main() -> None:
    """Measure, and write both files."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--records", type=int, default=1000)
    parser.add_argument("--sizes", type=int, default=40)
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="spallgen-judging-") as name:
        scratch = Path(name)
        report = {
            "records": options.records,
            "workers": options.workers,
            "made_with": measured_on("numpy", "scipy", "scikit-learn", "numba"),
            "classify": classifying(scratch, options.records, options.workers),
            "size": sizing(scratch, options.sizes),
            "resident_mb": resident(scratch),
        }
    (ROOT / "docs" / "judging.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    table = page(report)
    write_marked(ROOT / "docs" / "pipeline.md", "judging", __file__, table)
    print(table)


if __name__ == "__main__":
    main()
