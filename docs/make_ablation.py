"""Learns from `transfer` with one ingredient left out at a time: python docs/make_ablation.py OUT RECORDS TEST …

OUT gets a corpus and a report of `spallgen classify` for each ingredient, all of the first RECORDS records and with
the same draws of everything that is not left out; TEST are the corpora to score on. `docs/make_transfer.py` makes the
table.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

from transfer_runs import generated, report, spallgen, transfer_recipe

FULL = "full recipe"
# Records of `transfer` that are scored and never learned from: sixteen whole virtual machines.
HELD_OUT = range(800, 864)
Part = dict[str, Any]


def without_shaft_modulation(part: Part) -> None:
    """A load that does not turn: neither fluctuation nor unbalance."""
    part["operation"] |= {"load_fluctuation": 0, "unbalance_grade_mm_per_s": 0}


def without_absolute_floors(part: Part) -> None:
    """Noise at a signal-to-noise ratio, as public generators have it, not at a level that is the machine's."""
    part["background"]["snr_db"] = {"uniform": [-15, 25]}


def without_sensor_paths(part: Part) -> None:
    """The bearing's own vibration, by the resonator of its rig alone."""
    part["chain"] = {"resonator_gain": 1, "recorder_range_m_s2": 600}


def without_backgrounds(part: Part) -> None:
    """White noise and nothing else."""
    part["background"] = {"white_rms_m_s2": part["background"]["white_rms_m_s2"]}


def without_unequal_balls(part: Part) -> None:
    """Balls of one diameter."""
    part["imperfections"] |= {"ball_deviation_um": 0, "ball_deviation_scale": 0}


# Recipes by name, each by what it changes in the part of `transfer`.
CORPORA: dict[str, Callable[[Part], None]] = {
    FULL: lambda part: None,
    "without shaft modulation": without_shaft_modulation,
    "without absolute floors": without_absolute_floors,
    "without sensor paths": without_sensor_paths,
    "without machine backgrounds": without_backgrounds,
    "without unequal balls": without_unequal_balls,
}


def held_out(out: Path) -> Path:
    """Simulated machines of the full recipe to score on."""
    folder = out / "corpora" / "simulated"
    numbers = ",".join(map(str, HELD_OUT))
    spallgen("generate", "transfer", "--out", folder, "--records", numbers, "--workers", 1)
    return folder


def corpus(out: Path, name: str, change: Callable[[Part], None], records: int) -> Path:
    """The corpus of the changed recipe."""
    recipe = transfer_recipe()
    change(recipe["part"][0])
    return generated(out, name, recipe, "--limit", records)


def main(out: Path, records: int, tests: list[str]) -> None:
    """Make every corpus and report; ValueError if records that are scored would be learned from."""
    if records > HELD_OUT.start:
        raise ValueError(f"RECORDS = {records}; allowed: up to {HELD_OUT.start}")
    tests = [*tests, str(held_out(out))]
    for name, change in CORPORA.items():
        made = corpus(out, name, change, records)
        report(out, name, made, tests, records)
        if name == FULL:
            report(out, "speeds told exactly", made, tests, records, "--speed-error", "0")
            report(out, "plain impulse trains", "impulse-trains", tests, records)


def command_line() -> argparse.Namespace:
    """What was asked for on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path, metavar="OUT", help="folder for the corpora and reports")
    parser.add_argument("records", type=int, metavar="RECORDS", help=f"records to learn from, up to {HELD_OUT.start}")
    parser.add_argument("tests", nargs="*", metavar="TEST", help="corpus to score on")
    return parser.parse_args()


if __name__ == "__main__":
    asked = command_line()
    main(asked.out, asked.records, asked.tests)
