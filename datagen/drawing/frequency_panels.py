"""Panels against frequency: the acceleration spectrum with its band, the squared envelope spectrum with its cursors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.drawing.portrait import Portrait
from datagen.drawing.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, VERMILLION, faint_grid, outside_legend
from labels.envelope import squared_envelope_spectrum
from labels.spectrum import amplitude_spectrum
from physics.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes


HARMONICS = 6
CURSOR_TOLERANCE = 0.012
RESOLVED_BINS = 4.0  # from the middle of one line to the next, each as wide as its window
FEWEST_LINES = 2
DECADES = 4.5
LINE_IN_SIGHT = 1.2  # least end of an axis, in frequencies of its first line


def draw_spectrum(axes: Axes, signal: Array, rate: float, band: tuple[float, float], axis: str = "y") -> None:
    """Amplitude spectrum of an acceleration (T,), m/s² against kHz, with the band of its envelope (Hz)."""
    frequency, amplitude = amplitude_spectrum(signal, rate)
    limits = decades(amplitude[1:])
    axes.semilogy(frequency[1:] * 1e-3, above(amplitude[1:], limits), color=BLUE, linewidth=0.5)
    low, high = band
    axes.axvspan(low * 1e-3, high * 1e-3, color=ORANGE, alpha=0.3, linewidth=0, zorder=0)
    left = high > 0.75 * rate / 2.0 and low > 0.25 * rate / 2.0
    place = low if left else min(high, 0.75 * rate / 2.0)  # inside a band beside which there is no room
    axes.annotate(
        f"envelope band\n{low * 1e-3:.2f} to {high * 1e-3:.2f} kHz", (place * 1e-3, 1.0),
        (-3 if left else 3, -2), xycoords=("data", "axes fraction"), textcoords="offset points", va="top",
        ha="right" if left else "left", fontsize=7.5, color=INK,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.5},
    )  # fmt: skip
    axes.set(xlim=(0.0, rate / 2e3), ylim=limits, xlabel="frequency (kHz)", ylabel="m/s²")
    axes.set_title(f"Amplitude spectrum, {axis} axis")
    faint_grid(axes)


def draw_background_spectrum(axes: Axes, signal: Array, rate: float) -> None:
    """The spectrum of the background (T,), m/s², over that of the record."""
    frequency, amplitude = amplitude_spectrum(signal, rate)
    shown = above(amplitude[1:], axes.get_ylim())
    axes.semilogy(frequency[1:] * 1e-3, shown, color=VERMILLION, linewidth=0.4, alpha=0.7, label="background")
    outside_legend(axes)


def envelope_band(portrait: Portrait) -> tuple[float, float]:
    """Lower and upper edge of the record's envelope band, Hz."""
    low, high = portrait.labels["envelope_band"]
    return float(low), float(high)


def envelope_end(wanted: float, line: float, band: tuple[float, float], rate: float) -> float:
    """Where the axis of an envelope spectrum ends (Hz): at `wanted` or, if that is lower, at the width of the band.

    The frequencies of a squared envelope are differences of two within its band, so that nothing lies beyond; yet the
    place of the first `line` (Hz) stays on the axis, to show that it is empty.
    """
    low, high = band
    return min(wanted, max(high - low, LINE_IN_SIGHT * line), rate / 2.0)


def draw_envelope_spectrum(axes: Axes, portrait: Portrait) -> None:
    """Squared envelope spectrum, (m/s²)² against Hz and orders of the shaft, with cursors of the record's own kind."""
    frequency, amplitude = squared_envelope_spectrum(portrait.envelope, portrait.rate)
    known = portrait.frequencies
    main = known[portrait.defect_frequency]
    top = envelope_end((HARMONICS + 0.6) * main, main, envelope_band(portrait), portrait.rate)
    shown = (frequency > 0.0) & (frequency <= top)
    limits = decades(amplitude[shown])
    axes.semilogy(frequency[shown], above(amplitude[shown], limits), color=BLUE, linewidth=0.8)
    if np.count_nonzero(shown) < FEWEST_LINES:
        words = f"too short a record: its lines lie {frequency[1]:.3g} Hz apart"
        axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", va="center", color=GREY)
    _mark_families(axes, portrait, frequency, amplitude, (top, limits[0]))
    axes.set(
        xlim=(0.0, top),
        ylim=limits,
        xlabel="frequency (Hz; on top: orders of the shaft)",
        ylabel="(m/s²)²",
    )
    axes.set_title("Squared envelope spectrum", pad=18)
    faint_grid(axes)
    outside_legend(axes, lift=0.12)
    _orders_on_top(axes, known["shaft"])


def _mark_families(
    axes: Axes, portrait: Portrait, frequency: Array, amplitude: Array, reach: tuple[float, float]
) -> None:
    """Open marks on the lines of each family that lie on the panel: `reach` is its highest frequency and least height.

    The record's own family is in the legend even where none of its lines is found.
    """
    top, least = reach
    for number, (name, marker, colour, targets) in enumerate(cursors(portrait)):
        on_panel = [target for target in targets if target < top]
        heights = line_heights(frequency, amplitude, on_panel, portrait.frequencies["FTF"], peaks=number > 0)
        heights = [line for line in heights if line[1] > least]
        mark_lines(axes, heights, marker, colour, name if heights or number == 0 else None)


def mark_lines(axes: Axes, lines: list[tuple[float, float]], marker: str, colour: str, name: str | None) -> None:
    """An open mark on each of the `lines` (frequency, Hz, and height); `name` is their legend (None: no entry)."""
    axes.plot(
        [frequency for frequency, _ in lines], [height for _, height in lines], marker, color=colour, label=name,
        linestyle="", markersize=6, markerfacecolor="none", markeredgewidth=1.3, clip_on=False,
    )  # fmt: skip


def _orders_on_top(axes: Axes, shaft: float) -> None:
    """A second axis in orders of the shaft's frequency (Hz)."""

    def to_orders(hertz: Any) -> Any:
        return hertz / shaft

    def to_hertz(order: Any) -> Any:
        return order * shaft

    orders = axes.secondary_xaxis("top", functions=(to_orders, to_hertz))
    orders.tick_params(labelsize=7, colors=GREY, length=2, pad=1)


def cursors(portrait: Portrait) -> list[tuple[str, str, str, list[float]]]:
    """Name, marker, colour and frequencies (Hz) of each family of lines worth looking for in this record.

    The record's own family comes first. Lines that a record of its length cannot tell from their neighbours, or from
    the mean, are left out.
    """
    known, main = portrait.frequencies, portrait.defect_frequency
    harmonics = [k * known[main] for k in range(1, HARMONICS + 1)]
    by = "shaft" if main == "BPFI" else "FTF"
    sidebands = [f + s * known[by] for f in harmonics[:3] for s in (-1.0, 1.0)]
    families = [(f"{main} {known[main]:.4g} Hz{_beyond(portrait)}", "o", VERMILLION, harmonics)]
    if known[by] * portrait.duration >= RESOLVED_BINS:
        families.append((f"± {by} {known[by]:.3g} Hz", "D", GREEN, sidebands))
    if by != "shaft" and known["shaft"] * portrait.duration >= RESOLVED_BINS:
        families.append((f"shaft {known['shaft']:.3g} Hz", "s", PURPLE, [k * known["shaft"] for k in range(1, 4)]))
    return families


def _beyond(portrait: Portrait) -> str:
    """Why the frequency of the defect has no line, in brackets; nothing where it may have one."""
    main, (low, high) = portrait.frequencies[portrait.defect_frequency], envelope_band(portrait)
    if main >= portrait.rate / 2.0:
        return " (above half the rate)"
    return " (beyond the band's width)" if main > high - low else ""


def line_heights(
    frequency: Array, amplitude: Array, targets: list[float], spacing: float, *, peaks: bool = False
) -> list[tuple[float, float]]:
    """Frequency (Hz) and height of the largest line near each of `targets` (Hz) that the spectrum reaches.

    Other lines lie `spacing` (Hz) apart. What the record is too short to tell from its mean is left out, and with
    `peaks` also what stands out from neither neighbour, as on the flank of a larger line.
    """
    found = []
    for target in targets:
        reach = max(min(CURSOR_TOLERANCE * target, spacing / 3.0), frequency[1])
        near = np.flatnonzero((np.abs(frequency - target) <= reach) & (frequency > 0.0))
        if near.size and target > 0.0:
            best = int(near[int(np.argmax(amplitude[near]))])
            if not peaks or _is_peak(amplitude, best):
                found.append((float(frequency[best]), float(amplitude[best])))
    return found


def _is_peak(amplitude: Array, place: int) -> bool:
    beside = [amplitude[k] for k in (place - 1, place + 1) if 0 <= k < amplitude.size]
    return all(amplitude[place] > other for other in beside)


def above(amplitude: Array, limits: tuple[float, float]) -> Array:
    """Amplitudes for a logarithmic axis with these limits: what is zero lies below the axis."""
    return np.maximum(amplitude, 0.1 * limits[0])


def decades(amplitude: Array) -> tuple[float, float]:
    """Limits of a logarithmic axis that show the amplitudes without the deepest gaps between lines."""
    top = float(amplitude.max()) if amplitude.size and amplitude.max() > 0.0 else 1.0
    bottom = max(float(np.quantile(amplitude, 0.02)) / 2.0, top * 10.0**-DECADES) if amplitude.size else 1e-3 * top
    return bottom, 2.0 * top
