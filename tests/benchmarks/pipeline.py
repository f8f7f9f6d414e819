"""The whole pipeline: draw, simulate, sensor, background, envelope, stiffness, truth and writing, as a run does them.

PYTHONPATH=. python tests/benchmarks/pipeline.py [--records 64] [--rounds 3] writes docs/pipeline.json and the tables of
docs/pipeline.md: times real time of one processor with the default compression and with none, of records as long as the
dataset has them and of longer ones, bytes a second of record, where the time goes, and what a second worker adds (wall
clock, on a machine that does nothing else).
"""

from __future__ import annotations

import argparse
import cProfile
import json
import pstats
import shutil
import statistics
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from threadpoolctl import threadpool_limits

from datagen.corpus_files.shard import finished_shards
from datagen.distributions.distribution import Fixed
from datagen.recipes.recipe import Recipe, load_recipe
from datagen.recipes.store_settings import Store
from datagen.records.record import make_record
from datagen.runs.generate import corpus_identity, generate
from datagen.runs.plan import plan_shards
from datagen.runs.task import make_shard
from datagen.runs.workers import Engine
from datagen.scenarios.sampling import draw_scenario
from datagen.versions import in_words, measured_on
from docs.marked_tables import write_marked
from physics.warming import warm_up

ROOT = Path(__file__).resolve().parents[2]
DATASETS = ("gearbox_rig", "fan_rig", "corpus")
COMPRESSIONS = ("zlib", "none")
LONG = 2.0  # s, of the longer records
FEWEST_RECORDS = 4
# A run of seconds, in which the start of the processes counts, and one long enough that it does not.
WORKER_RECORDS = {"gearbox_rig": 96, "corpus": 480}
# Functions that the profile adds up, by the step that they are; each does nothing that another one counts.
STAGES = {
    "draw the scenario": ("draw_scenario",),
    "simulate": ("simulate",),
    "quasi-static stiffness": ("stiffness_series",),
    "truth of every ball pass": ("ball_passes",),
    "sensor path and background": ("sensed", "background_layers", "sensor_labels"),
    "envelope": ("band_envelope",),
    "text of the scenario": ("scenario_json",),
    "lay out the file": ("to_dataset",),
    "compress and write": ("write_shard",),
}


@contextmanager
def scratch() -> Iterator[Path]:
    """A folder for a corpus that is gone afterwards."""
    folder = Path(tempfile.mkdtemp(prefix="spallgen-pipeline-"))
    (folder / "shards").mkdir()
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def plain(recipe: Recipe, compression: str) -> Recipe:
    """The recipe with what is always stored and nothing else."""
    settings = {"compression": compression, "records_per_shard": recipe.store.records_per_shard}
    store = Store.model_validate(settings)
    return recipe.model_copy(update={"store": store})


def lasting(recipe: Recipe, seconds: float) -> Recipe:
    """The recipe with records of that length."""
    signal = recipe.signal.model_copy(update={"duration_s": Fixed(seconds)})
    return recipe.model_copy(update={"signal": signal})


def one_process(recipe: Recipe, records: int) -> tuple[float, float, int]:
    """Processor time (s) of making and writing the first `records`, their length (s), and bytes written."""
    identity, planned = corpus_identity(recipe), plan_shards(recipe, records)
    with scratch() as folder, threadpool_limits(limits=1):  # as a worker has it
        begin = time.process_time()
        rows = [make_shard(recipe, folder, shard, identity) for shard in planned]
        spent = time.process_time() - begin
        written = list(finished_shards(folder))
    assert not any(row.error for row in rows)
    assert not any(shard.failed for shard in written)
    length = sum(len(shard.records) * shard.record_seconds for shard in planned)
    return spent, length, sum(shard.bytes for shard in written)


def shares(recipe: Recipe, records: int) -> dict[str, float]:
    """Share of the time in every step of STAGES, and of all else."""
    identity, planned = corpus_identity(recipe), plan_shards(recipe, records)
    profile = cProfile.Profile()
    with scratch() as folder, threadpool_limits(limits=1):
        profile.enable()
        for shard in planned:
            make_shard(recipe, folder, shard, identity)
        profile.disable()
    found = pstats.Stats(profile)
    stats: dict[tuple[str, int, str], tuple[int, int, float, float, object]] = found.stats  # type: ignore[attr-defined]
    spent = {
        stage: sum(row[3] for (file, _, name), row in stats.items() if name in names and str(ROOT) in file)
        for stage, names in STAGES.items()
    }
    whole = max(row[3] for row in stats.values())
    share = {stage: seconds / whole for stage, seconds in spent.items()}
    return share | {"all else": 1.0 - sum(share.values())}


def costliest(recipe: Recipe, records: int) -> dict[str, float]:
    """Of the first `records` the one that takes longest to make, and its share of the processor time of all."""
    spent = []
    with threadpool_limits(limits=1):
        for record in range(records):
            begin = time.process_time()
            make_record(draw_scenario(recipe, record))
            spent.append(time.process_time() - begin)
    return {"record": spent.index(max(spent)), "share": max(spent) / sum(spent)}


def wall_seconds(recipe: Recipe, records: int, workers: int) -> float:
    """Wall-clock seconds of a run with so many workers."""
    with scratch() as folder:
        begin = time.perf_counter()
        generate(recipe, folder / "corpus", limit=records, engine=Engine(workers=workers))
        return time.perf_counter() - begin


def two_workers(name: str, records: int, rounds: int) -> dict[str, float]:
    """How many times as fast two workers are as one, and how long one takes, s: medians of the rounds."""
    recipe = plain(load_recipe(ROOT / "datasets" / name), COMPRESSIONS[0])
    pairs = [(wall_seconds(recipe, records, 1), wall_seconds(recipe, records, 2)) for _ in range(rounds)]
    ratio, alone = statistics.median(one / two for one, two in pairs), statistics.median(one for one, _ in pairs)
    return {"records": records, "ratio": ratio, "one_worker_s": alone}


def measure(records: int, rounds: int) -> dict[str, object]:
    """Everything the tables hold."""
    rows: dict[str, dict[str, object]] = {}
    recipes = {name: load_recipe(ROOT / "datasets" / name) for name in DATASETS}
    recipes |= {f"{name}, {LONG:g} s": lasting(recipe, LONG) for name, recipe in recipes.items()}
    for name, recipe in recipes.items():
        one_process(plain(recipe, COMPRESSIONS[0]), FEWEST_RECORDS)  # what is loaded at first use is there
        row: dict[str, object] = {}
        for compression in COMPRESSIONS:
            runs = [one_process(plain(recipe, compression), records) for _ in range(rounds)]
            spent = statistics.median(run[0] for run in runs)
            row[compression] = {"real_time": runs[0][1] / spent, "bytes_per_second": runs[0][2] / runs[0][1]}
        row["shares"] = shares(plain(recipe, COMPRESSIONS[0]), records)
        row["costliest"] = costliest(recipe, records)
        rows[name] = row
        print(name, json.dumps(row), flush=True)
    return {
        "datasets": rows,
        "two_workers": {name: two_workers(name, count, rounds) for name, count in WORKER_RECORDS.items()},
        "records": records,
        "made_with": measured_on("numpy", "scipy", "numba", "xarray", "netCDF4", "h5py", "isal"),
    }


def page(found: dict[str, object]) -> str:
    """The tables, as Markdown."""
    rows: dict[str, dict[str, dict[str, float]]] = found["datasets"]  # type: ignore[assignment]
    lines = ["| dataset | times real time, zlib | none | kB a second of record, zlib | none |", "|---|---|---|---|---|"]
    for name, row in rows.items():
        speed = [f"{row[one]['real_time']:.1f}" for one in COMPRESSIONS]
        size = [f"{row[one]['bytes_per_second'] / 1e3:.0f}" for one in COMPRESSIONS]
        lines.append(f"| {name} | {' | '.join(speed)} | {' | '.join(size)} |")
    lines += ["", "| share of the time | " + " | ".join(rows) + " |", "|---" * (len(rows) + 1) + "|"]
    for stage in (*STAGES, "all else"):
        cells = " | ".join(f"{100.0 * row['shares'][stage]:.0f} %" for row in rows.values())
        lines.append(f"| {stage} | {cells} |")
    dearest = [row["costliest"] for row in rows.values()]
    cells = " | ".join(f"{100.0 * one['share']:.0f} % ({one['record']})" for one in dearest)
    lines.append(f"| the costliest record (its number), of making alone | {cells} |")
    made: dict[str, str] = found["made_with"]  # type: ignore[assignment]
    pairs: dict[str, dict[str, float]] = found["two_workers"]  # type: ignore[assignment]
    together = "; ".join(
        f"the first {pair['records']} records of {name} {pair['ratio']:.2f} times as fast as one, which takes "
        f"{pair['one_worker_s']:.0f} s"
        for name, pair in pairs.items()
    )
    lines += [
        "",
        f"First {found['records']} records of each dataset, which last 0.5 s (gearbox_rig, fan_rig) and 1 s (corpus), "
        f"or {LONG:g} s where said; processor time of one process, median of the rounds; "
        f"shares from a profile. Two workers make {together} (wall clock, start of the processes "
        f"included). "
        f"Measured on {in_words(made)}.",
    ]
    return "\n".join(lines)


def main() -> None:
    """Measure, and write both files."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--records", type=int, default=64)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    warm_up()
    found = measure(options.records, options.rounds)
    (ROOT / "docs" / "pipeline.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    write_marked(ROOT / "docs" / "pipeline.md", "pipeline", __file__, page(found))


if __name__ == "__main__":
    main()
