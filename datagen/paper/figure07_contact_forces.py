"""Figure 7: forces on single balls and on the outer ring while balls pass a line and an extended spall."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from datagen.drawing.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    faint_grid,
    same_height,
    with_panels,
)
from datagen.paper.chapter import Chapter, Row, beside
from datagen.paper.panels import heading, legend_below, letter
from datagen.paper.scenes import RATE, SHOWN_SEED, ball_angles, reference_extended_spall, scene, wavy_extended_spall
from labels.truth import ball_passes
from physics.arrays import Array
from physics.reference_scenes import gap_line_spall, line_spall
from physics.request import FixedSteps
from physics.rms import rms
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium
from physics.trace import Kept

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


NAME = "figure7"
DURATION, SETTLED = 0.2, 0.05
BALLS = range(3, 10)
COLOURS = dict(zip(BALLS, (GREY, SKY, GREEN, VERMILLION, BLUE, ORANGE, PURPLE), strict=True))
# The net forces are no ball's, and have no ball's colour.
ALONG, ACROSS, ALONG_GAP = INK, "#999933", "#882255"
WINDOWS = {"line": (0.115, 0.125), "extended": (0.09, 0.16)}
BALL = 6
GAP = "line G1p, deep gap on the path of the ball's centre"


@dataclass(frozen=True)
class Forces:
    """Forces of a scene at `time` (T,), s: `dynamic` and quasi-static `static` (T, 2, balls) of each ball, N.

    `net` (T, 2): sum over the balls along x and against the load, the latter without the static load, N.
    `entry` and `leave` are the times at which balls 5, 6 and 7 of row 1 pass the edges of the spall, s.
    """

    time: Array
    dynamic: Array
    static: Array
    net: Array
    entry: dict[int, float]
    leave: dict[int, float]

    @property
    def settled(self) -> slice:
        """The samples after the start has died away."""
        return slice(round(SETTLED * RATE), None)

    @property
    def peak(self) -> float:
        """Largest net force along the load without the static load, N."""
        return float(np.abs(self.net[self.settled, 1]).max())

    @property
    def crest(self) -> float:
        """Peak over RMS of the net force along the load."""
        return self.peak / rms(self.net[self.settled, 1])

    @property
    def fluctuation(self) -> float:
        """RMS of all balls' forces about the quasi-static ones, N."""
        return rms((self.dynamic - self.static)[self.settled])


def forces(spall: Spall) -> Forces:
    """The gearbox rig from a cage angle of 0, without slip, 0.2 s."""
    of = scene("gearbox", spall, duration=DURATION)
    trace = simulate(of, RATE, FixedSteps(1), keep=Kept(force=True))
    if trace.contact_force is None:
        raise ValueError("the trace holds no contact forces")
    static = equilibrium(of, trace.time).ball_load
    passes = ball_passes(of, trace.changes, DURATION)
    around = {ball: np.flatnonzero((passes.ball == ball) & (passes.entry_time > SETTLED))[0] for ball in (5, 6, 7)}
    return Forces(
        trace.time,
        trace.contact_force,
        static,
        net_force(of, trace.time, trace.contact_force),
        {ball: float(passes.entry_time[k]) for ball, k in around.items()},
        {ball: float(passes.exit_time[k]) for ball, k in around.items()},
    )


def net_force(of: Scene, time: Array, force: Array) -> Array:
    """Sum of the balls' forces (T, 2) along x and against the load less the static load, N [P14 Eq. 8]."""
    angle = ball_angles(of.rig.bearing, of.cage.angle(time))
    across = np.sum(force * np.cos(angle), axis=(1, 2))
    along = -np.sum(force * np.sin(angle), axis=(1, 2)) - of.operation.load
    return np.column_stack([across, along])


def chapter() -> Chapter:
    """Figure 7 with its table."""
    found = {"line": forces(line_spall("gearbox")), "extended": forces(wavy_extended_spall(SHOWN_SEED))}
    others = {
        GAP: forces(gap_line_spall("gearbox")),
        "extended G2r, reference profile": forces(reference_extended_spall(SHOWN_SEED)),
    }
    return Chapter(
        NAME,
        "Figure 7: ball and net contact forces, gearbox rig",
        "The spalls of Figure 5, cage angle 0 at t = 0, no slip, so that quasi-static and dynamic forces belong to "
        "the same cage angle; 65 536 Hz, one step a sample. The windows in time are the paper's. The net force of "
        "the line spall depends on how its edges are drawn; the path of a ball's centre over a deep gap (G1p), which "
        "the paper says its profile follows approximately, stays within the paper's axis.",
        tuple(rows(found, others)),
        lambda: draw(found, others[GAP]),
    )


def rows(found: dict[str, Forces], others: dict[str, Forces]) -> list[Row]:
    """The table of Figure 7."""
    line, extended = found["line"], found["extended"]
    unloaded = _mean_while_released(line)
    shared = extended.leave[7] > extended.entry[6] and extended.entry[5] < extended.leave[6]
    return [
        *(
            beside(NAME, f"{name}_window_{end}", f"ball 6 {verb} the {name} spall", getattr(found[name], at)[BALL])
            for name in ("line", "extended")
            for end, verb, at in (("start", "enters", "entry"), ("end", "leaves", "leave"))
        ),
        beside(
            NAME,
            "after_ball_7",
            "ball 6 enters after ball 7, line",
            line.entry[6] - line.entry[7],
            agrees=line.entry[6] > line.entry[7],
            unit="s",
        ),
        beside(
            NAME,
            "with_ball_7",
            "ball 7 leaves after ball 6 enters, extended",
            extended.leave[7] - extended.entry[6],
            agrees=shared,
            unit="s",
        ),
        beside(NAME, "line_unloads", "mean force on ball 6 while released", unloaded, agrees=unloaded < 1.0, unit="N"),
        *(
            beside(NAME, "force_axis", f"largest force on a ball, {name}", float(forces.dynamic[forces.settled].max()))
            for name, forces in found.items()
        ),
        *(
            beside(NAME, "net_axis", f"largest net force along the load, {name}", forces.peak, "end of the axis")
            for name, forces in (found | others).items()
        ),
        *_comparison("extended", line, extended),
        *_comparison("extended G2r", line, others["extended G2r, reference profile"]),
    ]


def _mean_while_released(line: Forces) -> float:
    """Mean absolute force on ball 6 while its quasi-static load is zero, N."""
    released = (line.static[:, 0, BALL - 1] == 0.0) & (line.time > line.entry[BALL]) & (line.time < line.leave[BALL])
    return float(np.abs(line.dynamic[released, 0, BALL - 1]).mean())


def _comparison(name: str, line: Forces, extended: Forces) -> list[Row]:
    higher, sharper = line.peak / extended.peak, line.crest / extended.crest
    calmer = line.fluctuation / extended.fluctuation
    return [
        beside(NAME, "line_is_higher", f"largest net force, line over {name}", higher, agrees=higher > 1.0, unit="1"),
        beside(
            NAME, "line_is_more_impulsive", f"crest factor, line over {name}", sharper, agrees=sharper > 1.0, unit="1"
        ),
        beside(
            NAME,
            "around_static",
            f"fluctuation about the static loads, line over {name}",
            calmer,
            f"{line.fluctuation:.2g} and {extended.fluctuation:.2g} N RMS",
            agrees=calmer > 1.0,
            unit="1",
        ),
    ]


def draw(found: dict[str, Forces], gap: Forces) -> Figure:
    """Forces on the balls of row 1 and 2 and the net force from above; line spall left, extended spall right."""
    figure, grid = with_panels(3, 2, figsize=(10.0, 8.6), sharex="col")
    for column, (name, forces) in enumerate(found.items()):
        start, stop = WINDOWS[name]
        part = slice(math.floor(start * RATE), math.ceil(stop * RATE) + 1)
        for row in (0, 1):
            _draw_balls(grid[row, column], forces, part, row)
            letter(grid[row, column], "abcd"[2 * row + column], f"Force on balls of row {row + 1}, {name} spall")
        _draw_net(grid[2, column], forces, part)
        letter(grid[2, column], "ef"[column], f"Net force, {name} spall")
        if name == "line":
            axes, label = grid[2, column], "net, along the load, path of the ball's centre (G1p)"
            axes.plot(gap.time[part], gap.net[part, 1], color=ALONG_GAP, linewidth=0.9, label=label)
        grid[2, column].set(xlim=(start, stop), xlabel="time (s)")
    for row in range(3):
        same_height(list(grid[row]))
        grid[row, 0].set_ylabel("N")
        grid[row, 1].tick_params(labelleft=False)
    heading(
        figure,
        "Contact forces on single balls and their sum (counterpart of Figure 7)",
        "gearbox rig, 7 Hz, 346 N, no slip; thin: simulated, pale and wide: quasi-static; grey: ball 6 between the "
        "edges",
    )
    figure.subplots_adjust(left=0.065, right=0.985, top=0.9, bottom=0.135, hspace=0.24, wspace=0.06)
    legend_below(figure, [grid[0, 0], grid[2, 0], grid[2, 1]], columns=5)
    return figure


def _shade(axes: Axes, forces: Forces) -> None:
    """The time in which ball 6 is between the edges of the spall."""
    axes.axvspan(forces.entry[BALL], forces.leave[BALL], color=GREY, alpha=0.1, linewidth=0, zorder=0)


def _draw_balls(axes: Axes, forces: Forces, part: slice, row: int) -> None:
    for ball in BALLS:
        colour = COLOURS[ball]
        axes.plot(forces.time[part], forces.static[part, row, ball - 1], color=colour, linewidth=2.6, alpha=0.3)
        axes.plot(
            forces.time[part], forces.dynamic[part, row, ball - 1], color=colour, linewidth=0.8, label=f"ball {ball}"
        )
    _shade(axes, forces)
    faint_grid(axes)


def _draw_net(axes: Axes, forces: Forces, part: slice) -> None:
    axes.plot(
        forces.time[part], forces.net[part, 1], color=ALONG, linewidth=0.9, label="net, along the load, less 346 N"
    )
    axes.plot(forces.time[part], forces.net[part, 0], color=ACROSS, linewidth=0.9, label="net, across the load")
    _shade(axes, forces)
    faint_grid(axes)
