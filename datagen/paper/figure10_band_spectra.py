"""Figure 10: acceleration spectra of the gearbox rig in the demodulation band, and where the simulated pole lies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from datagen.drawing.style import EXTENDED, GREY, INK, LINE, ORANGE, PALE, SKY, faint_grid, with_panels
from datagen.paper.chapter import Chapter, Row, beside, only_ours
from datagen.paper.figure09_envelope_spectra import PAPER_BAND
from datagen.paper.panels import heading, legend_below, letter, power_decibel, spread
from datagen.paper.published import published_value
from datagen.paper.scenes import RATE, SEEDS, bpfo_hz, machine, scene, signal
from datagen.paper.simulated import SAME_FOR_ALL, shown, simulated
from labels.density import power_density
from physics.arrays import Array
from physics.catalog.claims import resonator_alone_hz, resonator_damping_ratio
from physics.modes import coupled_resonator_frequency, rated_matrices
from physics.reference_scenes import line_spall

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


NAME = "figure10"
RESOLUTION = 1.0
WIDE_BAND = (9500.0, 11500.0)
NEARLY_ALL = 90.0
TITLES = {
    "line": "line",
    "gap": "line, path of the ball's centre (G1p)",
    "extended": "extended",
    "reference": "extended G2r",
}
LIMITS = ((-83.0, -40.0), (-95.0, -25.0))
LINES_STAND_OUT = 6.0  # dB of a line above its surroundings


def band_level(acceleration: Array, band: tuple[float, float] = PAPER_BAND) -> tuple[Array, Array]:
    """Frequencies (F,) in Hz and levels (F,) in dB re 1 (m/s²)²/Hz in a band, at 1 Hz resolution."""
    frequency, power = power_density(acceleration, RATE, RESOLUTION)
    inside = (frequency >= band[0]) & (frequency <= band[1])
    return frequency[inside], power_decibel(power[inside])


def line_prominence(acceleration: Array) -> float:
    """Mean level at BPFO harmonics in the paper's band over that midway between them, dB."""
    frequency, level = band_level(acceleration)
    phase = (frequency / bpfo_hz("gearbox")) % 1.0
    near, far = np.minimum(phase, 1.0 - phase) < 0.03, np.abs(phase - 0.5) < 0.25
    return float(level[near].mean() - level[far].mean())


def chapter(count: int = len(SEEDS)) -> Chapter:
    """Figure 10 with its table."""
    levels = {name: [band_level(trace)[1] for trace in simulated(name, count)] for name in TITLES}
    slipping = np.array([line_prominence(trace) for trace in simulated("line", count)])
    steady = line_prominence(signal(scene("gearbox", line_spall("gearbox"))))
    return Chapter(
        NAME,
        "Figure 10: acceleration spectra in the demodulation band, gearbox rig",
        f"{SAME_FOR_ALL} Power densities at 1 Hz resolution between 10.2 and 10.4 kHz; the panels below show where "
        "the resonator rings once it hangs on the outer ring.",
        tuple(rows(levels, slipping, steady)),
        draw,
    )


def rows(levels: dict[str, list[Array]], slipping: Array, steady: float) -> list[Row]:
    """The table of Figure 10."""
    rig = machine("gearbox")
    alone, ratio = resonator_alone_hz(rig), resonator_damping_ratio(rig)
    pole = coupled_resonator_frequency(rig, rated_matrices(rig)[0])
    middle = float(np.median(slipping))
    found = [
        beside(NAME, "resonator_alone", "resonator alone", alone * 1e-3),
        only_ours("resonator on the outer ring", pole * 1e-3, "kHz", "outside the paper's 10.2 to 10.4 kHz"),
        beside(
            NAME, "damping", "damping of the resonator alone", ratio * 100.0, "Table 1's c_r, m_r and k_r give half"
        ),
        beside(
            NAME,
            "no_lines",
            "BPFO harmonics over what lies between, line spall, 1 % slip",
            middle,
            spread(slipping),
            agrees=middle < LINES_STAND_OUT,
            unit="dB",
        ),
        only_ours("the same without slip", steady, "dB", "lines stand out only when nothing slips"),
    ]
    for name, title in TITLES.items():
        all_levels = np.concatenate(levels[name])
        low, high = np.percentile(all_levels, [100.0 - NEARLY_ALL, NEARLY_ALL])
        found.append(
            beside(NAME, "lowest", f"level that {NEARLY_ALL:.0f} % exceed, {title}", float(low), "end of the axis")
        )
        comment = "end of the axis"
        found.append(
            beside(NAME, "highest", f"level that {NEARLY_ALL:.0f} % stay below, {title}", float(high), comment)
        )
    return found


def draw() -> Figure:
    """The paper's band above a wider one, line spalls on the left, extended spalls on the right."""
    figure, grid = with_panels(2, 2, figsize=(10.0, 7.0), sharey="row")
    pairs = ((("gap", SKY), ("line", LINE)), (("reference", ORANGE), ("extended", EXTENDED)))
    for column, pair in enumerate(pairs):
        for row, band in enumerate((PAPER_BAND, WIDE_BAND)):
            axes = grid[row, column]
            for name, colour in pair:
                frequency, level = band_level(shown(name), band)
                label = f"{TITLES[name]} spall" if name in ("line", "extended") else TITLES[name]
                axes.plot(frequency * 1e-3, level, color=colour, linewidth=0.7, label=label)
            axes.set(xlim=(band[0] * 1e-3, band[1] * 1e-3), xlabel="frequency (kHz)", ylim=LIMITS[row])
            axes.set_xticks(np.linspace(band[0] * 1e-3, band[1] * 1e-3, 5))
            faint_grid(axes)
        _mark_paper(grid[0, column], grid[1, column])
        kind = ("line spall", "extended spall")[column]
        letter(grid[0, column], "ab"[column], f"The paper's band, {kind}")
        letter(grid[1, column], "cd"[column], f"Around it, {kind}")
    for axes in grid[:, 0]:
        axes.set_ylabel("dB re 1 (m/s²)²/Hz")
    heading(
        figure,
        "Acceleration spectra in the demodulation band (counterpart of Figure 10)",
        "gearbox rig, 1 % slip, 1.4 s, Hann, 1 Hz; grey lines above: ends of the paper's axis; shaded below: its band",
    )
    figure.subplots_adjust(left=0.07, right=0.975, top=0.885, bottom=0.135, hspace=0.36, wspace=0.14)
    legend_below(figure, [grid[0, 0], grid[0, 1]])
    return figure


def _mark_paper(narrow: Axes, wide: Axes) -> None:
    for end in ("lowest", "highest"):
        narrow.axhline(published_value(NAME, end), color=GREY, linewidth=0.9, linestyle=(0, (5, 3)))
    wide.axvspan(PAPER_BAND[0] * 1e-3, PAPER_BAND[1] * 1e-3, color=PALE, alpha=0.6, linewidth=0, zorder=0)
    rig = machine("gearbox")
    pole = coupled_resonator_frequency(rig, rated_matrices(rig)[0]) * 1e-3
    wide.axvline(pole, color=INK, linewidth=0.8, linestyle=":")
    wide.annotate(
        f"mode at\n{pole:.2f} kHz",
        (pole, 1.0),
        (4, -2),
        xycoords=("data", "axes fraction"),
        textcoords="offset points",
        va="top",
        fontsize=7.5,
        color=INK,
    )
