"""The sheet of an imported recording: whole record, close-up, spectrogram, spectrum and squared envelope spectrum."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from datagen.counts import digits
from datagen.drawing.decibel_panel import draw_decibels
from datagen.drawing.frequency_panels import (
    HARMONICS,
    above,
    decades,
    draw_spectrum,
    envelope_end,
    line_heights,
    mark_lines,
)
from datagen.drawing.measured_portrait import MeasuredPortrait
from datagen.drawing.sheet import DPI
from datagen.drawing.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    VERMILLION,
    faint_grid,
    outside_legend,
    png_of,
)
from datagen.drawing.time_panels import DYNAMIC_RANGE_DB
from labels.schema import UNKNOWN
from labels.spectrogram import spectrogram

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT = 13.0, 9.0
MARKS = {
    "BPFO": ("o", VERMILLION),
    "BPFI": ("D", GREEN),
    "BSF": ("^", ORANGE),
    "FTF": ("v", ORANGE),
    "shaft": ("s", PURPLE),
}
PLACES = {
    "none": "healthy",
    "outer": "defect on the outer race",
    "inner": "defect on the inner race",
    "ball": "defect on a ball",
    "cage": "defect of the cage",
    "several": "defects in several places",
}
SHAFT_HARMONICS = 3
ORDERS_WITHOUT_GEOMETRY = 30.0
HERTZ_WITHOUT_SPEED = 500.0


def measured_sheet_png(portrait: MeasuredPortrait) -> bytes:
    """The sheet of one imported recording as the bytes of a PNG file."""
    return png_of(lambda: draw_measured_sheet(portrait), DPI)


def draw_measured_sheet(portrait: MeasuredPortrait) -> Figure:
    """The figure of one imported recording, all panels with units."""
    figure = Figure(figsize=(WIDTH, HEIGHT))
    grid = figure.add_gridspec(
        3, 2, height_ratios=(0.8, 1.0, 1.1), left=0.06, right=0.975, top=0.885, bottom=0.06, hspace=0.42, wspace=0.17
    )
    draw_whole(figure.add_subplot(grid[0, :]), portrait)
    close_up = figure.add_subplot(grid[1, 0])
    draw_close_up(close_up, portrait)
    draw_close_spectrogram(figure.add_subplot(grid[2, 0], sharex=close_up), portrait)
    draw_spectrum(figure.add_subplot(grid[1, 1]), portrait.main_axis, portrait.rate, portrait.band, portrait.axis)
    draw_expected_lines(figure.add_subplot(grid[2, 1]), portrait)
    # Names of files and machines may hold dollar signs, which are no mathematics.
    figure.text(0.06, 0.965, heading(portrait), fontsize=13, fontweight="bold", color=INK, parse_math=False)
    figure.text(0.06, 0.935, summary(portrait), fontsize=9, color=GREY, parse_math=False)
    return figure


def heading(portrait: MeasuredPortrait) -> str:
    """One line: which record, which recording, what is known of its state."""
    labels = portrait.labels
    state = PLACES.get(labels["location"], "state unknown")
    kind = f"{labels['condition']} " if labels["condition"] in ("line", "extended") else ""
    return f"{portrait.corpus}, record {labels['record']}: {labels['recording']}, {kind}{state}"


def summary(portrait: MeasuredPortrait) -> str:
    """One line: machine, speed and how it is known, load, size, length and rate."""
    labels = portrait.labels
    parts = [
        _machine(portrait),
        _speed(portrait),
        f"{digits(labels['load_n'], 5)} N" if math.isfinite(labels["load_n"]) else "load unknown",
        f"{labels['extent_mm']:.3g} mm" if labels["extent_mm"] > 0.0 else "",
        f"{portrait.duration:.4g} s at {portrait.rate:.6g} Hz",
    ]
    return "  ·  ".join(part for part in parts if part)


def _machine(portrait: MeasuredPortrait) -> str:
    """What was measured, as far as it is known."""
    rig, bearing, balls = *(portrait.labels[name] for name in ("rig", "bearing")), portrait.labels.get("balls", 0.0)
    on = "measured" if rig == UNKNOWN else f"measured on {rig}"
    if bearing != UNKNOWN:
        return f"{on}, bearing {bearing}"
    return f"{on}, {balls:.0f} balls in a row" if balls > 0 else on


def _speed(portrait: MeasuredPortrait) -> str:
    rpm, basis = portrait.labels["speed_rpm"], portrait.labels["speed_basis"]
    if not rpm >= 0.0:
        return "speed unknown"
    return f"{digits(rpm, 4)} rpm ({basis}{', changing' if portrait.shaft_angle is not None else ''})"


def draw_whole(axes: Axes, portrait: MeasuredPortrait) -> None:
    """The whole record and where the close-up lies, m/s² against s."""
    axes.plot(portrait.time, portrait.main_axis, color=BLUE, linewidth=0.6)
    axes.axvspan(*portrait.window, color=ORANGE, alpha=0.3, linewidth=0, zorder=0)
    axes.set(xlim=(0.0, portrait.duration), xlabel="time (s)", ylabel="m/s²")
    axes.set_title(f"Acceleration, {portrait.axis} axis, whole record (close-up marked)")
    faint_grid(axes)


def draw_close_up(axes: Axes, portrait: MeasuredPortrait) -> None:
    """A few revolutions, m/s² against ms."""
    part = portrait.window.part(portrait.time)
    axes.plot(portrait.time[part] * 1e3, portrait.main_axis[part], color=BLUE, linewidth=0.8)
    axes.set(xlim=(portrait.window[0] * 1e3, portrait.window[1] * 1e3), ylabel="m/s²", xlabel="time (ms)")
    axes.set_title("Close-up about the largest amplitude")
    faint_grid(axes)


def draw_close_spectrogram(axes: Axes, portrait: MeasuredPortrait) -> None:
    """Spectrogram of the close-up in dB below its maximum, kHz against ms."""
    time, frequency, power = spectrogram(portrait.main_axis, portrait.rate, *portrait.window)
    draw_decibels(axes, time, frequency, power, span=DYNAMIC_RANGE_DB)
    axes.set(ylim=(0.0, portrait.rate / 2e3), ylabel="kHz", xlabel="time (ms)")
    axes.set_title(f"Spectrogram, {DYNAMIC_RANGE_DB:.0f} dB")


def draw_expected_lines(axes: Axes, portrait: MeasuredPortrait) -> None:
    """Squared envelope spectrum, (m/s²)² against Hz, with the lines that the labels lead to expect.

    Where the speed changes, over the angle of the shaft, against orders times its mean speed.
    """
    top = _top(portrait)
    frequency, amplitude = portrait.envelope_spectrum(top)
    shown = (frequency > 0.0) & (frequency <= top)
    limits = decades(amplitude[shown])
    axes.semilogy(frequency[shown], above(amplitude[shown], limits), color=BLUE, linewidth=0.7)
    for name in (*portrait.expected_lines, *(("shaft",) if "shaft" in portrait.frequencies else ())):
        marker, colour = MARKS[name]
        line = portrait.frequencies[name]
        count = SHAFT_HARMONICS if name == "shaft" else HARMONICS
        harmonics = [k * line for k in range(1, count + 1) if k * line < top]
        heights = line_heights(frequency, amplitude, harmonics, line)
        mark_lines(axes, heights, marker, colour, f"{name} {line:.4g} Hz")
    turned = portrait.shaft_angle is not None
    words = "orders of the shaft times its mean speed (Hz)" if turned else "frequency (Hz)"
    axes.set(xlim=(0.0, top), ylim=limits, xlabel=words, ylabel="(m/s²)²")
    axes.set_title("Squared envelope, by angle" if turned else "Squared envelope spectrum")
    faint_grid(axes)
    if portrait.frequencies:
        outside_legend(axes)


def _top(portrait: MeasuredPortrait) -> float:
    """Highest frequency shown, Hz."""
    known = portrait.frequencies
    top = ORDERS_WITHOUT_GEOMETRY * known["shaft"] if "shaft" in known else HERTZ_WITHOUT_SPEED
    line = max((known[name] for name in portrait.expected_lines), default=0.0)
    if portrait.expected_lines:
        top = (HARMONICS + 0.6) * line
    return envelope_end(top, line, portrait.band, portrait.rate)
