"""What another draw of the training set changes: python docs/make_draws.py TRAIN OUT TEST…

Learns five times from four fifths of the virtual machines of TRAIN, drawn anew each time, and scores on every TEST. OUT
gets the scores, from which `docs/make_transfer.py` makes its table.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from transfer_page import ODD, require_different_names

from datagen.benchmark.chosen import chosen_records
from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.machines import learned_machines
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.summary import race_balance
from datagen.benchmark.training import TrainingSet, train_models, train_rule, training_records, training_set
from datagen.benchmark.verdicts import Judges, Tested
from datagen.corpus import Corpus
from datagen.judging.scored_runs import write_line
from physics.bearing import RACES

DRAWS, SHARE, SEED = 5, 0.8, 100


def drawn(training: TrainingSet, draw: int) -> TrainingSet:
    """The rows of four fifths of the virtual machines."""
    machines = np.random.default_rng(SEED + draw).permutation(np.unique(training.bearings))
    return training.subset(np.isin(training.bearings, machines[: int(SHARE * machines.size)]))


def scores(tested: Tested) -> dict[str, dict[str, float | None]]:
    """By model: balanced accuracy over outer and inner without the odd records, and the share of false alarms."""
    faulty = np.isin(tested.truth, RACES) & ~np.isin(tested.chosen.labels["recording"].astype(str), ODD)
    healthy = tested.truth == "none"
    return {
        said.name: {
            "faults": race_balance(tested.truth[faulty], said.location[faulty]) if faulty.any() else None,
            "false_alarms": float(np.isin(said.location[healthy], RACES).mean()) if healthy.any() else None,
        }
        for said in tested.verdicts
    }


def main(train: Path, out: Path, tests: list[Path]) -> None:
    """Write the scores of all draws; raises BadInput before anything is learned."""
    require_different_names(tests)
    benchmark = Benchmark(train, tuple(tests))
    labels = training_records(train, False)
    training = training_set(train, labels, benchmark.training_reading(), 1)
    learned = learned_machines(Corpus(train), labels["record"].to_numpy(np.int64))
    chosen = [chosen_records(folder, learned) for folder in tests]
    rows = [read_rows(records.folder, records.numbers, benchmark.reading(), 1) for records in chosen]
    found: dict[str, Any] = {folder.name: [] for folder in tests}
    for draw in range(DRAWS):
        part = drawn(training, draw)
        judges = Judges(train_rule(part), train_models(part, "all"))
        for records, found_in in zip(chosen, rows, strict=True):
            by_model = scores(judges.judge(records, found_in))
            found[records.folder.name].append(by_model)
            if records.imported:
                write_line(records.folder, {"draw": draw, "train": str(train), "scores": by_model})
        out.write_text(json.dumps(found, indent=1))


def command_line() -> argparse.Namespace:
    """What was asked for on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("train", type=Path, metavar="TRAIN", help="corpus to learn from")
    parser.add_argument("out", type=Path, metavar="OUT", help="JSON file for the scores")
    parser.add_argument("tests", nargs="+", type=Path, metavar="TEST", help="corpus to score on")
    return parser.parse_args()


if __name__ == "__main__":
    asked = command_line()
    main(asked.train, asked.out, asked.tests)
