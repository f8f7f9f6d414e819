"""Figure 5: paths of the ball's centre and load distributions of the gearbox rig, with a line and an extended spall."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.drawing.style import EXTENDED, GREY, HEALTHY, LINE, PALE, PURPLE, faint_grid, with_panels
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
from physics.paths.profile import race_depth
from physics.reference_scenes import BOTTOM, line_spall
from physics.scene import Scene
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


NAME = "figure5"
CAGE_STEPS = 1200
SHOWN = (180.0, 360.0)
FULL_TURN = 360.0
CENTRE = math.degrees(BOTTOM)
TOUCHING = 1e-4


@dataclass(frozen=True)
class Distribution:
    """Loads of a scene over one ball spacing of the cage.

    `load` (2, A) in N of a ball of each row that stands at `angle` (A,), degrees; `in_spall` (S,) how many balls of
    row 1 lie between the edges of the spall at each cage angle; `vertical` (S,) sum of the loads along y, N.
    """

    scene: Scene
    angle: Array
    load: Array
    in_spall: NDArray[np.int64]
    vertical: Array

    @property
    def across(self) -> Array:
        """Loads along x (2, A), N."""
        return self.load * np.cos(np.radians(self.angle))

    @property
    def along(self) -> Array:
        """Loads against the static load (2, A), N: positive below the shaft, as the paper draws them."""
        return -self.load * np.sin(np.radians(self.angle))


def distribution(*spalls: Spall) -> Distribution:
    """The gearbox rig's load distribution [P14 Eq. 18-22], the cage turned through one ball spacing."""
    of = scene("gearbox", *spalls)
    bearing = of.rig.bearing
    cage = bearing.spacing * np.arange(CAGE_STEPS) / CAGE_STEPS
    load = equilibrium(of, cage / of.cage.mean_speed).ball_load
    place = np.degrees(ball_angles(bearing, cage)) % FULL_TURN
    grid = FULL_TURN * np.arange(bearing.balls * CAGE_STEPS) / (bearing.balls * CAGE_STEPS)
    on_grid = [
        np.interp(grid, place[:, row].ravel(), load[:, row].ravel(), period=FULL_TURN) for row in range(bearing.rows)
    ]
    inside = np.sum(np.abs(place[:, 0] - CENTRE) <= half_arc(of), axis=1)
    vertical = -np.sum(load * np.sin(np.radians(place)), axis=(1, 2))
    return Distribution(of, grid, np.array(on_grid), inside, vertical)


def chapter() -> Chapter:
    """Figure 5 with its table."""
    healthy, line = distribution(), distribution(line_spall("gearbox"))
    extended = distribution(wavy_extended_spall(SHOWN_SEED))
    reference = distribution(reference_extended_spall(SHOWN_SEED))
    return Chapter(
        NAME,
        "Figure 5: profiles and quasi-static load distributions, gearbox rig",
        "7 Hz, 346 N, no clearance, outer race, row 1, spall centred at 270°. Line: reference scene G1 (2°, 12 µm at "
        "the ball's centre, tapers 0.3°). Extended: 40° with long random waves (shortest 2 mm, 8 µm standard "
        "deviation about 4 µm, cut off at 0 and 15 µm), the profile that question 1 finds; the paper prints neither "
        "depth nor profile. The table also has the reference scene G2r (6 µm, 2 µm of roughness).",
        tuple(rows(healthy, line, extended, reference)),
        lambda: draw(healthy, line, extended),
    )


def rows(healthy: Distribution, line: Distribution, extended: Distribution, reference: Distribution) -> list[Row]:
    """The table of Figure 5."""
    bearing = machine("gearbox").bearing
    imbalance = float(np.abs(line.vertical - machine("gearbox").rated_load).max())
    zone = FULL_TURN * float(np.mean(healthy.load[0] > TOUCHING * healthy.load.max()))
    return [
        beside(NAME, "ball_spacing", "ball spacing of one row", math.degrees(bearing.spacing)),
        beside(NAME, "row_offset", "offset between the rows", math.degrees(bearing.stagger)),
        beside(NAME, "load_zone", "load zone, healthy", zone, "where a ball bears over 1e-4 of the largest load"),
        beside(NAME, "peak_load", "largest load of a ball, healthy", healthy.load.max(), "Eq. 24 beside Eq. 18 solved"),
        beside(
            NAME,
            "line_unloads",
            "smallest load of a ball in the line spall",
            _least_inside(line),
            agrees=_least_inside(line) == 0.0,
            unit="N",
        ),
        _more_elsewhere("line", line, healthy),
        _more_elsewhere("extended", extended, healthy),
        _balls_inside(extended),
        beside(
            NAME, "along_axis", "largest load along y, line", line.along.max(), "end of an axis with a legend in it"
        ),
        beside(NAME, "along_axis", "largest load along y, extended", extended.along.max(), "as above"),
        beside(NAME, "across_axis", "most negative load along x, line", line.across.min(), "end of the axis"),
        beside(NAME, "across_axis", "most negative load along x, extended", extended.across.min(), "end of the axis"),
        beside(NAME, "depth_axis", "deepest point, extended", _deepest(extended), "cut off there"),
        only_ours("largest load of a ball, reference profile G2r", reference.load.max(), "N"),
        only_ours("error of vertical equilibrium, largest", imbalance, "N", "should be none"),
    ]


def _least_inside(found: Distribution) -> float:
    return float(found.load[0][np.abs(found.angle - CENTRE) < half_arc(found.scene)].min())


def _more_elsewhere(name: str, found: Distribution, healthy: Distribution) -> Row:
    """By how much sound raceway carries more than in a healthy bearing, at the place where that is most."""
    sound = np.abs(found.angle - CENTRE) > half_arc(found.scene)
    more = max((found.load[0] - healthy.load[0])[sound].max(), (found.load[1] - healthy.load[1]).max())
    return beside(
        NAME, "others_take_over", f"most extra load on sound raceway, {name}", float(more), agrees=more > 1.0, unit="N"
    )


def _balls_inside(found: Distribution) -> Row:
    """How many balls the extended spall holds at once, on average."""
    low, high = int(found.in_spall.min()), int(found.in_spall.max())
    return beside(
        NAME,
        "balls_in_extended",
        "balls of row 1 in the extended spall, mean",
        float(found.in_spall.mean()),
        f"{low} or {high}: 40° hold two balls 30° apart only a third of the time; always at least one",
        agrees=low == high == 2,
        unit="balls",
    )


def _deepest(found: Distribution) -> float:
    return float(race_depth(found.scene, 1, np.radians(np.linspace(240.0, 300.0, 6001))).max() * 1e6)


def draw(healthy: Distribution, line: Distribution, extended: Distribution) -> Figure:
    """Profiles above loads along x and y, line spall on the left, extended spall on the right."""
    figure, grid = with_panels(3, 2, figsize=(10.0, 8.2), sharex=True, sharey="row")
    for column, (found, colour, name) in enumerate(((line, LINE, "line 2°"), (extended, EXTENDED, "extended 40°"))):
        _draw_profile(grid[0, column], found, colour)
        letter(grid[0, column], "ab"[column], f"Drop of the ball's centre, {name}")
        letter(grid[1, column], "cd"[column], f"Load along x, {name}")
        letter(grid[2, column], "ef"[column], f"Load along y, {name}")
        for axes, part in ((grid[1, column], "across"), (grid[2, column], "along")):
            _draw_loads(axes, getattr(healthy, part), getattr(found, part), found, colour)
        grid[2, column].set(xlabel="ball position (°)", xlim=SHOWN, xticks=np.arange(180.0, 361.0, 30.0))
    for row, name in enumerate(("depth (µm)", "N", "N")):
        grid[row, 0].set_ylabel(name)
    heading(
        figure,
        "Profiles and quasi-static load distributions (counterpart of Figure 5)",
        "gearbox rig, 346 N, no clearance; pale: arc of the spall",
    )
    figure.subplots_adjust(left=0.07, right=0.985, top=0.895, bottom=0.105, hspace=0.3, wspace=0.09)
    legend_below(figure, list(grid[2]))
    return figure


def _shade(axes: Axes, found: Distribution) -> None:
    half = half_arc(found.scene)
    axes.axvspan(CENTRE - half, CENTRE + half, color=PALE, alpha=0.55, linewidth=0, zorder=0)


def _draw_profile(axes: Axes, found: Distribution, colour: str) -> None:
    angle = np.linspace(*SHOWN, 7201)
    _shade(axes, found)
    axes.plot(angle, race_depth(found.scene, 1, np.radians(angle)) * 1e6, color=colour, label="row 1")
    axes.axhline(0.0, color=PURPLE, linewidth=0.9, label="row 2", zorder=1)
    axes.set(ylim=(16.0, -2.5))
    faint_grid(axes)


def _draw_loads(axes: Axes, healthy: Array, found: Array, of: Distribution, colour: str) -> None:
    _shade(axes, of)
    name = "line" if colour == LINE else "extended"
    axes.plot(of.angle, healthy[0], color=HEALTHY, linewidth=2.2, alpha=0.55, label="healthy, both rows")
    axes.plot(of.angle, found[1], color=PURPLE, linewidth=1.1, label="row 2, without spall")
    axes.plot(of.angle, found[0], color=colour, linewidth=1.1, label=f"row 1, {name} spall")
    axes.axhline(0.0, color=GREY, linewidth=0.5, zorder=0)
    faint_grid(axes)
