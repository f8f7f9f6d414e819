"""What a run costs beside its records: compiling, starting; how time goes with length and balls, memory with records.

PYTHONPATH=. python tests/benchmarks/costs.py writes docs/costs.json and the tables of docs/pipeline.md. Compiling and
starting are wall clock of a run that makes one record, with an empty and with a filled cache of kernels; times of
responses are processor time, medians of rounds; memory is the largest resident size of a process that makes so many
records of `gearbox_rig`.
"""

from __future__ import annotations

import dataclasses
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from datagen.freed_memory import keep_freed_memory
from datagen.versions import in_words, measured_on
from docs.marked_tables import write_marked
from physics.reference_scenes import reference_scene
from physics.request import Accurate
from physics.scene import Scene
from physics.simulate import simulate
from physics.warming import warm_up
from tests.benchmarks.resident import by_number, largest_resident

ROOT = Path(__file__).resolve().parents[2]
RATE, ROUNDS, SLIP_SEED = 65536.0, 5, 1
LENGTHS, BALLS, RECORDS = (0.5, 1.0, 2.0, 4.0, 8.0), (8, 12, 16, 24, 32), (16, 64, 192)


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


def page(report: dict[str, Any]) -> str:
    """The costs of the report, measured now or read from its file, as Markdown."""
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
    }
    (ROOT / "docs" / "costs.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    write_marked(ROOT / "docs" / "pipeline.md", "costs", __file__, page(report))


if __name__ == "__main__":
    main()
