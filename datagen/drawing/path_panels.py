"""Panels against the place of a ball: the path of its centre over the spall and the load that it carries there."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from datagen.drawing.portrait import Portrait
from datagen.drawing.style import BLUE, GREY, INK, ORANGE, PALE, VERMILLION, faint_grid, outside_legend
from physics.arrays import Array
from physics.cage import CagePath
from physics.paths.profile import build_path, wrap
from physics.scene import Scene
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium

if TYPE_CHECKING:
    from matplotlib.axes import Axes


POINTS = 1201
MARGIN = 0.35
LOAD_DIRECTION = 1.5 * math.pi


def draw_path(axes: Axes, portrait: Portrait) -> None:
    """Drop of an element's centre in µm against the arc from the spall's centre in degrees of travel, downwards."""
    scene = portrait.scene
    spall = portrait.shown_spall
    arc = shown_arcs(spall)
    faint_grid(axes)
    if spall is None:
        _draw_good_races(axes, scene, arc)
        what = "waviness only" if scene.imperfections.waviness else "no defect"
        axes.set_title(f"Path of a {portrait.element}'s centre: {what}")
        return
    bearing = scene.rig.bearing
    path = build_path(spall, bearing)
    drop = path.depth(arc) * 1e6
    axes.fill_between(np.degrees(arc), drop, 0.0, color=PALE, linewidth=0)
    axes.plot(np.degrees(arc), drop, color=BLUE, linewidth=1.5)
    lowest = path.depth(np.array([path.deepest])) * 1e6
    axes.plot(math.degrees(path.deepest), lowest, marker="v", color=INK, markersize=5, linestyle="")
    deepest = max(float(drop.max()), 1e-3)
    axes.set(ylim=(1.3 * deepest, min(float(drop.min()), 0.0) - 0.18 * deepest), ylabel="drop (µm)")
    _mark_edges(axes, spall)
    floor = ", bridged" if path.bridged else ""
    which = f"spall {scene.spalls.index(spall) + 1} of {len(scene.spalls)}," if len(scene.spalls) > 1 else "spall of"
    axes.set_title(
        f"Path of a {portrait.element}'s centre: {which} {math.degrees(spall.extent):.3g}° = "
        f"{spall.length(bearing) * 1e3:.3g} mm, drop {path.largest_depth * 1e6:.3g} µm{floor}"
    )


def _draw_good_races(axes: Axes, scene: Scene, arc: Array) -> None:
    waves, place = scene.imperfections.waviness, arc + LOAD_DIRECTION
    for race, when, colour in (("outer", "", BLUE), ("inner", " at t = 0", VERMILLION)):
        wavy = [wave.amplitude * np.cos(wave.order * place + wave.phase) for wave in waves if wave.race == race]
        drop = np.sum([np.zeros(arc.size), *wavy], axis=0) * 1e6
        axes.plot(np.degrees(arc), drop, color=colour, linewidth=1.2, label=f"{race} race{when}")
    axes.set_ylabel("drop (µm)")
    if waves:
        axes.invert_yaxis()
        outside_legend(axes)
    else:
        axes.set_ylim(1.0, -1.0)


def draw_element_load(axes: Axes, portrait: Portrait) -> None:
    """Quasi-static load of the ball or roller, N, over the same arc; where no pass is shown, over a full turn."""
    spall, k = portrait.shown_spall, portrait.shown_pass
    if spall is None or k is None:
        arc, load = load_around(portrait.scene)
        axes.set_title(f"Quasi-static load of a {portrait.element} on a full turn")
        axes.set_xlim(-180.0, 180.0)
        axes.set_xlabel("angle from the direction of the load (°)")
    else:
        arc, load = load_over_spall(portrait, spall, k)
        axes.set_title(f"Quasi-static load of {portrait.element_of(k)} on its way over the spall")
        axes.set_xlabel("arc from the spall's centre in the direction of travel (°)")
        _mark_edges(axes, spall)
    axes.plot(np.degrees(arc), load, color=VERMILLION, linewidth=1.5)
    axes.set_ylim(-0.05 * max(load.max(), 1e-9), 1.15 * max(load.max(), 1e-9))
    axes.set_ylabel("load (N)")
    faint_grid(axes)


def shown_arcs(spall: Spall | None) -> Array:
    """Arcs (P,) of the panels, rad: the spall with some margin, or the whole race."""
    half = math.pi if spall is None else min((0.5 + MARGIN) * spall.extent, math.pi)
    return np.linspace(-half, half, POINTS)


def load_over_spall(portrait: Portrait, spall: Spall, k: int) -> tuple[Array, Array]:
    """Arc (P,) in rad and quasi-static load (P,) in N of the ball of pass `k` from before entry until after exit."""
    table, scene = portrait.passes, portrait.scene
    length = table.exit_time[k] - table.entry_time[k]
    start, stop = table.entry_time[k] - MARGIN * length, table.exit_time[k] + MARGIN * length
    time = np.linspace(max(start, 0.0), min(stop, portrait.duration), POINTS)
    row, ball = spall.row - 1, int(table.ball[k]) - 1
    load = equilibrium(scene, time).ball_load[:, row, ball]
    bearing = scene.rig.bearing
    angle = scene.cage_of(spall.row).angle(time) + ball * bearing.spacing + row * bearing.stagger
    return spall.travel_sign * wrap(angle - spall.angle - scene.race_speed(spall.race) * time), load


def load_around(scene: Scene) -> tuple[Array, Array]:
    """Angle (P,) from the direction of the load in rad and quasi-static load (P,) in N of a ball on a full turn."""
    turn = 2.0 * math.pi / scene.cage.mean_speed
    steady = CagePath(scene.cage.mean_speed, turn, LOAD_DIRECTION - math.pi)
    time = np.linspace(0.0, turn, POINTS)
    rest = equilibrium(replace(scene, cage=steady, second_cage=None), time)
    return np.linspace(-math.pi, math.pi, POINTS), rest.ball_load[:, 0, 0]


def _mark_edges(axes: Axes, spall: Spall) -> None:
    half = math.degrees(spall.extent / 2.0)
    for edge, side, name in ((-half, "right", "entry "), (half, "left", " exit")):
        axes.axvline(edge, color=ORANGE, linewidth=1.0, linestyle=(0, (4, 2)))
        axes.annotate(
            name, (edge, 1.0), xycoords=("data", "axes fraction"), xytext=(0, -2), textcoords="offset points",
            ha=side, va="top", fontsize=7.5, color=GREY,
        )  # fmt: skip
