"""How well faults in noise are told from healthy recordings: python docs/make_noise_auc.py TRAIN CORPUS…

Hardly a set of recordings has healthy ones enough for an interval of the area under the ROC. So the faults of each
CORPUS are set against the healthy recordings of all of them, with white noise as high over their own RMS. Keeps the
areas in docs/noise_auc.json and writes the table of docs/transfer.md.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from marked_tables import write_marked
from numpy.typing import NDArray
from transfer_page import NOISE_AUC, PAGE, interval, require_different_names

from datagen.benchmark.chosen import ChosenRecords, chosen_records
from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.training import train_models, train_rule
from datagen.benchmark.training_source import source_of
from datagen.benchmark.verdicts import Judges, Tested, pool
from datagen.files.plain import plain_json
from datagen.files.text_tables import markdown_table
from datagen.judging.scored_runs import write_line
from datagen.progress import SILENT
from labels.classifier.scores import area_interval
from labels.interval import Interval
from physics.arrays import Array
from physics.bearing import RACES

LEVELS_DB, DRAWS = (-10.0, -13.0, -16.0), 3


class Ranked(NamedTuple):
    """Verdicts (N,) on recordings, all draws of the noise together: which recording each is of, and the `score` of the
    rule and of each learner by name."""

    recording: NDArray[np.str_]
    score: dict[str, Array]


def ranked(tested: Tested, wanted: NDArray[np.bool_]) -> Ranked:
    """The `wanted` (N,) ones of all verdicts on a corpus."""
    names = np.char.add(f"{tested.chosen.folder.name}/", tested.owner.astype(np.str_))
    return Ranked(names[wanted], {said.name: said.score[wanted] for said in tested.verdicts})


def together(parts: Sequence[Ranked]) -> Ranked:
    """All of the `parts`."""
    score = {name: np.concatenate([part.score[name] for part in parts]) for name in parts[0].score}
    return Ranked(np.concatenate([part.recording for part in parts]), score)


def areas(faulty: Ranked, healthy: Ranked) -> dict[str, Any]:
    """By model the area under the ROC and, of a learner, by how much it exceeds that of the rule, with 95 % intervals
    from a bootstrap over recordings. Verdicts without a score are left out."""
    both = together([faulty, healthy])
    positive = np.arange(both.recording.size) < faulty.recording.size
    rule, *learners = both.score
    found: dict[str, dict[str, Interval]] = {}
    for name in (rule, *learners):
        known = np.isfinite(both.score[name]) & np.isfinite(both.score[rule])
        truth, owner = positive[known], both.recording[known]
        found[name] = {"area": area_interval(truth, both.score[name][known], groups=owner)}
        if name != rule:
            rival = both.score[rule][known]
            found[name]["minus_rule"] = area_interval(truth, both.score[name][known], rival, groups=owner)
    return {name: {what: asdict(value) for what, value in of_model.items()} for name, of_model in found.items()}


def in_noise(judges: Judges, benchmark: Benchmark, chosen: ChosenRecords, level: float, draws: int) -> Tested:
    """What is said of a corpus at a level (signal over noise, dB), so many draws of the noise one after the other."""
    readings = [replace(benchmark.reading(), noise_db=level, noise_draw=draw) for draw in range(draws)]
    return pool(
        [
            judges.judge(chosen, read_rows(chosen.folder, chosen.numbers, reading, benchmark.workers))
            for reading in readings
        ]
    )


def measure(train: Path, folders: Sequence[Path], draws: int, workers: int) -> dict[str, Any]:
    """The areas of each corpus with faults at each level; raises BadInput before anything is learned."""
    require_different_names(folders)
    benchmark = Benchmark(train, tuple(folders), workers=workers)
    chosen = [chosen_records(folder, None) for folder in folders]
    training = source_of(benchmark).features(SILENT)
    judges = Judges(train_rule(training), train_models(training, "all"))
    found: dict[str, dict[str, Any]] = {}
    for level in LEVELS_DB:
        tested = [in_noise(judges, benchmark, records, level, draws) for records in chosen]
        healthy = together([ranked(one, one.truth == "none") for one in tested])
        for one in tested:
            faulty = np.isin(one.truth, RACES)
            if faulty.any():
                of_corpus = areas(ranked(one, faulty), healthy)
                write_line(one.chosen.folder, {"noise_db": level, "train": str(train), "areas": of_corpus})
                found.setdefault(one.chosen.folder.name, {})[f"{level:g}"] = of_corpus
                print(one.chosen.folder.name, level, of_corpus, flush=True)
    count = sum(int((records.labels["location"] == "none").sum()) for records in chosen)
    return {"draws": draws, "healthy": count, "corpora": found}


def table(kept: dict[str, Any]) -> str:
    """One row a corpus and level, and what it was made of."""
    rows = []
    for corpus, levels in kept["corpora"].items():
        for level, models in levels.items():
            rule, *learners = models.items()
            cells = [f"{interval(said['area'])}; {interval(said['minus_rule'])}" for _, said in learners]
            rows.append([corpus, level.replace("-", "−"), interval(rule[1]["area"]), *cells])
    names = list(next(iter(next(iter(kept["corpora"].values())).values())))
    head = ["faults of", "dB", names[0], *(f"{name}; minus {names[0]}" for name in names[1:])]
    return (
        f"{markdown_table(head, rows)}\n\nAgainst {kept['healthy']} healthy recordings of all sets; "
        f"{kept['draws']} draws of the noise."
    )


def main() -> None:
    """Measure, keep the areas and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("train", type=Path, metavar="TRAIN", help="what to learn from, such as transfer-rows")
    parser.add_argument("corpora", nargs="+", type=Path, metavar="CORPUS", help="recordings, faulty and healthy ones")
    parser.add_argument("--draws", type=int, default=DRAWS, help="draws of the noise")
    parser.add_argument("--workers", type=int, default=2, help="processes that read the recordings")
    asked = parser.parse_args()
    kept = json.loads(plain_json(measure(asked.train, asked.corpora, asked.draws, asked.workers)))
    NOISE_AUC.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    write_marked(PAGE, "noise auc", __file__, table(kept))


if __name__ == "__main__":
    main()
