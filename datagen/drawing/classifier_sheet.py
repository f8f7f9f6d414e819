"""The sheet of a benchmark: of each corpus tested the panels that have something to show, then what was learned."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure

from datagen.counts import counted
from datagen.drawing.classifier_panels import (
    accuracies_against,
    differing,
    draw_against,
    draw_confusion,
    draw_curve,
    draw_importances,
    draw_noise,
    draw_reliability,
    draw_scores,
    has_curve,
    has_reliability,
    reliability_curves,
    say,
)
from datagen.drawing.style import GREY, INK, png_of, roomy

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from datagen.benchmark.results import CorpusResults, CorpusScores, Results

Draw = Callable[["Axes"], None]

COLUMN, WIDE, ROW, HEADING, LINE, DPI = 3.7, 1.4, 3.0, 0.4, 0.16, 100  # inches, WIDE in columns
FEWEST_ACROSS, MOST_ACROSS = 3, 5
LETTERS = 16.5  # of the caption, an inch
CAPTION = (
    "faults: balanced accuracy over the faults of either race, where to call one healthy is an error; "
    "by a quantity: share of them that is called by its own race\u00a0 ·  "
    "race: share of the faults of which the right race is named, be they called healthy or not\u00a0 ·  "
    "AUC: area under the ROC curve, faults against healthy records\u00a0 ·  "
    "vertical bars and shading: 95 % intervals"
)


@dataclass(frozen=True)
class Section:
    """Panels below one heading."""

    heading: str
    panels: list[Draw]


def scores_png(results: Results) -> bytes:
    """The sheet of the results of `classify` as the bytes of a PNG file."""
    return png_of(lambda: draw_results(results), DPI)


def draw_results(results: Results) -> Figure:
    """The figure of the results of `classify`: what each corpus shows and then the models, row by row."""
    parts = sections(results)
    across = columns([len(part.panels) for part in parts])
    rows = [-(-len(part.panels) // across) for part in parts]
    width = COLUMN * (across + (WIDE - 1.0 if across > 1 else 0.0))
    caption = fill(CAPTION, int(width * LETTERS)) if results.tests else ""
    heights = [ROW * count + HEADING for count in rows]
    figure = Figure(figsize=(width, sum(heights) + LINE * (caption.count("\n") + 2)), layout=roomy())
    for place, part, count in zip(
        figure.subfigures(len(parts), 1, squeeze=False, height_ratios=heights)[:, 0], parts, rows, strict=True
    ):
        _draw_section(place, part, count, across)
    figure.supxlabel(caption, x=0.012, ha="left", fontsize=8, color=GREY)
    return figure


def sections(results: Results) -> list[Section]:
    """What is drawn: of every corpus its panels, and those of the models with the only one, or after them all."""
    learned = list(_model_panels(results))
    origin = f"learned from {Path(results.train).name}"
    found = [Section(f"{_named(test.scores)}, {origin}", list(_test_panels(test))) for test in results.tests]
    if len(found) == 1:
        return [Section(found[0].heading, found[0].panels + learned)]
    if learned or not found:
        found.append(Section(origin, learned or [partial(say, title="", text="nothing was tested")]))
    return found


def _named(test: CorpusScores) -> str:
    return f"{Path(test.corpus).name}: {counted(test.records, 'record')}"


def _test_panels(test: CorpusResults) -> Iterator[Draw]:
    """Panels of one corpus that have something to show; that of the confusion is the second."""
    scores = test.scores
    yield partial(draw_scores, test=scores)
    yield partial(draw_confusion, test=scores)
    if has_reliability(scores):
        yield partial(draw_reliability, curves=reliability_curves(scores))
    for quantity in differing(scores):
        yield partial(draw_against, tables=accuracies_against(scores, quantity), quantity=quantity)
    if test.noise:
        yield partial(draw_noise, test=test)


def _model_panels(results: Results) -> Iterator[Draw]:
    """Panels of what was learned."""
    for name, table in results.importances.items():
        yield partial(draw_importances, name=name, table=table)
    if has_curve(results.learning_curve):
        yield partial(draw_curve, curve=results.learning_curve)


def columns(panels: list[int]) -> int:
    """In how many columns sections of so many `panels` leave the fewest places empty; of these the most."""
    most = max(panels)
    choices = range(min(most, FEWEST_ACROSS), min(most, MOST_ACROSS) + 1)
    return min(choices, key=lambda across: (sum(-count % across for count in panels), -across))


def _draw_section(place: Any, part: Section, rows: int, across: int) -> None:
    """The panels of a section in its subfigure, below its heading."""
    widths = [WIDE if column == 1 else 1.0 for column in range(across)]  # room for a confusion table of each model
    panels = place.subplots(rows, across, squeeze=False, width_ratios=widths).ravel()
    for panel, draw in zip(panels, part.panels, strict=False):
        draw(panel)
    for panel in panels[len(part.panels) :]:
        panel.axis("off")
    place.suptitle(part.heading, x=0.012, ha="left", fontsize=12, fontweight="bold", color=INK, parse_math=False)
