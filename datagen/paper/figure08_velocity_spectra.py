"""Figure 8: velocity spectra of the gearbox rig, healthy, with a line spall and with an extended spall."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from datagen.drawing.style import GREEN, GREY, INK, LINE, PURPLE, faint_grid, with_panels
from datagen.paper.chapter import Chapter, Row, beside, only_ours
from datagen.paper.panels import cursor, heading, highest_near, legend_below, letter, power_decibel, spread
from datagen.paper.published import published_value
from datagen.paper.scenes import RATE, SEEDS, SHOWN_SEED, bpfo_hz, ftf_hz, scene, shaft_hz, signal, wavy_extended_spall
from datagen.paper.simulated import CONDITIONS, SAME_FOR_ALL, shown, simulated
from labels.density import velocity_density
from physics.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


NAME = "figure8"
RESOLUTION = 1.0
HARMONICS = 13
FIRST_READ = 3  # the paper's frequency axis, as far as the extracted text has it, runs from 105 to 455 Hz
REACH = 1.5
TOP = 470.0
SIXTH = 6
LEVELS = (-200.0, -75.0)


def harmonics(acceleration: Array) -> Array:
    """Levels (13,) of the BPFO harmonics of the velocity of the gearbox rig at 1 Hz resolution, dB re (m/s)²/Hz."""
    frequency, power = velocity_density(acceleration, RATE, RESOLUTION)
    targets = [bpfo_hz("gearbox") * k for k in range(1, HARMONICS + 1)]
    return highest_near(frequency, power_decibel(power), targets, REACH)[1]


def chapter(count: int = len(SEEDS)) -> Chapter:
    """Figure 8 with its table."""
    levels = {name: np.array([harmonics(trace) for trace in simulated(name, count)]) for name in CONDITIONS}
    return Chapter(
        NAME,
        "Figure 8: velocity spectra, gearbox rig",
        f"{SAME_FOR_ALL} Power densities at 1 Hz resolution, acceleration divided by 2πf. No gears, shaft or "
        "background are in the model. Where the paper's measured spectra hold gear and shaft lines, ours hold none.",
        tuple(rows(levels, sidebands(SHOWN_SEED))),
        draw,
    )


def rows(levels: dict[str, Array], sideband: float) -> list[Row]:
    """The table of Figure 8 from the harmonics' levels (seeds, 13) of each condition."""
    bpfo, line, healthy = bpfo_hz("gearbox"), levels["line"], levels["healthy"]
    below = float(np.median(np.max(healthy, axis=1) - np.max(line, axis=1)))
    even = float(np.median(np.mean(healthy[:, 1::2], axis=1) - np.mean(healthy[:, 0::2], axis=1)))
    return [
        beside(NAME, "bpfo", "BPFO", bpfo, "what the printed geometry gives"),
        beside(
            NAME, "sixth_harmonic", "sixth harmonic of the BPFO", SIXTH * bpfo, "six times the printed 34.2 is 205.2"
        ),
        beside(NAME, "gear_mesh", "gear mesh, 32 teeth", 32.0 * shaft_hz("gearbox"), "not modelled"),
        beside(
            NAME, "healthy_is_low", "strongest line, healthy over line spall", below, agrees=below < -40.0, unit="dB"
        ),
        beside(
            NAME,
            "healthy_period",
            "even over odd harmonics, healthy",
            even,
            "two staggered rows alike",
            agrees=even > 20.0,
            unit="dB",
        ),
        *_above_rows("extended", levels["extended"], line),
        *_above_rows("extended G2r", levels["reference"], line),
        beside(
            NAME,
            "no_sidebands",
            "cage sidebands of the sixth harmonic, equal balls, no slip",
            sideband,
            "question 2 answers for unequal balls",
            agrees=sideband < -60.0,
            unit="dB",
        ),
        *_harmonic_rows(levels),
    ]


def _harmonic_rows(levels: dict[str, Array]) -> list[Row]:
    line = np.median(levels["line"], axis=0)
    above = {name: np.median(levels[name] - levels["line"], axis=0) for name in ("extended", "reference")}
    return [
        only_ours(
            f"harmonic {k + 1} ({(k + 1) * bpfo_hz('gearbox'):.1f} Hz), extended over line",
            float(above["extended"][k]),
            "dB",
            f"line at {line[k]:.1f} dB; G2r {above['reference'][k]:+.1f} dB",
        )
        for k in range(HARMONICS)
    ]


def _above_rows(name: str, extended: Array, line: Array) -> list[Row]:
    above = extended - line
    mean = np.mean(above[:, FIRST_READ - 1 :], axis=1)
    sixth = above[:, SIXTH - 1]
    strongest = float(np.mean(np.argmax(extended, axis=1) == SIXTH - 1))
    return [
        beside(
            NAME,
            "extended_is_higher",
            f"harmonics 3 to 13, {name} over line",
            float(np.median(mean)),
            spread(mean),
            agrees=bool(np.median(mean) > 0.0),
            unit="dB",
        ),
        beside(
            NAME,
            "extended_is_higher",
            f"sixth harmonic, {name} over line",
            float(np.median(sixth)),
            spread(sixth),
            agrees=bool(np.median(sixth) > 0.0),
            unit="dB",
        ),
        beside(
            NAME,
            "sixth_stands_out",
            f"records whose sixth harmonic is the strongest, {name}",
            strongest,
            agrees=strongest > 0.5,
            unit="share",
        ),
    ]


def sidebands(seed: int) -> float:
    """Stronger cage sideband of the sixth harmonic over it, dB: extended spall, equal balls, steady cage."""
    frequency, power = velocity_density(signal(scene("gearbox", wavy_extended_spall(seed))), RATE, 1.0 / 1.4)
    sixth = SIXTH * bpfo_hz("gearbox")
    targets = [sixth, sixth - ftf_hz("gearbox"), sixth + ftf_hz("gearbox")]
    level = highest_near(frequency, power_decibel(power), targets, 0.4)[1]
    return float(level[1:].max() - level[0])


def draw() -> Figure:
    """One spectrum above the other: healthy, line, extended, extended by the reference profile."""
    figure, grid = with_panels(len(CONDITIONS), 1, figsize=(10.0, 10.0), sharex=True, sharey=True)
    for row, (axes, (name, (colour, title))) in enumerate(zip(grid, CONDITIONS.items(), strict=True)):
        _draw_spectrum(axes, shown(name), colour)
        if name in ("extended", "reference"):
            _mark_line_spall(axes)
        letter(axes, "abcd"[row], title[0].upper() + title[1:])
        axes.set_ylabel("dB re 1 (m/s)²/Hz")
    grid[-1].set(xlabel="frequency (Hz)", xlim=(0.0, TOP), ylim=LEVELS, xticks=np.arange(0.0, 456.0, 35.0))
    heading(
        figure,
        "Velocity spectra (counterpart of Figure 8, modelled side)",
        "gearbox rig, 7 Hz, 346 N, 1 % slip, 1.4 s, Hann, 1 Hz; dotted: where the paper's rig has its gear mesh",
    )
    figure.subplots_adjust(left=0.075, right=0.985, top=0.915, bottom=0.085, hspace=0.22)
    legend_below(figure, [grid[-1]])
    return figure


def _draw_spectrum(axes: Axes, acceleration: Array, colour: str) -> None:
    frequency, power = velocity_density(acceleration, RATE, RESOLUTION)
    level = power_decibel(power)
    shown = (frequency > 2.0) & (frequency < TOP)
    axes.plot(frequency[shown], level[shown], color=colour, linewidth=0.8)
    bpfo, ftf, shaft = bpfo_hz("gearbox"), ftf_hz("gearbox"), shaft_hz("gearbox")
    defect = [k * bpfo for k in range(1, HARMONICS + 1)]
    beside_them = [f + side * ftf for f in defect for side in (-1.0, 1.0)]
    mesh = published_value(NAME, "gear_mesh")
    for f in np.arange(1.0, TOP / shaft):
        axes.plot([f * shaft] * 2, [LEVELS[0], LEVELS[0] + 4.0], color=PURPLE, linewidth=1.0)
    axes.plot([], [], "|", color=PURPLE, label="shaft, 7 Hz and harmonics")
    cursor(axes, frequency, level, beside_them, 0.5, ("s", GREEN, f"BPFO harmonics ± cage, {ftf:.2f} Hz"))
    cursor(axes, frequency, level, defect, REACH, ("o", INK, f"BPFO {bpfo:.2f} Hz and harmonics"))
    axes.axvline(mesh, color=GREY, linewidth=0.8, linestyle=":", zorder=0)
    faint_grid(axes)


def _mark_line_spall(axes: Axes) -> None:
    """A short bar at the level that each harmonic has with the line spall of the panel above."""
    bpfo = bpfo_hz("gearbox") * np.arange(1, HARMONICS + 1)
    level = harmonics(shown("line"))
    axes.hlines(level, bpfo - 6.0, bpfo + 6.0, color=LINE, linewidth=1.6, label="the same harmonic with the line spall")
