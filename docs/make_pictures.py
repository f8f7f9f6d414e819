"""Draw the pictures of the documentation again: `python docs/make_pictures.py` writes docs/pictures/*.png."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from datagen.drawing.preview import draw_preview
from datagen.drawing.style import (
    BLUE,
    GREY,
    INK,
    ORANGE,
    PALE,
    VERMILLION,
    faint_grid,
    outside_legend,
    png_of,
    same_height,
)
from datagen.drawing.time_panels import shade_passes
from labels.envelope import band_envelope, default_band, squared_envelope_spectrum
from labels.truth import PassTable, ball_passes
from physics.angular_speed import in_hertz
from physics.arrays import Array
from physics.paths.profile import build_path, wrap
from physics.reference_scenes import BOTTOM, reference_scene
from physics.scene import Scene
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium
from physics.trace import Kept, Trace

ROOT = Path(__file__).resolve().parent.parent
PICTURES, DATASETS = ROOT / "docs" / "pictures", ROOT / "datasets"
# Reference scene F1s (gradual entry, sharp exit) of the paper's fan rig.
PREVIEWED_DATASET, PREVIEWED_RECORD = "fan_rig", 2
RATE, DURATION, SEED = 65536.0, 2.0, 11
FLOOR = 0.02  # m/s² RMS, the same machine noise in all three columns
HIDDEN = 20.0  # times as large as the background, a response leaves nothing of it to see
ARC_SHOWN = math.radians(33.0)
SETTLED = 0.3
HARMONICS = 6
HEADING = "One machine in three states of health"
SUBHEADING = (
    "gearbox rig of Petersen et al. (2014), bearing Koyo 1205, spall on the outer race below the load  ·  "
    "420 rpm, 346 N, 1 % slip"
)


@dataclass(frozen=True)
class Column:
    """One state of health of the gearbox rig."""

    title: str
    scene: Scene
    trace: Trace
    passes: PassTable
    acceleration: Array


def main() -> None:
    """Draw every picture into docs/pictures."""
    PICTURES.mkdir(exist_ok=True)
    states = columns()
    (PICTURES / "states.png").write_bytes(png_of(lambda: draw_states(states), 120))
    draw_preview(DATASETS / PREVIEWED_DATASET / "recipe.toml", PREVIEWED_RECORD, PICTURES / "preview_fan.png")


def columns() -> list[Column]:
    """Healthy, line and extended: the same machine, load, speed, slip and noise."""
    return [
        column("Healthy", "G0"),
        column("Line spall: 2° (0.8 mm)", "G1"),
        column("Extended spall: 40° (16 mm), rough", "G2r"),
    ]


def column(title: str, name: str) -> Column:
    """One simulated state, a reference scene of that name."""
    scene = reference_scene(name, DURATION, slip_seed=SEED, roughness_seed=SEED)
    trace = simulate(scene, RATE, keep=Kept(force=True))
    noise = FLOOR * np.random.default_rng(SEED).standard_normal(trace.time.size)
    return Column(title, scene, trace, ball_passes(scene, trace.changes, DURATION), trace.acceleration[:, 1] + noise)


def draw_states(states: list[Column]) -> Figure:
    """A column a state, and below each other path, force on a ball, acceleration and squared envelope spectrum."""
    figure = Figure(figsize=(13.0, 9.4))
    blocks = figure.add_gridspec(
        3, 1, height_ratios=(1.75, 1.0, 1.1), left=0.075, right=0.985, top=0.885, bottom=0.055, hspace=0.36
    )
    upper = blocks[0].subgridspec(2, len(states), height_ratios=(0.75, 1.0), hspace=0.2, wspace=0.17)
    lower = [blocks[k].subgridspec(1, len(states), wspace=0.17) for k in (1, 2)]
    rows = [(upper, 0), (upper, 1), (lower[0], 0), (lower[1], 0)]
    grid = np.array([[figure.add_subplot(part[row, k]) for k in range(len(states))] for part, row in rows])
    figure.text(0.075, 0.962, HEADING, fontsize=13, fontweight="bold", color=INK)
    figure.text(0.075, 0.938, SUBHEADING, fontsize=9, color=GREY)
    for state, panels in zip(states, grid.T, strict=True):
        _draw_path(panels[0], state)
        _draw_force(panels[1], state)
        _draw_acceleration(panels[2], state)
        _draw_envelope_spectrum(panels[3], state)
        panels[0].set_title(state.title, fontsize=11, pad=8)
    for row, name in enumerate(
        (
            "drop of a ball's\ncentre (µm)",
            "force on that\nball (N)",
            "acceleration (m/s²);\nscales differ",
            "squared envelope\nspectrum ((m/s²)²)",
        )
    ):
        grid[row, 0].set_ylabel(name)
    for row in (0, 1, 3):
        same_height(list(grid[row]))
    figure.align_ylabels(grid[:, 0])
    return figure


def _draw_path(axes: Axes, state: Column) -> None:
    arc = np.linspace(-ARC_SHOWN, ARC_SHOWN, 4001)
    drop = np.zeros(arc.size)
    for spall in state.scene.spalls:
        drop += build_path(spall, state.scene.rig.bearing).depth(arc) * 1e6
    axes.fill_between(np.degrees(arc), drop, -3.0, color=PALE, linewidth=0)
    axes.plot(np.degrees(arc), drop, color=INK, linewidth=1.2)
    axes.set(xlim=np.degrees([-ARC_SHOWN, ARC_SHOWN]), ylim=(14.0, -3.0))
    axes.tick_params(labelbottom=False)


def _draw_force(axes: Axes, state: Column) -> None:
    """The ball that passes the bottom of row 1 in the middle of the record, simulated and quasi-static."""
    arc, part, ball = _passing_ball(state)
    force = state.trace.contact_force
    if force is None:
        raise ValueError("the trace holds no contact forces")
    rest = equilibrium(state.scene, state.trace.time[part]).ball_load[:, 0, ball]
    axes.plot(np.degrees(arc), force[part, 0, ball], color=BLUE, linewidth=0.7, label="simulated")
    axes.plot(np.degrees(arc), rest, color=ORANGE, linewidth=1.4, label="quasi-static")
    axes.set(xlim=np.degrees([-ARC_SHOWN, ARC_SHOWN]), xlabel="angle from the direction of the load (°)")
    faint_grid(axes)
    if not state.scene.spalls:
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 0.08))


def _passing_ball(state: Column) -> tuple[Array, slice, int]:
    cage, spacing = state.scene.cage, state.scene.rig.bearing.spacing
    middle = float(cage.angle(np.array([DURATION / 2.0]))[0])
    ball = round((BOTTOM - middle) / spacing) % state.scene.rig.bearing.balls
    arc = wrap(cage.angle(state.trace.time) + ball * spacing - BOTTOM)
    near = np.abs(state.trace.time - DURATION / 2.0) < math.pi / cage.mean_speed / 2.0
    shown = np.flatnonzero(near & (np.abs(arc) <= ARC_SHOWN))
    part = slice(int(shown[0]), int(shown[-1]) + 1)
    return arc[part], part, ball


def _draw_acceleration(axes: Axes, state: Column) -> None:
    cage = state.scene.cage
    width = 3.4 * state.scene.rig.bearing.spacing / cage.mean_speed
    start, stop = DURATION / 2.0 - width / 2.0, DURATION / 2.0 + width / 2.0
    part = slice(int(start * RATE), int(stop * RATE))
    time = (state.trace.time[part] - start) * 1e3
    visible = float(np.abs(state.trace.acceleration[part]).max()) < HIDDEN * FLOOR
    label = "with background" if visible else None
    axes.plot(time, state.acceleration[part], color=GREY, linewidth=0.6, label=label)
    axes.plot(time, state.trace.acceleration[part, 1], color=BLUE, linewidth=0.7, label="clean")
    shade_passes(axes, state.passes, start)
    limit = 1.15 * float(np.abs(state.acceleration[part]).max())
    axes.set(xlim=(0.0, width * 1e3), ylim=(-limit, limit), xlabel="time (ms); shaded: a ball in the spall, dark: two")
    faint_grid(axes)
    outside_legend(axes)


def _draw_envelope_spectrum(axes: Axes, state: Column) -> None:
    rig = state.scene.rig
    settled = state.acceleration[int(SETTLED * RATE) :]
    frequency, amplitude = squared_envelope_spectrum(band_envelope(settled, RATE, default_band(rig, RATE)), RATE)
    bpfo = in_hertz(rig.bearing.bpfo * rig.rated_speed)
    shown = (frequency > 0.0) & (frequency < (HARMONICS + 0.6) * bpfo)
    axes.semilogy(frequency[shown], amplitude[shown], color=BLUE, linewidth=0.8)
    for k in range(1, HARMONICS + 1):
        near = np.flatnonzero(np.abs(frequency - k * bpfo) < 0.015 * k * bpfo + 1.0)
        best = near[np.argmax(amplitude[near])]
        axes.plot(
            frequency[best], amplitude[best], "o", color=VERMILLION, markerfacecolor="none", markeredgewidth=1.3,
            linestyle="", label="BPFO and its harmonics" if k == 1 else None,
        )  # fmt: skip
    axes.set(xlim=(0.0, (HARMONICS + 0.6) * bpfo), xlabel="frequency (Hz)")
    axes.margins(y=0.12)
    faint_grid(axes)
    outside_legend(axes)


if __name__ == "__main__":
    main()
