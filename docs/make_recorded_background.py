"""What a healthy machine's recording as background does: python docs/make_recorded_background.py OUT RECORDS FILE RATE
CHANNEL,CHANNEL… TEST…

Learns from `transfer` at the rate (Hz) of FILE, with records no longer than it: once with the machines' drawn layers at
their absolute levels, once with these at a drawn signal-to-noise ratio, once with stretches of the recording's channels
at that same ratio. OUT gets the corpora and reports; TEST are the corpora to score on.
"""

from __future__ import annotations

import argparse
from copy import deepcopy
from pathlib import Path
from typing import Any

from transfer_runs import generated, report, transfer_recipe

RATIO_DB = {"uniform": [-15, 25]}
DURATIONS = {"choice": [0.4, 0.9]}
# Highest resonance, as a share of the rate.
HIGHEST = 0.45


def limited(setting: dict[str, list[float]], rate: float) -> dict[str, list[float]]:
    """A distribution of frequencies with its upper end below half the rate (Hz)."""
    [(kind, (low, high))] = setting.items()
    return {kind: [low, min(high, HIGHEST * rate)]}


def at_rate(recipe: dict[str, Any], rate: float) -> dict[str, Any]:
    """The recipe with short records at that rate (Hz)."""
    changed = deepcopy(recipe)
    changed["signal"] |= {"rate_hz": rate, "duration_s": DURATIONS}
    part = changed["part"][0]
    part["machine"]["resonator_frequency_hz"] = limited(part["machine"]["resonator_frequency_hz"], rate)
    part["chain"]["mounting_cutoff_hz"] = limited(part["chain"]["mounting_cutoff_hz"], rate)
    for table in (*part["chain"]["modes"], part["background"]["impulses"]):
        table["frequency_hz"] = limited(table["frequency_hz"], rate)
    return changed


def with_recording(recipe: dict[str, Any], file: Path, rate: float, channels: list[str], records: int) -> None:
    """One part a channel, its background nothing but stretches of that channel; ValueError if `records` do not divide
    by the channels: the other corpora would have more."""
    if records % len(channels):
        raise ValueError(f"RECORDS = {records}; allowed: a multiple of the {len(channels)} channels")
    [part] = recipe["part"]
    recipe["part"] = [deepcopy(part) for _ in channels]
    for number, (part, channel) in enumerate(zip(recipe["part"], channels, strict=True)):
        recording = {"file": str(file), "rate_hz": rate, "channels": [channel]}
        part |= {"name": f"machines-{number}", "records": records // len(channels)}
        part["background"] = {"recording": recording, "snr_db": RATIO_DB}


def main(out: Path, records: int, file: Path, rate: float, channels: list[str], tests: list[str]) -> None:
    """Make the three corpora and their reports; ValueError, before anything is made, as `with_recording` says."""
    recipe = at_rate(transfer_recipe(), rate)
    recipe["part"][0]["records"] = records
    at_ratio, recorded = deepcopy(recipe), deepcopy(recipe)
    at_ratio["part"][0]["background"]["snr_db"] = RATIO_DB
    with_recording(recorded, file.absolute(), rate, channels, records)
    named = {"drawn layers": recipe, "drawn layers at a ratio": at_ratio, "recording at a ratio": recorded}
    for name, data in named.items():
        report(out, name, generated(out, name, data), tests, records)


def command_line() -> argparse.Namespace:
    """What was asked for on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path, metavar="OUT", help="folder for the corpora and reports")
    parser.add_argument("records", type=int, metavar="RECORDS", help="records to learn from")
    parser.add_argument("file", type=Path, metavar="FILE", help="recording of a healthy machine")
    parser.add_argument("rate", type=float, metavar="RATE", help="its sampling rate, Hz")
    parser.add_argument("channels", metavar="CHANNEL,CHANNEL…", help="its variables to use, separated by commas")
    parser.add_argument("tests", nargs="+", metavar="TEST", help="corpus to score on")
    return parser.parse_args()


if __name__ == "__main__":
    asked = command_line()
    main(asked.out, asked.records, asked.file, asked.rate, asked.channels.split(","), asked.tests)
