"""Writes the numbers of docs/size.md: `python docs/make_size_page.py TEST TEST_BLIND FRESH FRESH_BLIND`.

Each is a folder that `spallgen size CORPUS --out DIR` wrote, with and without `--blind`: of the ladder's test split and
of the fresh ladder.
"""

from __future__ import annotations

import argparse
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
from marked_tables import write_marked

from datagen.files.text_tables import markdown_table
from datagen.sizing.bearing_intervals import interval_over_bearings
from datagen.sizing.record_errors import NOISE_LEVELS, RULES, noise_title
from datagen.sizing.scored_record import must_be_sized

PAGE = Path(__file__).with_name("size.md")
LEVELS = tuple(map(noise_title, NOISE_LEVELS))


def figures(summary: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """The figures of a summary by name."""
    return {figure["name"]: figure for figure in summary["figures"]}


def cell(figure: dict[str, Any] | None) -> str:
    """A figure with its interval."""
    if figure is None or figure["value"] is None:
        return "–"
    if figure["low"] is None:
        return f"{100 * figure['value']:.1f}"
    return f"{100 * figure['value']:.1f} ({100 * figure['low']:.1f}–{100 * figure['high']:.1f})"


def by_noise(known: dict[str, Any], blind: dict[str, Any]) -> str:
    """Errors by noise, load known and blind, beside the rules."""
    given, blindly = figures(known), figures(blind)
    rows = [
        ("lag error", given, "lag error"),
        ("arc error, load and Hertz factor given", given, "arc error"),
        ("arc error, blind", blindly, "arc error"),
        *((f"arc error, {rule}", given, f"arc error by rule: {rule}") for rule in RULES),
        ("no estimate, load given", given, "no estimate"),
        ("no estimate, blind", blindly, "no estimate"),
    ]
    cells = [[title, *(cell(source.get(f"{name}, {level}")) for level in LEVELS)] for title, source, name in rows]
    return markdown_table(["figure", *LEVELS], cells)


def targets(summaries: list[dict[str, Any]]) -> str:
    """Every target with its figures: test split with load and blind, fresh ladder with load and blind."""
    head = ["target", "asked", "test split", "fresh ladder", "test split, blind", "fresh ladder, blind"]
    rows = []
    test, test_blind, fresh, fresh_blind = (figures(summary) for summary in summaries)
    for name, figure in test.items():
        if figure["target"]:
            verdicts = [
                f"{cell(run[name])}, n = {run[name]['count']}: {'met' if run[name]['met'] else '**missed**'}"
                for run in (test, fresh)
            ]
            blind = [cell(run[name]) for run in (test_blind, fresh_blind)]
            rows.append([name, in_per_cent(figure["target"]), *verdicts, *blind])
    return markdown_table(head, rows)


def in_per_cent(target: str) -> str:
    """A target with its shares in per cent."""
    return re.sub(r"\d+\.?\d*", lambda share: f"{100 * float(share[0]):g}", target)


def dependences(known: dict[str, Any]) -> str:
    """Errors by what they depend on."""
    rows = []
    for name, table in known["by"].items():
        for row in table:
            errors = [
                "–" if row[f"{what}_error"] is None
                else f"{100 * row[f'{what}_error']:.1f} ({100 * row[f'{what}_error_median']:.1f})"
                for what in ("lag", "arc")
            ]  # fmt: skip
            silent = f"{100 * row['no_estimate']:.0f}"
            rows.append([name, row["value"], row["records"], silent, *errors])
    head = ["by", "range", "records", "no estimate", "lag error, mean (median)", "arc error, mean (median)"]
    return markdown_table(head, rows)


def sentences(known: dict[str, Any]) -> list[str]:
    """What the tables do not hold, in words."""
    long, size, events = known["long"], known["known_size_of_another_record"], known["events"]
    lines = [
        f"- Beyond 0.9 ball spacings {long['answered']} of {long['records']} records were given a size; the nearest "
        f"candidate was off by {percent(long['error_of_nearest_candidate'])} on average, "
        f"{percent(long['median'])} in the median.",
        f"- With the known size of one other record of the same machine the arc error of {size['records']} records "
        f"went from {percent(size['arc_error_without'])} to {percent(size['arc_error_with'])} (medians "
        f"{percent(size['median_without'])} and {percent(size['median_with'])}).",
    ]
    for name, scores in events.items():
        lines.append(
            f"- Events {name.replace('_', ' ')}: precision {percent(scores['precision'])}, recall "
            f"{percent(scores['recall'])}, F1 {percent(scores['f1'])} of {scores['true']} true ones."
        )
    lines.append(
        f"- One record of a second took {known['seconds_per_record']['mean']:.2f} s of one processor on average in "
        "these runs ([measured apart](pipeline.md))."
    )
    return lines


def both_ways(known: list[dict[str, Any]], blind: list[dict[str, Any]]) -> str:
    """What load and Hertz factor add: arc errors of the records (rows of a report) that are given a size both ways."""
    blindly = {row["record"]: row for row in blind}
    rows = [row for row in known if is_sized(row) and is_sized(blindly[row["record"]])]
    given, without = np.array([[arc_error(row), arc_error(blindly[row["record"]])] for row in rows]).T
    _, bearing = np.unique([row["bearing_id"] for row in rows], return_inverse=True)
    low, high = interval_over_bearings(without - given, bearing, is_share=False)
    gained = f"{100 * (without - given).mean():.1f} ({100 * low:.1f} to {100 * high:.1f})"
    return (
        f"- Of the {len(rows)} records that are given a size with load and Hertz factor and blind, these make the arc "
        f"error smaller by {gained} points: {percent(given.mean())} instead of {percent(without.mean())} (medians "
        f"{percent(np.median(given))} and {percent(np.median(without))})."
    )


def is_sized(row: dict[str, Any]) -> bool:
    """Whether a record that asks for a size was given one."""
    asks = must_be_sized(
        row["true_lag"] or math.nan, row["rate"], row["pass_period"] or math.nan, row["extent_spacing"]
    )
    return asks and row["extent"] is not None


def arc_error(row: dict[str, Any]) -> float:
    """Relative error of the extent of a record that was given a size."""
    return float(abs(row["extent"] - row["true_extent"]) / row["true_extent"])


def extent(summary: dict[str, Any]) -> str:
    """How many records were scored, and for what."""
    return (
        f"{summary['records']} records, {summary['scorable']} of them with a size to be found, "
        f"{summary['without_event']} with no event or a lag below two samples"
    )


def percent(share: float | None) -> str:
    """A share in per cent."""
    return "–" if share is None else f"{100 * share:.1f} %"


def main(folders: list[Path]) -> None:
    """Replace what stands between the marks."""
    reports = [json.loads((folder / "size_report.json").read_text(encoding="utf-8")) for folder in folders]
    summaries = [report["summary"] for report in reports]
    test, test_blind, fresh, fresh_blind = summaries
    gain = both_ways(reports[2]["records"], reports[3]["records"])
    text = [
        "Errors are |error| / true where a size is given, in per cent; 90 % intervals (bootstrap over bearings).",
        "",
        targets(summaries), "",
        f"Test split: {extent(test)}.", "", by_noise(test, test_blind), "",
        f"Fresh ladder: {extent(fresh)}.", "", by_noise(fresh, fresh_blind), "", gain, *sentences(fresh), "",
        "The fresh ladder by what errors depend on, with load and Hertz factor, in per cent:", "",
        dependences(fresh),
    ]  # fmt: skip
    write_marked(PAGE, "size ladder", __file__, "\n".join(text))


def command_line() -> argparse.Namespace:
    """What was asked for on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("test", type=Path, metavar="TEST", help="the ladder's test split")
    parser.add_argument("test_blind", type=Path, metavar="TEST_BLIND", help="the same, scored with --blind")
    parser.add_argument("fresh", type=Path, metavar="FRESH", help="the fresh ladder")
    parser.add_argument("fresh_blind", type=Path, metavar="FRESH_BLIND", help="the same, scored with --blind")
    return parser.parse_args()


if __name__ == "__main__":
    asked = command_line()
    main([asked.test, asked.test_blind, asked.fresh, asked.fresh_blind])
