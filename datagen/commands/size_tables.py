"""What `spallgen size` prints: the figures of a scored corpus, or the estimates where no truth is known."""

from __future__ import annotations

import math

from rich.table import Table

from datagen.counts import bracketed, counted
from datagen.sizing.known_sizes import KnownSize
from datagen.sizing.scored_record import ScoredRecord, Truth
from datagen.sizing.size_summary import Figure, SizeSummary, StatedSizes
from labels.interval import Interval

# Records from which on a figure is held against its target: of fewer one alone moves a share by more than 5 %.
FEWEST_TO_JUDGE = 20


def summary_table(summary: SizeSummary) -> Table:
    """Every figure that records bear on, with its interval, its number of records and its target."""
    table = Table(title=f"{summary.records} records with known truth, {summary.scorable} to be given a size")
    for name in ("figure", "value", "90 % interval", "records", "target", "met"):
        table.add_column(name, justify="left" if name == "figure" else "right")
    for figure in summary.figures:
        if figure.count:
            mean, count = figure.mean, str(figure.count)
            table.add_row(figure.name, f"{mean.value:.3f}", _reach(mean), count, figure.target, _met(figure))
    for name, events in summary.events.items():
        if events.true or events.found:
            interval = _reach(events.f1) if events.true else ""
            table.add_row(
                f"events {name.replace('_', ' ')}: F1",
                f"{events.f1.value:.3f}",
                interval,
                counted(events.true, "event"),
            )
    return table


def _met(figure: Figure) -> str:
    """Whether a figure meets its target, if it has one and enough records bear on it."""
    if figure.met is None:
        return ""
    if figure.count < FEWEST_TO_JUDGE:
        return "too few to judge"
    return "yes" if figure.met else "NO"


def _reach(mean: Interval) -> str:
    """The ends of an interval; nothing where there is none."""
    return f"{mean.low:.3f} to {mean.high:.3f}" if math.isfinite(mean.low) else ""


def estimates_table(records: list[ScoredRecord]) -> Table:
    """Size of the spall of every record with its 90 % intervals, or in words why none is given."""
    trust_means = "Trust: 1 less the relative error to be expected of the time between the events."
    sizes_mean = (
        "\nThat time tells a size only up to whole ball spacings: the longer candidates are in the files. Where "
        "an exit and the\nnext entry were taken for entry and exit, the spall is what the size lacks of a ball "
        'spacing, which\nstands after "or" where it is shorter, and in the files.'
    )
    sized = any(record.found for record in records)
    table = Table(caption=f"In brackets 90 % intervals. {trust_means}{sizes_mean}" if sized else trust_means)
    for name in ("record", "recording", "race", "extent, °", "extent, mm", "trust", "why there is no estimate"):
        table.add_column(name, justify="right" if name in ("record", "trust") else "left")
    for record in records:
        trust = f"{record.answer.trust:.2f}" if record.asked else ""
        table.add_row(
            str(record.truth.record),
            _source(record.truth),
            *_spall(record),
            trust,
            record.answer.reason,
        )
    return table


def _source(truth: Truth) -> str:
    repeated = f" {truth.channel}" in truth.recording
    return truth.recording if repeated else " ".join(part for part in (truth.recording, truth.channel) if part)


def _spall(record: ScoredRecord) -> tuple[str, str, str]:
    if not record.found:
        return "", "", ""
    answer = record.answer
    degrees = _with_interval(answer.extent_deg, *answer.extent_deg_interval)
    mm = _with_interval(answer.extent_mm, *answer.extent_mm_interval)
    if answer.complement < answer.extent:
        return answer.race, f"{degrees} or {math.degrees(answer.complement):.3g}", f"{mm} or {answer.complement_mm:.3g}"
    return answer.race, degrees, mm


def _with_interval(value: float, low: float, high: float) -> str:
    return f"{value:.3g} [{low:.3g}, {high:.3g}]" if math.isfinite(low) else f"{value:.3g}"


def stated_sentence(stated: StatedSizes) -> str:
    """How the estimates compare with the stated extents and the stated health of recordings."""
    parts = []
    if stated.records:
        parts.append(f"of {stated.records} records of a stated extent {stated.answered} were given a size")
    if stated.answered:
        error = stated.arc_error
        parts.append(f"mean error of their arc {error.value:.3f}{bracketed(error)} of it")
        parts.append(f"{stated.answered_on_the_stated_race} on the stated race")
    if stated.healthy:
        parts.append(f"{stated.healthy_answered} of {stated.healthy} stated healthy were given a size")
    return ", ".join(parts)


def known_size_sentence(known: KnownSize) -> str:
    """What the known size of a record changed."""
    change = 100.0 * (known.factor - 1.0)
    others = f"{counted(known.corrected, 'other record')} of {known.machine}"
    sentence = (
        f"record {known.record} is known to have {known.known_mm:g} mm and was estimated at {known.estimated_mm:.3g} "
        f"mm, which changes the sizes of {others} by {change:+.2f} %"
    )
    if math.isnan(known.arc_error_without):
        return sentence
    return f"{sentence}; their arc error: {known.arc_error_without:.2%} without it, {known.arc_error_with:.2%} with it"
