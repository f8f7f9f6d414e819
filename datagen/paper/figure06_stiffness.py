"""Figure 6: the bearing's quasi-static stiffness against cage angle, row by row, with a line and an extended spall."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from datagen.drawing.style import EXTENDED, HEALTHY, INK, LINE, PURPLE, faint_grid, with_panels
from datagen.paper.chapter import Chapter, Row, beside, only_ours
from datagen.paper.panels import heading, legend_below, letter
from datagen.paper.scenes import (
    SHOWN_SEED,
    ball_angles,
    half_arc,
    machine,
    reference_extended_spall,
    scene,
    wavy_extended_spall,
)
from physics.arrays import Array
from physics.reference_scenes import BOTTOM, line_spall
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


NAME = "figure6"
COMPONENTS = ("kxx", "kyy", "kxy")
XX, YY, XY = range(3)
SHOWN = 60.0
STEPS = 2400
LEAST_APART, MOST_APART = 10.0, 300.0  # "one to two orders of magnitude"


@dataclass(frozen=True)
class Stiffness:
    """Stiffness `row` (2, S, 3) of each row at the angles `cage` (S,), degrees over 60°: kxx, kyy, kxy, MN/m.

    `half_arc`: half the arc of the spall, degrees; 0 of a healthy bearing.
    """

    cage: Array
    row: Array
    half_arc: float

    @property
    def total(self) -> Array:
        """Both rows together (S, 3), MN/m."""
        return np.asarray(self.row.sum(axis=0))

    @property
    def ball_inside(self) -> NDArray[np.bool_]:
        """Where a ball of row 1 is between the edges of the spall (S,)."""
        spacing = math.degrees(machine("gearbox").bearing.spacing)
        return np.abs((self.cage - math.degrees(BOTTOM) + spacing / 2.0) % spacing - spacing / 2.0) <= self.half_arc


def stiffness(*spalls: Spall) -> Stiffness:
    """Stiffness of the gearbox rig's rows at rest under its load [P14 Eq. 25, 26]."""
    of = scene("gearbox", *spalls)
    bearing = of.rig.bearing
    cage = np.radians(SHOWN) * np.arange(STEPS) / STEPS
    load = equilibrium(of, cage / of.cage.mean_speed).ball_load
    compression = bearing.compression(load)
    spring = bearing.exponent * bearing.load_deflection * compression ** (bearing.exponent - 1.0)
    angle = ball_angles(bearing, cage)
    c, s = np.cos(angle), np.sin(angle)
    parts = np.stack([np.sum(spring * product, axis=2) for product in (c * c, s * s, c * s)], axis=-1)
    return Stiffness(np.degrees(cage), parts.transpose(1, 0, 2) * 1e-6, half_arc(of))


def chapter() -> Chapter:
    """Figure 6 with its table."""
    found = {
        "healthy": stiffness(),
        "line": stiffness(line_spall("gearbox")),
        "extended": stiffness(wavy_extended_spall(SHOWN_SEED)),
        "reference": stiffness(reference_extended_spall(SHOWN_SEED)),
    }
    return Chapter(
        NAME,
        "Figure 6: quasi-static bearing stiffness against cage angle, gearbox rig",
        "The spalls of Figure 5, one cage angle every 0.025°. The stiffness of a row is the sum of its balls' "
        "tangents [Eq. 26] at the equilibrium of the whole bearing.",
        tuple(rows(found)),
        lambda: draw(found),
    )


def rows(found: dict[str, Stiffness]) -> list[Row]:
    """The table of Figure 6."""
    healthy, line, extended = found["healthy"], found["line"], found["extended"]
    swing = float(np.ptp(healthy.row[0, :, YY]))
    return [
        beside(NAME, "row_period", "period of kxx of one row, healthy", period(healthy.cage, healthy.row[0, :, XX])),
        beside(NAME, "total_period", "period of kxx of both rows, healthy", period(healthy.cage, healthy.total[:, XX])),
        beside(NAME, "healthy_variation_low", "variation of kyy of one row, healthy", swing),
        beside(NAME, "healthy_variation_high", "variation of kyy of one row, healthy", swing),
        *_line_rows(healthy, line),
        *_mean_rows(found),
        *_coupling_rows(line, extended),
        *_axis_rows(found),
    ]


def period(cage: Array, values: Array) -> float:
    """Shortest shift (degrees) after which `values` over 60° of cage angle repeat to a thousandth of their swing."""
    limit = 1e-3 * float(np.ptp(values))
    shifts = (int(shift) for shift in np.arange(1, values.size + 1))
    same = next(shift for shift in shifts if float(np.abs(np.roll(values, shift) - values).max()) <= limit)
    return float(same * (cage[1] - cage[0]))


def _line_rows(healthy: Stiffness, line: Stiffness) -> list[Row]:
    inside = line.ball_inside
    row_1 = float((line.row[0] - healthy.row[0])[inside, YY].min())
    row_2 = float((line.row[1] - healthy.row[1])[inside, YY].max())
    along = float((line.total - healthy.total)[inside, YY].min())
    across = float((line.total - healthy.total)[inside, XX].max())
    outside = float(np.abs(line.total - healthy.total)[~inside].max())
    net = "the fall of row 1 is the larger one; only so is the net result the fall that the paper draws"
    return [
        beside(NAME, "row_1_falls", "change of kyy of row 1, line", row_1, agrees=row_1 < 0.0, unit="MN/m"),
        beside(NAME, "row_2_rises", "change of kyy of row 2, line", row_2, agrees=row_2 > 0.0, unit="MN/m"),
        beside(
            NAME,
            "row_1_less_than_row_2",
            "fall of row 1 over rise of row 2, line",
            -row_1 / row_2,
            net if -row_1 > row_2 else "",
            agrees=-row_1 < row_2,
            unit="1",
        ),
        beside(NAME, "along_falls", "change of kyy of both rows, line", along, agrees=along < 0.0, unit="MN/m"),
        beside(NAME, "across_rises", "change of kxx of both rows, line", across, agrees=across > 0.0, unit="MN/m"),
        beside(
            NAME,
            "line_deviates_only_inside",
            "largest change with no ball in the line spall",
            outside,
            agrees=outside < 1e-6,
            unit="MN/m",
        ),
    ]


def _mean_rows(found: dict[str, Stiffness]) -> list[Row]:
    mean = {name: float(stiffness.total[:, YY].mean()) for name, stiffness in found.items()}
    lowest = mean["extended"] < mean["line"] < mean["healthy"]
    rows = [only_ours(f"mean kyy, {name}", mean[name], "MN/m") for name in ("healthy", "line")]
    rows.append(beside(NAME, "mean_is_lowest", "mean kyy, extended", mean["extended"], agrees=lowest, unit="MN/m"))
    lower = mean["reference"] < mean["line"]
    rows.append(
        beside(NAME, "mean_is_lowest", "mean kyy, reference profile G2r", mean["reference"], agrees=lower, unit="MN/m")
    )
    return rows


def _coupling_rows(line: Stiffness, extended: Stiffness) -> list[Row]:
    largest = {
        name: float(np.abs(stiffness.total[:, XY]).max())
        for name, stiffness in (("line", line), ("extended", extended))
    }
    rows = []
    for name, stiffness in (("line", line), ("extended", extended)):
        share = float(stiffness.total[:, XX].mean() / largest[name])
        rows.append(
            beside(
                NAME,
                "coupling_is_small",
                f"mean kxx over largest kxy, {name}",
                share,
                "smaller still" if share > MOST_APART else "",
                agrees=LEAST_APART <= share <= MOST_APART,
                unit="1",
            )
        )
        rows.append(beside(NAME, "coupling_axis", f"largest kxy, {name}", largest[name], "end of the axis"))
    ratio = largest["extended"] / largest["line"]
    rows.append(
        beside(NAME, "coupling_is_larger", "largest kxy, extended over line", ratio, agrees=ratio > 1.0, unit="1")
    )
    return rows


def _axis_rows(found: dict[str, Stiffness]) -> list[Row]:
    drawn = [found[name] for name in ("healthy", "line", "extended")]
    lowest = min(float(stiffness.row[:, :, XX].min()) for stiffness in drawn)
    highest = max(float(stiffness.total[:, XX].max()) for stiffness in drawn)
    least = min(float(stiffness.row[:, :, YY].min()) for stiffness in drawn)
    most = max(float(stiffness.total[:, YY].max()) for stiffness in drawn)
    return [
        beside(NAME, "across_low", "lowest kxx of a row", lowest, "end of the axis"),
        beside(NAME, "across_high", "highest kxx of both rows", highest, "end of the axis"),
        beside(NAME, "along_low", "lowest kyy of a row", least, "end of the axis"),
        beside(NAME, "along_high", "highest kyy of both rows", most, "end of the axis"),
    ]


def draw(found: dict[str, Stiffness]) -> Figure:
    """kxx, kyy and kxy from above, line spall on the left, extended spall on the right."""
    figure, grid = with_panels(3, 2, figsize=(10.0, 8.6), sharex=True, sharey="row")
    for column, (name, colour) in enumerate((("line", LINE), ("extended", EXTENDED))):
        for component, axes in enumerate(grid[:, column]):
            _draw_component(axes, found["healthy"], found[name], component, (colour, f"row 1, {name} spall"))
            letter(axes, "abcdef"[2 * component + column], f"{COMPONENTS[component]}, {name} spall")
        grid[2, column].set(xlabel="cage angle (°)", xlim=(0.0, SHOWN), xticks=np.arange(0.0, SHOWN + 1.0, 10.0))
    for axes in grid[:, 0]:
        axes.set_ylabel("MN/m")
    heading(
        figure,
        "Bearing stiffness against cage angle (counterpart of Figure 6)",
        "gearbox rig, 346 N; x across the load, y along it",
    )
    figure.subplots_adjust(left=0.07, right=0.985, top=0.9, bottom=0.125, hspace=0.27, wspace=0.09)
    legend_below(figure, list(grid[0]), columns=4)
    return figure


def _draw_component(
    axes: Axes, healthy: Stiffness, spalled: Stiffness, component: int, of_row_1: tuple[str, str]
) -> None:
    """One of kxx, kyy and kxy, MN/m against degrees, by row and in all.

    `of_row_1` is colour and name of the spalled row's curve.
    """
    colour, name = of_row_1
    dashed = (0, (3, 2))
    curves: tuple[tuple[Stiffness, Array, dict[str, Any]], ...] = (
        (healthy, healthy.row[0], {"color": HEALTHY, "linewidth": 1.0, "label": "healthy, one row"}),
        (
            healthy,
            healthy.row[1],
            {"color": HEALTHY, "linewidth": 1.0, "linestyle": dashed, "label": "healthy, other row"},
        ),
        (healthy, healthy.total, {"color": HEALTHY, "linewidth": 2.6, "alpha": 0.5, "label": "healthy, both rows"}),
        (spalled, spalled.row[1], {"color": PURPLE, "linewidth": 1.0, "label": "row 2, without spall"}),
        (spalled, spalled.row[0], {"color": colour, "linewidth": 1.0, "label": name}),
        (spalled, spalled.total, {"color": INK, "linewidth": 1.1, "label": "both rows, spalled"}),
    )
    for of, parts, look in curves:
        axes.plot(of.cage, parts[:, component], **look)
    faint_grid(axes)
