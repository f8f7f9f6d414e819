"""Draws docs/pictures/transfer.png: python docs/make_transfer_picture.py REPORT.json

The report of `spallgen classify` is that of the main run of docs/transfer.md, from which make_transfer.py writes its
tables. What depends on SNR, speed, size and probability is of docs/crossfitted.json (make_crossfitted.py).
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure
from transfer_page import CROSSFITTED, FAULTS, has_faults

from datagen.drawing.classifier_panels import (
    AGAINST,
    draw_against,
    draw_curve,
    draw_importances,
    draw_points,
    draw_reliability,
)
from datagen.drawing.style import INK, png_of, roomy
from labels.interval import Interval

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PICTURE = Path(__file__).with_name("pictures") / "transfer.png"
NOISY = ("cwru_de12k", "mfpt")
IMPORTANT = "forest"
SIZE, DPI = (12.0, 10.5), 110
HEADINGS = (
    "On recordings, and on simulated machines for comparison",
    "On all simulated machines of transfer, each judged by learners of others",
    "Probabilities on the same machines, and what was learned",
)


def main(path: Path) -> None:
    """Draw the picture of one report, and of the scores of all machines judged by learners of others."""
    report, of_others = (
        json.loads(path.read_text()),
        json.loads(CROSSFITTED.read_text(encoding="utf-8"))["scores"]["models"],
    )
    PICTURE.write_bytes(png_of(lambda: draw(report, of_others), DPI))


def draw(report: dict[str, Any], of_others: dict[str, Any]) -> Figure:
    """Scores by corpus and by added noise; then by SNR, speed and size, with the calibration, those `of_others`, by
    model, of simulated machines that were not learned from; learning curve and features."""
    tests = {Path(test["corpus"]).name: test for test in report["tests"]}
    figure = Figure(figsize=SIZE, layout=roomy())
    above, middle, below = figure.subfigures(len(HEADINGS), 1, squeeze=False)[:, 0]
    for part, heading in zip((above, middle, below), HEADINGS, strict=True):
        part.suptitle(heading, x=0.012, ha="left", fontsize=12, fontweight="bold", color=INK)
    by_corpus, *in_noise = above.subplots(1, 3, width_ratios=(1.5, 1.0, 1.0))
    draw_corpora(by_corpus, {name: test for name, test in tests.items() if has_faults(test)})
    for axes, name in zip(in_noise, NOISY, strict=True):
        draw_noise_added(axes, name, tests[name])
    for axes, quantity in zip(middle.subplots(1, len(AGAINST)), AGAINST, strict=True):
        draw_against(axes, {name: said["accuracy_against"][quantity] for name, said in of_others.items()}, quantity)
    reliability, curve, importances = below.subplots(1, 3)
    draw_reliability(reliability, {name: said.get("reliability") for name, said in of_others.items()})
    draw_curve(curve, report["learning_curve"])
    draw_importances(importances, IMPORTANT, report["importances"][IMPORTANT])
    return figure


def draw_corpora(axes: Axes, tests: dict[str, dict[str, Any]]) -> None:
    """Balanced accuracy over the faults of either race on every corpus, with intervals."""
    draw_points(axes, [faults(test["models"]) for test in tests.values()])
    axes.set_xticks(range(len(tests)), [name.replace("_", "\n") for name in tests])
    axes.set_ylabel("score “faults”")
    axes.set_title("faults, by corpus")


def draw_noise_added(axes: Axes, name: str, test: dict[str, Any]) -> None:
    """The same at every level of white noise added to one corpus, and without any."""
    noisy = sorted(test["noise"], key=lambda level: level["snr_db"])
    draw_points(axes, [faults(tested["models"]) for tested in (*noisy, test)])
    axes.set_xticks(range(len(noisy) + 1), [*(f"{level['snr_db']:g}" for level in noisy), "none added"])
    axes.set_xlabel("signal over white noise added, dB")
    axes.set_title(f"{name}, with noise added")


def faults(models: dict[str, dict[str, Any]]) -> dict[str, Interval]:
    """The score over faults of every model by name."""
    return {name: Interval(**said[FAULTS]) for name, said in models.items()}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path", type=Path, metavar="REPORT", help="report.json of the main run")
    main(parser.parse_args().path)
