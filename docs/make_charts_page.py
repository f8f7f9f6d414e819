"""Writes the tables of docs/charts/README.md from the JSON files beside it: python docs/make_charts_page.py."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from marked_tables import write_marked

from datagen import versions
from datagen.files.text_tables import markdown_table

CHARTS = Path(__file__).with_name("charts")
PAGE = CHARTS / "README.md"
SCENES = ("G1", "F1", "G2", "F2", "G1_3x", "F1_3x", "G2_3x", "F2_3x")
# Measured apart from these.
OTHERS = ("G1s", "G2r", "F1s", "F2r", "G1_slip1", "F1_slip1")
MARCHED, REPEATED, DEFAULT = "modal", "modal, repeated", 1e-3
RIVALS = (("compiled solver", "ball by ball"), ("compiled solver", "contact kernel"), ("SciPy solver", ""))
MODELS = ("impulse train", "quasi-static", "linear time-varying")
Facts = dict[str, Any]


def error(run: Facts) -> float:
    """Relative RMS error of the acceleration of a run that was scored."""
    return float(run["score"]["acceleration"])


def asked(run: Facts) -> float:
    """The accuracy that a run of the modal method was asked for."""
    return float(run["setting"].split()[1])


def runs_of(chart: Facts, name: str) -> list[Facts]:
    """The scored runs of one contestant."""
    return [run for run in chart["runs"] if run["name"] == name and run["score"] is not None]


def at_accuracy(chart: Facts, name: str, accuracy: float) -> Facts | None:
    """The run of a modal contestant that was asked for this accuracy; None if there is none."""
    return next((run for run in runs_of(chart, name) if asked(run) == accuracy), None)


def default_run(chart: Facts) -> Facts:
    """The run of the default: the modal method asked for 1e-3; ValueError if the chart has none."""
    run = at_accuracy(chart, MARCHED, DEFAULT)
    if run is None:
        raise ValueError(f"{chart['subject']}: no run of {MARCHED} that was asked for {DEFAULT:g}")
    return run


def fastest(chart: Facts, group: str, equations: str) -> tuple[str, float] | None:
    """Name and times real time at an error of 0.1 % of the fastest solver of a kind; None if none reaches it."""
    names = {run["name"] for run in chart["runs"] if run["group"] == group and run["name"].endswith(equations)}
    found = [(chart["best"][name], name) for name in names if chart["best"][name] is not None]
    return (max(found)[1], max(found)[0]) if found else None


def in_words(run: Facts | None) -> str:
    """Speed and error of a run; a dash if there is none."""
    return "–" if run is None else f"{run['real_time']:.0f} ({error(run):.1e})"


def rival(found: tuple[str, float] | None, speed: float) -> str:
    """A solver's speed, its name, and how many times slower it is than `speed`."""
    if found is None:
        return "–"
    return f"{found[1]:.2g} ({found[0].split(',')[0]}): {speed / found[1]:.0f} times slower"


def speeds(charts: dict[str, Facts]) -> str:
    """One row a scene: the default, its fastest accurate run, and the fastest rival of each kind against that."""
    heads = (
        "`modal`, 1e-3 asked: times real time (error)",
        "its fastest run below 0.1 %",
        "`modal, repeated`, 1e-3 asked",
        *(f"{group}, {equations}" if equations else group for group, equations in RIVALS),
    )
    rows = {}
    for name, chart in charts.items():
        accurate, repeated = fastest_run(chart), at_accuracy(chart, REPEATED, DEFAULT)
        cells = [in_words(default_run(chart)), in_words(accurate), in_words(repeated)]
        rows[name] = cells + [rival(fastest(chart, *kind), accurate["real_time"]) for kind in RIVALS]
    return f"{by_scene(heads, rows)}\n\nMeasured on {versions.in_words(made_with(charts))}."


def made_with(charts: dict[str, Facts]) -> dict[str, str]:
    """What all charts were measured on and with; ValueError if they were not all on and with the same."""
    (first, chart), *others = charts.items()
    made: dict[str, str] = chart["made_with"]
    apart = [name for name, other in others if other["made_with"] != made]
    if apart:
        raise ValueError(f"{', '.join(apart)}: not measured on and with the same as {first}")
    return made


def fastest_run(chart: Facts) -> Facts:
    """The fastest run of the modal method with an error of 0.1 % or less; ValueError if there is none.

    `best` in the JSON is that or faster, as it is interpolated between runs.
    """
    return max((run for run in runs_of(chart, MARCHED) if error(run) <= DEFAULT), key=lambda run: run["real_time"])


def accuracies(charts: dict[str, Facts]) -> str:
    """One row a scene: what a tenth of the error costs, what was missed, and how near any run is to the reference."""
    heads = (
        "speed lost from 1e-3 to 1e-4 asked",
        "from 1e-4 to 1e-5",
        "accuracy missed",
        "nearest run to the reference",
    )
    rows = {}
    for name, chart in charts.items():
        speed = {asked(run): run["real_time"] for run in runs_of(chart, MARCHED)}
        lost = [f"{100.0 * (1.0 - speed[fine] / speed[coarse]):.0f} %" for coarse, fine in ((1e-3, 1e-4), (1e-4, 1e-5))]
        nearest = min((run for run in chart["runs"] if run["score"] is not None), key=error)
        near = f"{error(nearest):.1e} ({nearest['name']}, {nearest['setting']})"
        rows[name] = [*lost, missed(chart), near]
    return by_scene(heads, rows)


def missed(chart: Facts) -> str:
    """The runs of the modal method whose error is above what was asked for."""
    late = [run for name in (MARCHED, REPEATED) for run in runs_of(chart, name) if error(run) > asked(run)]
    return ", ".join(f"{run['name']}: {asked(run):g} asked, {error(run):.1e} got" for run in late) or "none"


def simpler(charts: dict[str, Facts]) -> str:
    """One row a scene: speed and error of the simpler models beside the default."""
    rows = {
        name: [in_words(default_run(chart)), *(in_words(runs_of(chart, model)[0]) for model in MODELS)]
        for name, chart in charts.items()
    }
    return by_scene(("`modal`, 1e-3 asked", *MODELS), rows)


def by_scene(heads: Sequence[str], rows: Mapping[str, Sequence[str]]) -> str:
    """A table with a row of cells a scene."""
    return markdown_table(["scene", *heads], [[name, *cells] for name, cells in rows.items()])


def read(scenes: Sequence[str]) -> dict[str, Facts]:
    """The charts of these scenes."""
    return {name: json.loads((CHARTS / f"{name}.json").read_text(encoding="utf-8")) for name in scenes}


TABLES = {
    "speeds": (speeds, SCENES),
    "accuracies": (accuracies, SCENES),
    "simpler models": (simpler, SCENES),
    "other speeds": (speeds, OTHERS),
    "other accuracies": (accuracies, OTHERS),
}


def main() -> None:
    """Write the tables."""
    for name, (table, scenes) in TABLES.items():
        write_marked(PAGE, name, __file__, table(read(scenes)))


if __name__ == "__main__":
    main()
