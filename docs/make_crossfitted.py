"""How learners do on all machines of a corpus: python docs/make_crossfitted.py CORPUS

Its virtual machines are divided into fifths, and each is judged by the rule and by learners of the other four. That is
steadier than one split "test", whose machines may happen to be hard ones. The scores of all records together are kept
in docs/crossfitted.json, and the tables are written into docs/transfer.md.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from marked_tables import write_marked
from transfer_page import AUC, CROSSFITTED, FAULTS, PAGE, RACE, calibration, counted, interval

from datagen.benchmark.chosen import ChosenRecords
from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.results import CorpusScores
from datagen.benchmark.summary import summarise
from datagen.benchmark.training import train_models, train_rule, training_records, training_set
from datagen.benchmark.verdicts import Judges, Tested, pool
from datagen.corpus import Corpus
from datagen.files.text_tables import markdown_table
from labels.schema import CONDITIONS

FOLDS = 5
CONDITION, CONFUSION = "condition_balanced_accuracy", "condition_confusion"


def judged_by_others(folder: Path) -> list[Tested]:
    """What is said of the records of every fifth of the machines by what learned from the others."""
    benchmark = Benchmark(folder, (folder,))
    labels = training_records(folder, False)
    numbers = labels["record"].to_numpy(np.int64)
    training = training_set(folder, labels, benchmark.training_reading(), 1)
    found = read_rows(folder, numbers, benchmark.reading(), 1)
    parts = []
    for learned, judged in Corpus(folder).folds(FOLDS):
        part = training.subset(np.isin(training.rows.record, learned))
        judges = Judges(train_rule(part), train_models(part, "all"))
        parts.append(judges.judge(ChosenRecords(folder, labels[np.isin(numbers, judged)], False), found))
    return parts


def report(folder: Path, scores: CorpusScores) -> dict[str, Any]:
    """What is kept: the `scores`, and the hash of the physics that simulated the corpus in `folder`."""
    physics = Corpus(folder).manifest.identity.model_hash
    return {"physics": physics, "folds": FOLDS, "scores": replace(scores, corpus=folder.name).to_dict()}


def table(kept: dict[str, Any]) -> str:
    """One row a model, and what it was made of."""
    scores = kept["scores"]
    head = ["model", "outer and inner", "minus rule", "race alone", "AUC", "false alarms", "of healthy bearings"]
    head += ["calibration error"]
    rows = [
        [
            name,
            interval(said[FAULTS]),
            interval(said["minus_rule"][FAULTS]) if "minus_rule" in said else "",
            interval(said[RACE]),
            interval(said[AUC]),
            counted(said["false_alarms"], said["healthy"]),
            f"{said['alarming_bearings']} of {said['healthy_bearings']}",
            calibration(said),
        ]
        for name, said in scores["models"].items()
    ]
    records = f"{scores['records']} records of `{scores['corpus']}`, simulated by physics {kept['physics']}"
    return f"{markdown_table(head, rows)}\n\n{records}; its machines in {kept['folds']} parts."


def conditions(kept: dict[str, Any]) -> str:
    """One row a learner: how well it tells healthy, line and extended, and what it calls those of each."""
    scores = kept["scores"]
    counts = {name: said[CONFUSION]["counts"] for name, said in scores["models"].items() if CONFUSION in said}
    head = [
        "model",
        "healthy, line and extended",
        *(f"{truth}: called {', '.join(CONDITIONS)}" for truth in CONDITIONS),
    ]
    rows = [
        [
            name,
            interval(scores["models"][name][CONDITION]),
            *(", ".join(map(str, row[: len(CONDITIONS)])) for row in told),
        ]
        for name, told in counts.items()
    ]
    return markdown_table(head, rows)


def main(folder: Path) -> None:
    """Judge, keep the scores and write the tables."""
    kept = report(folder, summarise(pool(judged_by_others(folder))))
    CROSSFITTED.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    for name, made in (("crossfitted", table), ("conditions", conditions)):
        write_marked(PAGE, name, __file__, made(kept))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("corpus", type=Path, metavar="CORPUS", help="simulated corpus, such as out/transfer")
    main(parser.parse_args().corpus)
