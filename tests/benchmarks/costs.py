"""What a run costs beside its records: compiling, starting; how time goes with length and balls, memory with records
and shards; and how fast records and labels are read.

PYTHONPATH=. python tests/benchmarks/costs.py writes docs/costs.json and the tables of docs/pipeline.md. Compiling and
starting are wall clock of a run that makes one record, with an empty and with a filled cache of kernels; times of
responses are processor time, medians of rounds; memory is the largest resident size of a process that makes so many
records of `gearbox_rig`, and of the parent and its larger worker on the way of a run of many small shards. Reading is
wall clock on a machine that does nothing else: of a record, with everything that is always stored, of 2 s of
`quickstart` in zlib shards that were written just before, in random order; and of all labels of a corpus.
"""

from __future__ import annotations

import csv
import dataclasses
import json
import multiprocessing
import os
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from datagen.corpus import Corpus
from datagen.corpus_files.index import index_path
from datagen.distributions.distribution import Fixed
from datagen.freed_memory import keep_freed_memory
from datagen.recipes.recipe import load_recipe
from datagen.runs.generate import generate
from datagen.versions import in_words, measured_on
from docs.marked_tables import write_marked
from labels.variables import SIGNALS
from physics.reference_scenes import reference_scene
from physics.request import Accurate
from physics.scene import Scene
from physics.simulate import simulate
from physics.warming import warm_up
from tests.benchmarks.resident import by_number, largest_on_the_way, largest_resident

ROOT = Path(__file__).resolve().parents[2]
RATE, ROUNDS, SLIP_SEED = 65536.0, 5, 1
LENGTHS, BALLS, RECORDS = (0.5, 1.0, 2.0, 4.0, 8.0), (8, 12, 16, 24, 32), (16, 64, 192)
READ_RECORDS, READ_SECONDS, READ_LABELS = 48, 2.0, 10_000
ALWAYS_STORED = [signal.name for signal in SIGNALS if signal.required(imported=False)]
SHARDS = (100, 1000)
# So many shards of one short record each.
SMALL_SHARDS = """
name = "small_shards"
title = "Small shards"
summary = "A short record in each shard."
seed = 5
[signal]
rate_hz = 25600
duration_s = 0.05
[store]
records_per_shard = 1
[[part]]
name = "all"
records = {records}
machine.rig = "gearbox"
background.white_rms_m_s2 = 0.1
[part.defect]
condition = {{choice = ["healthy", "line"]}}
race = {{choice = ["outer", "inner"]}}
[part.defect.line]
extent_spacing = {{log_uniform = [0.02, 0.3]}}
depth_um = {{log_uniform = [4, 25]}}
"""


def starts() -> tuple[float, float]:
    """Seconds of a run of one record, the first time, and the median of later ones; Python keeps its bytecode, as
    where nobody forbids it."""
    seconds = []
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "SPALLGEN_CACHE": str(Path(folder) / "cache")}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        for out in range(1 + ROUNDS):
            begin = time.perf_counter()
            command = [sys.executable, "-m", "datagen", "generate", "quickstart", "--limit", "1", "--out"]
            place = Path(folder) / str(out)
            subprocess.run([*command, place], check=True, cwd=ROOT, env=environment, capture_output=True)
            seconds.append(time.perf_counter() - begin)
    return seconds[0], statistics.median(seconds[1:])


def seconds_of(scene: Scene) -> float:
    """Processor time (s) of a response marched to its end."""
    simulate(scene, RATE, Accurate(repeat=False))
    seconds = []
    for _ in range(ROUNDS):
        begin = time.process_time()
        simulate(scene, RATE, Accurate(repeat=False))
        seconds.append(time.process_time() - begin)
    return statistics.median(seconds)


def with_balls(balls: int) -> Scene:
    """G0 for 1 s, slipping, with so many balls in both rows together."""
    scene = reference_scene("G0", 1.0, slip_seed=SLIP_SEED)
    bearing = dataclasses.replace(scene.rig.bearing, balls=balls // scene.rig.bearing.rows)
    return dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, bearing=bearing))


def resident(records: int) -> float:
    """Largest resident size (MB) of a process that makes so many records by itself."""
    with tempfile.TemporaryDirectory() as folder:
        limit, out = str(records), str(Path(folder) / "corpus")
        return largest_resident("generate", "gearbox_rig", "--workers", "1", "--limit", limit, "--out", out)


def resident_over_a_run(marks: tuple[int, ...]) -> dict[str, dict[str, float]]:
    """Largest resident sizes (MB) of parent and larger worker when so many shards were finished, at last all."""
    with tempfile.TemporaryDirectory() as folder:
        recipe, out = Path(folder) / "small_shards.toml", Path(folder) / "corpus"
        recipe.write_text(SMALL_SHARDS.format(records=marks[-1]), encoding="utf-8")

        def finished() -> int:
            return sum(1 for _ in (out / "shards").glob("shard_*.nc"))

        return largest_on_the_way(finished, marks, "generate", str(recipe), "--workers", "2", "--out", str(out))


def reading(records: int, labels: int) -> dict[str, float]:
    """Seconds of reading one of so many records, and so many labels, in a process that does nothing else."""
    recipe = load_recipe(ROOT / "datasets" / "quickstart")
    recipe = recipe.model_copy(update={"signal": recipe.signal.model_copy(update={"duration_s": Fixed(READ_SECONDS)})})
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "corpus"
        generate(recipe, folder, limit=records)
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
            of_records = pool.submit(seconds_of_records, folder).result()
            lengthen_index(folder, labels)
            of_labels = pool.submit(seconds_of_labels, folder).result()
    return {"records": records, "record_s": of_records, "labels": labels, "labels_s": of_labels}


def seconds_of_records(folder: Path) -> float:
    """Median over the records of a corpus in random order, each with everything that is always stored."""
    seconds = []
    with Corpus(folder) as corpus:
        corpus.waveform(0)  # what is loaded at first use is there
        for record in np.random.default_rng(1).permutation(corpus.labels["record"]):
            begin = time.perf_counter()
            for name in ALWAYS_STORED:
                corpus.waveform(record, name)
            seconds.append(time.perf_counter() - begin)
    return statistics.median(seconds)


def lengthen_index(folder: Path, labels: int) -> None:
    """Repeat the rows of the index of a corpus, under other records, until there are so many."""
    with index_path(folder).open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    place = header.index("record")
    with index_path(folder).open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(header)
        for record in range(labels):
            row = rows[record % len(rows)]
            table.writerow([*row[:place], record, *row[place + 1 :]])


def seconds_of_labels(folder: Path) -> float:
    """Median of reading all labels of a corpus."""
    seconds = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        with Corpus(folder) as corpus:
            len(corpus.labels)
        seconds.append(time.perf_counter() - begin)
    return statistics.median(seconds)


def of_shards(sizes: dict[str, dict[str, float]]) -> str:
    """The line of the page about sizes over a run."""
    of = {who: by_number({shards: size[who] for shards, size in sizes.items()}) for who in ("parent", "worker")}
    return (
        f"- Largest resident size over a run of {list(sizes)[-1]} small shards, two workers, by shards finished: "
        f"parent {of['parent']}; the larger worker {of['worker']}."
    )


def of_reading(found: dict[str, float]) -> str:
    """The line of the page about reading."""
    return (
        f"- `Corpus` reads a random record of {READ_SECONDS:g} s from zlib shards, with everything that is always "
        f"stored ({', '.join(ALWAYS_STORED)}), in {1e3 * found['record_s']:.1f} ms (median of {found['records']:.0f}, "
        f"files in the system's memory), and the labels of {found['labels']:.0f} records in {found['labels_s']:.2f} s."
    )


def page(report: dict[str, Any]) -> str:
    """The costs of the report, measured now or read from its file, as Markdown; what an older one lacks is left out."""
    return "\n".join(
        [
            f"- The first run, of one record, takes {report['first_start_s']:.0f} s, as it compiles every kernel that "
            f"records need; a later one takes {report['warm_start_s']:.1f} s.",
            "- Milliseconds a second of record, G1 slipping, by length: "
            + ", ".join(
                f"{1e3 * used / float(length):.1f} ({float(length):g} s)"
                for length, used in report["seconds_by_length"].items()
            )
            + ".",
            "- Milliseconds a second of record, G0 slipping, by balls of both rows: "
            + ", ".join(f"{1e3 * used:.1f} ({count})" for count, used in report["seconds_by_balls"].items())
            + ".",
            f"- Largest resident size of a process, by records made: {by_number(report['resident_mb_by_records'])}.",
            *([of_shards(report["resident_mb_by_shards"])] if "resident_mb_by_shards" in report else []),
            *([of_reading(report["reading"])] if "reading" in report else []),
            "",
            f"Measured on {in_words(report['made_with'])}.",
        ]
    )


def main() -> None:
    """Measure and write both files."""
    keep_freed_memory()  # as where records are made
    warm_up()
    first, again = starts()
    report = {
        "made_with": measured_on("numpy", "scipy", "numba"),
        "first_start_s": first,
        "warm_start_s": again,
        "seconds_by_length": {
            seconds: seconds_of(reference_scene("G1", seconds, slip_seed=SLIP_SEED)) for seconds in LENGTHS
        },
        "seconds_by_balls": {count: seconds_of(with_balls(count)) for count in BALLS},
        "resident_mb_by_records": {records: resident(records) for records in RECORDS},
        "resident_mb_by_shards": resident_over_a_run(SHARDS),
        "reading": reading(READ_RECORDS, READ_LABELS),
    }
    (ROOT / "docs" / "costs.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    write_marked(ROOT / "docs" / "pipeline.md", "costs", __file__, page(report))


if __name__ == "__main__":
    main()
