"""Question 1: which plausible extended profile lifts the velocity lines above the line spall's, as Figure 8 shows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from datagen.drawing.style import EXTENDED, GREEN, GREY, INK, LINE, ORANGE, PURPLE, faint_grid
from datagen.paper.chapter import Chapter, Row, beside, only_ours
from datagen.paper.figure08_velocity_spectra import HARMONICS, SIXTH
from datagen.paper.panels import heading, letter
from datagen.paper.profile_search import CHOSEN, MOST_RECORDS, REFERENCE, SMOOTH, Outcome, outcome, profiles, titled
from datagen.paper.scenes import machine

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NAME = "question1"
PLANE = (-20.0, 14.0)  # dB; what lies lower is drawn on the edge
FAMILIES = {
    "smooth": (GREY, "smooth, tapers 0.3 to 10°"),
    "wave": (PURPLE, "one wave along the spall"),
    "short": (ORANGE, "rough, shortest wave 0.4 or 1 mm"),
    "long": (EXTENDED, "rough, shortest wave 2 mm"),
    "longer": (GREEN, "rough, shortest wave 4 mm"),
    "reference": (INK, "reference profile G2r"),
}


def chapter() -> Chapter:
    """Question 1 with its table."""
    found = [outcome(profile) for profile in profiles()]
    return Chapter(
        NAME,
        "Question 1: which extended profile lifts the velocity lines as Figure 8 shows?",
        "Gearbox rig, 1 % slip, 1.4 s. Searched: smooth tapered windows, one wave along the spall (a whole number to "
        "a ball spacing, two phases), and random waves of 1, 2, 4 or 8 µm standard deviation about 4 or 8 µm with "
        "the shortest wave (half amplitude) 0.4 (the contact's width averaged), 1, 2 or 4 mm, ten draws each; all "
        "between the race and 15 µm below it, where the axis of Figure 5(b) ends. Lines are compared with those of "
        "line spall G1 under the same slip. A profile answers yes if harmonics 3 to 13 lie above on average, the "
        "sixth lies above in eight draws of ten and is the strongest in eight of ten (Figure 8), and the line spall "
        f"keeps the higher envelope line in every draw (Figure 9). {answer(found)}",
        tuple(rows(found)),
        lambda: draw(found),
    )


def answer(found: Sequence[Outcome]) -> str:
    """One paragraph that names what the search found."""
    yes = [result.profile.title for result in found if result.lifts and result.keeps_envelope]
    wave = math.degrees(machine("gearbox").bearing.spacing) / SIXTH
    length = math.radians(wave) * machine("gearbox").bearing.raceway_radius("outer") * 1e3
    lifting = sum(result.lifts for result in found)
    only = f"Yes: {'; '.join(yes)}." if yes else "None does."
    return (
        f"{only} Of {len(found)} profiles {lifting} lift the lines and {len(yes)} do so with the "
        f"envelope's order kept. The sixth harmonic reads waves of {wave:.0f}°, {length:.1f} mm along the race: "
        "waves cut off above that leave it to the edges, waves down to the contact's width take the envelope with "
        "them."
    )


def rows(found: Sequence[Outcome]) -> list[Row]:
    """The table of question 1: the outcome of the chosen profile, and one line a profile of the grid.

    ValueError if the chosen profile is not among them.
    """
    table = _chosen_rows(titled(found, CHOSEN))
    table.append(
        only_ours(
            "profiles that answer yes",
            float(sum(result.lifts and result.keeps_envelope for result in found)),
            f"of {len(found)}",
        )
    )
    for result in found:
        verdict = ("lifts the lines" if result.lifts else "does not") + (
            ", keeps the envelope's order" if result.keeps_envelope else ", reverses the envelope's order in a draw"
        )
        ratio = result.envelope_ratio
        comment = (
            f"sixth {result.sixth:+.1f} dB, strongest in {np.mean(result.strongest == SIXTH):.0%}, envelope line over "
            f"extended {np.median(ratio):.3g} ({ratio.min():.2g} at least); {verdict}"
        )
        table.append(
            only_ours(
                f"harmonics 3 to 13 over the line spall's: {result.profile.title}",
                result.median_lift_db,
                "dB",
                comment,
            )
        )
    return table


def _chosen_rows(result: Outcome) -> list[Row]:
    title = result.profile.title
    share, ratio = float(np.mean(result.strongest == SIXTH)), float(np.median(result.envelope_ratio))
    return [
        beside(
            NAME, "roughness", "standard deviation of the chosen profile's waves", result.profile.deviation_um, title
        ),
        beside(
            NAME,
            "extended_is_higher",
            "harmonics 3 to 13 over the line spall's",
            result.median_lift_db,
            agrees=result.median_lift_db > 0,
            unit="dB",
        ),
        beside(
            NAME,
            "extended_is_higher",
            "sixth over the line spall's",
            result.sixth,
            agrees=result.sixth > 0,
            unit="dB",
        ),
        beside(
            NAME,
            "sixth_stands_out",
            "draws whose sixth is strongest",
            share,
            agrees=share >= MOST_RECORDS,
            unit="share",
        ),
        beside(
            NAME, "line_is_higher", "envelope line, line over extended", ratio, agrees=result.keeps_envelope, unit="1"
        ),
    ]


def draw(found: Sequence[Outcome]) -> Figure:
    """Maps of the random waves above; below, every profile in one plane and the harmonics one by one.

    ValueError if one of the three profiles drawn by name was not searched.
    """
    figure = Figure(figsize=(11.0, 9.4))
    upper = figure.add_gridspec(1, 3, left=0.085, right=0.985, top=0.895, bottom=0.545, wspace=0.1)
    lower = figure.add_gridspec(
        1, 2, left=0.065, right=0.985, top=0.435, bottom=0.125, wspace=0.17, width_ratios=(1, 1.05)
    )
    rough = [result for result in found if math.isfinite(result.profile.shortest_wave_mm)]
    maps = (
        ("(a)  Harmonics 3 to 13 over line (dB)", [result.median_lift_db for result in rough], (-8.0, 8.0)),
        ("(b)  Sixth harmonic over line (dB)", [result.sixth for result in rough], (-8.0, 8.0)),
        ("(c)  Envelope, line over extended (dB)", [_ratio_db(result) for result in rough], (-60.0, 60.0)),
    )
    for place, (title, values, limits) in enumerate(maps):
        axes = figure.add_subplot(upper[place])
        _draw_map(axes, rough, values, limits, first=place == 0)
        axes.set_title(title)
    plane = figure.add_subplot(lower[0])
    _draw_plane(plane, found)
    letter(plane, "d", "All profiles; upper right: as Figure 8")
    levels = figure.add_subplot(lower[1])
    _draw_levels(levels, found)
    letter(levels, "e", "Harmonics over the line spall's")
    heading(
        figure,
        "Question 1: which extended profile lifts the velocity lines?",
        "gearbox rig, 40° on the outer race, 0 to 15 µm deep, 1 % slip, medians of ten draws; framed: lifts the "
        "lines as Figure 8 and keeps the envelope's order of Figure 9",
    )
    handles, labels = plane.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=4, bbox_to_anchor=(0.5, 0.0), handlelength=1.2)
    return figure


def _ratio_db(result: Outcome) -> float:
    return float(20.0 * np.log10(np.median(result.envelope_ratio)))


def _draw_map(
    axes: Axes, rough: Sequence[Outcome], values: Sequence[float], limits: tuple[float, float], *, first: bool
) -> None:
    columns = sorted({result.profile.shortest_wave_mm for result in rough})
    lines = sorted({(result.profile.depth_um, result.profile.deviation_um) for result in rough})
    grid = np.full((len(lines), len(columns)), np.nan)
    for result, value in zip(rough, values, strict=True):
        row = lines.index((result.profile.depth_um, result.profile.deviation_um))
        column = columns.index(result.profile.shortest_wave_mm)
        grid[row, column] = value
        axes.text(column, row, f"{value:+.0f}", ha="center", va="center", fontsize=8, color=INK)
        if result.lifts and result.keeps_envelope:
            axes.add_patch(Rectangle((column - 0.46, row - 0.44), 0.92, 0.88, fill=False, edgecolor=INK, linewidth=1.8))
    axes.imshow(grid, cmap="PuOr_r", vmin=limits[0], vmax=limits[1], aspect="auto", alpha=0.75)
    axes.set_xticks(range(len(columns)), [f"{wave:g}" for wave in columns])
    names = [f"{deviation:g} about {depth:g}" for depth, deviation in lines]
    axes.set_yticks(range(len(lines)), names if first else [""] * len(lines))
    axes.set_xlabel("shortest wave (mm)")
    axes.tick_params(length=0)
    if first:
        axes.set_ylabel("standard deviation about mean depth (µm)")


def _draw_plane(axes: Axes, found: Sequence[Outcome]) -> None:
    for family, (colour, name) in FAMILIES.items():
        for keeps in (True, False):
            of_kind = [result for result in found if result.profile.family == family and result.keeps_envelope == keeps]
            axes.plot(
                [max(result.median_lift_db, PLANE[0]) for result in of_kind],
                [max(result.sixth, PLANE[0]) for result in of_kind],
                "o",
                color=colour,
                markersize=5,
                markerfacecolor=colour if keeps else "none",
                linestyle="",
                label=name if keeps else f"_{family}",
            )
    axes.plot([], [], "o", color=GREY, markerfacecolor="none", linestyle="", label="open: envelope's order reversed")
    axes.axhline(0.0, color=GREY, linewidth=0.7)
    axes.axvline(0.0, color=GREY, linewidth=0.7)
    axes.set(xlim=(PLANE[0] - 1.0, PLANE[1]), ylim=(PLANE[0] - 1.0, PLANE[1]))
    axes.set(xlabel="harmonics 3 to 13 over the line spall's (dB; on the edge: lower)", ylabel="sixth harmonic (dB)")
    faint_grid(axes)


def _draw_levels(axes: Axes, found: Sequence[Outcome]) -> None:
    number = np.arange(1, HARMONICS + 1)
    for title, colour, name in (
        (CHOSEN, EXTENDED, CHOSEN),
        (REFERENCE, INK, REFERENCE),
        (SMOOTH, GREY, "smooth, 4 µm, tapers 1° (G2)"),
    ):
        result = titled(found, title)
        axes.plot(number, np.median(result.above, axis=0), "o-", color=colour, markersize=3.5, label=name)
        if title == CHOSEN:
            axes.fill_between(number, result.above.min(axis=0), result.above.max(axis=0), color=colour, alpha=0.15)
    axes.axhline(0.0, color=LINE, linewidth=1.2, label="line spall G1")
    axes.set(xlabel="harmonic of the BPFO", ylabel="dB", xticks=number, ylim=(-30.0, 27.0))
    axes.legend(loc="upper right")
    faint_grid(axes)
