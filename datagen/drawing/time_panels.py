"""Panels against time: the whole record, the close-up with its ball passes, the stiffness and the spectrogram."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.drawing.decibel_panel import draw_decibels, frequencies_along_y, mark_frequencies
from datagen.drawing.portrait import Portrait
from datagen.drawing.style import BLUE, GREEN, GREY, INK, ORANGE, PALE, VERMILLION, faint_grid, outside_legend
from labels.spectrogram import spectrogram
from labels.truth import PassTable
from physics.arrays import Array
from physics.modes import modes
from physics.outcome import StaticOutcome
from physics.rms import rms
from physics.statics.load_distribution import equilibrium
from physics.statics.stiffness import symmetric_matrices

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DYNAMIC_RANGE_DB = 70.0
MOST_NAMED_PASSES = 8
LETTER_WIDTH = 0.0105  # of the width of the close-up, in names of passes
MOST_BOLD_EVENTS = 12
LEAST_STIFFNESS_SPAN = 2e-3  # of its value: less is not worth an axis


def draw_trace(axes: Axes, portrait: Portrait) -> None:
    """The whole record, y axis, and where the close-up lies."""
    _draw_signal(axes, portrait, slice(None), 1.0)
    axes.axvspan(*portrait.window, color=ORANGE, alpha=0.22, linewidth=0, zorder=0)
    axes.set(xlim=(0.0, portrait.duration), xlabel="time (s)", ylabel="m/s²")
    axes.set_title("Acceleration, y axis, whole record (close-up marked)")
    faint_grid(axes)
    outside_legend(axes)


def draw_part(axes: Axes, portrait: Portrait, signal: Array, colour: str, title: str) -> None:
    """One signal (T, 2) of the whole record, y axis, on its own scale, with its RMS."""
    axes.plot(portrait.time, signal[:, 1], color=colour, linewidth=0.5)
    axes.axvspan(*portrait.window, color=ORANGE, alpha=0.22, linewidth=0, zorder=0)
    axes.set(xlim=(0.0, portrait.duration), ylabel="m/s²")
    axes.set_title(f"{title}: RMS {rms(signal[:, 1]):.3g} m/s²")
    faint_grid(axes)


def draw_close_up(axes: Axes, portrait: Portrait) -> None:
    """A few ball passes of the trace in ms, with the release and regain of each ball."""
    _draw_signal(axes, portrait, portrait.window.part(portrait.time), 1e3)
    table = portrait.passes
    for times, colour, name in (
        (table.release_time, VERMILLION, f"release of a {portrait.element}"),
        (table.regain_time, GREEN, "regain of contact"),
    ):
        inside = times[(times >= portrait.window[0]) & (times <= portrait.window[1])]
        width = 0.9 if inside.size <= MOST_BOLD_EVENTS else 0.5
        for k, instant in enumerate(inside):
            axes.axvline(instant * 1e3, color=colour, linewidth=width, zorder=1, label=name if k == 0 else None)
    axes.set(ylabel="m/s²")
    axes.set_title("Close-up")
    axes.tick_params(labelbottom=False, bottom=False)
    axes.spines["bottom"].set_visible(False)
    faint_grid(axes)
    outside_legend(axes)


def _draw_signal(axes: Axes, portrait: Portrait, part: slice, scale: float) -> None:
    time = portrait.time[part] * scale
    clean = portrait.undisturbed
    noisy = clean is not None and not np.array_equal(clean, portrait.acceleration)
    if noisy or clean is None:
        color, label = GREY if noisy else BLUE, portrait.recorded_words
        axes.plot(time, portrait.acceleration[part, 1], color=color, linewidth=0.7, label=label)
    if clean is not None:
        axes.plot(time, clean[part, 1], color=BLUE, linewidth=0.8, label="clean")


def draw_passes(axes: Axes, portrait: Portrait) -> None:
    """A bar from entry to exit for each ball pass in the close-up, its deepest point marked, against time in ms."""
    table, (start, stop) = portrait.passes, portrait.window
    shown = np.flatnonzero((table.exit_time > start) & (table.entry_time < stop))
    names = [f"  {portrait.element_of(int(k))}" if shown.size <= MOST_NAMED_PASSES else "" for k in shown]
    room = LETTER_WIDTH * (stop - start) * max(map(len, names), default=0)
    lanes = free_lanes(table.entry_time[shown], table.exit_time[shown] + room)
    for k, lane, name in zip(shown, lanes, names, strict=True):
        entry, leave = table.entry_time[k] * 1e3, table.exit_time[k] * 1e3
        axes.barh(lane, leave - entry, left=entry, height=0.6, color=ORANGE if table.loaded[k] else PALE, linewidth=0)
        axes.plot(table.deepest_time[k] * 1e3, lane, marker="|", color=INK, markersize=5)
        if name and leave < (stop - room) * 1e3:
            axes.text(leave, lane, name, va="center", ha="left", fontsize=7, color=INK)
    deepest_lane = max(lanes, default=0)
    axes.set(ylim=(deepest_lane + 0.6, -0.6), yticks=[])
    axes.set_ylabel("entry\nto exit", rotation=0, ha="right", va="center", fontsize=7.5)
    axes.tick_params(labelbottom=False)
    axes.spines["left"].set_visible(False)
    if shown.size == 0:
        words = "no ball passes a spall in this time" if portrait.scene.spalls else "no defect to pass"
        axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", va="center", color=GREY)


def shade_passes(axes: Axes, passes: PassTable, start: float) -> None:
    """The times in which a ball is in a spall, shaded on an axis in ms from `start` (s) on."""
    for entry, leave in zip(passes.entry_time, passes.exit_time, strict=True):
        axes.axvspan((entry - start) * 1e3, (leave - start) * 1e3, color=ORANGE, alpha=0.22, linewidth=0, zorder=0)


def free_lanes(entry: NDArray[np.float64], leave: NDArray[np.float64]) -> list[int]:
    """The first free lane for each bar, so that overlapping passes lie one below the other."""
    free_from: list[float] = []
    lanes = []
    for start, stop in zip(entry, leave, strict=True):
        lane = next((k for k, free in enumerate(free_from) if free <= start), len(free_from))
        free_from[lane : lane + 1] = [stop]
        lanes.append(lane)
    return lanes


def draw_stiffness(axes: Axes, portrait: Portrait) -> None:
    """Quasi-static stiffness in the close-up, MN/m against ms: kyy along the load (left), kxx across it (right)."""
    fine = np.linspace(*portrait.window, 1201)
    across = axes.twinx()
    for panel, row, colour, name in ((axes, 1, BLUE, "kyy"), (across, 0, VERMILLION, "kxx")):
        values = np.interp(fine, portrait.stiffness_time, portrait.stiffness[row]) * 1e-6
        panel.plot(fine * 1e3, values, color=colour, linewidth=1.3)
        panel.set_ylabel(f"{name} (MN/m)", color=colour)
        panel.tick_params(axis="y", colors=colour)
        panel.set_ylim(*_with_margin(values))
        panel.ticklabel_format(axis="y", useOffset=False)
    across.spines["right"].set_visible(True)
    axes.set_title("Quasi-static stiffness: kyy along the load, kxx across it")
    axes.tick_params(labelbottom=False)
    faint_grid(axes)


def _with_margin(values: Array) -> tuple[float, float]:
    """Limits of an axis about `values`, wide enough that what hardly changes looks like that."""
    low, high = float(values.min()), float(values.max())
    middle, span = (low + high) / 2.0, max(high - low, LEAST_STIFFNESS_SPAN * abs(high), 1e-9)
    return middle - 0.62 * span, middle + 0.62 * span


def draw_spectrogram(axes: Axes, portrait: Portrait) -> None:
    """Spectrogram of the close-up in dB below its maximum, kHz against ms, with the modes that move along y."""
    start, stop = portrait.window
    signal = (portrait.acceleration if portrait.clean is None else portrait.clean)[:, 1]
    time, frequency, power = spectrogram(signal, portrait.rate, start, stop)
    lines = vertical_modes(portrait)
    top = min(portrait.rate / 2.0, 1.3 * max(lines, default=portrait.rate / 2.0))
    draw_decibels(axes, time, frequency, power, span=DYNAMIC_RANGE_DB, top=top)
    axes.set(ylim=(0.0, top * 1e-3), ylabel="kHz")
    mark_frequencies(axes, (line for line in lines if line <= top))
    axes.set_xlabel("time (ms); dashed: modes along y at the middle of the close-up" if lines else "time (ms)")
    whose = portrait.recorded_words if portrait.clean is None else "clean"
    axes.set_title(f"Spectrogram, {whose}, {DYNAMIC_RANGE_DB:.0f} dB")


def vertical_modes(portrait: Portrait) -> list[float]:
    """Natural frequencies (Hz) of the modes along y at the middle of the close-up; empty where no load is carried."""
    rest = equilibrium(portrait.scene, np.array([sum(portrait.window) / 2.0]))
    if rest.outcome(0) is not StaticOutcome.LOADED:
        return []
    found = modes(portrait.scene.rig, symmetric_matrices(rest.stiffness[0]), symmetric_matrices(rest.damping[0]))
    return [float(frequency) for frequency in frequencies_along_y(found)]
