"""The sheet of a preview: the whole record on top, time on the left, place and frequency on the right."""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from datagen.counts import digits
from datagen.drawing.frequency_panels import (
    draw_background_spectrum,
    draw_envelope_spectrum,
    draw_spectrum,
    envelope_band,
)
from datagen.drawing.path_panels import draw_element_load, draw_path, shown_arcs
from datagen.drawing.portrait import Portrait
from datagen.drawing.style import BLUE, GREY, INK, VERMILLION, png_of
from datagen.drawing.time_panels import (
    draw_close_up,
    draw_part,
    draw_passes,
    draw_spectrogram,
    draw_stiffness,
    draw_trace,
)

if TYPE_CHECKING:
    from matplotlib.gridspec import SubplotSpec

WIDTH, HEIGHT, DPI = 13.0, 12.5, 120
# Characters of a line across the sheet.
CARE_CHARACTERS = 200


def sheet_png(portrait: Portrait) -> bytes:
    """The sheet of one record as the bytes of a PNG file."""
    return png_of(lambda: draw_sheet(portrait), DPI)


def draw_sheet(portrait: Portrait) -> Figure:
    """The figure of one record, all panels with units."""
    figure = Figure(figsize=(WIDTH, HEIGHT))
    whole = 1.75 if portrait.has_parts else 0.85
    outer = figure.add_gridspec(
        2, 1, height_ratios=(whole, 5.0), left=0.06, right=0.975, top=0.915, bottom=0.045, hspace=0.16
    )
    _draw_whole(figure, outer[0], portrait)
    columns = outer[1].subgridspec(1, 2, width_ratios=(1.0, 1.0), wspace=0.2)
    left = columns[0].subgridspec(3, 1, height_ratios=(1.55, 1.0, 1.35), hspace=0.22)
    closest = left[0].subgridspec(2, 1, height_ratios=(1.0, 0.17), hspace=0.03)
    close_up = figure.add_subplot(closest[0])
    draw_close_up(close_up, portrait)
    for place, draw in ((closest[1], draw_passes), (left[1], draw_stiffness), (left[2], draw_spectrogram)):
        draw(figure.add_subplot(place, sharex=close_up), portrait)
    close_up.set_xlim(portrait.window[0] * 1e3, portrait.window[1] * 1e3)
    right = columns[1].subgridspec(2, 1, height_ratios=(1.05, 1.3), hspace=0.22)
    alike = portrait.shown_pass is not None or portrait.shown_spall is None
    place_rows = right[0].subgridspec(2, 1, hspace=0.3 if alike else 0.5)
    path = figure.add_subplot(place_rows[0])
    draw_path(path, portrait)
    path.tick_params(labelbottom=not alike)
    draw_element_load(figure.add_subplot(place_rows[1], sharex=path if alike else None), portrait)
    path.set_xlim(*_ends(portrait))
    frequency_rows = right[1].subgridspec(2, 1, hspace=0.62)
    band = envelope_band(portrait)
    spectrum = figure.add_subplot(frequency_rows[0])
    draw_spectrum(spectrum, portrait.acceleration[:, 1], portrait.rate, band)
    if portrait.has_parts and portrait.background is not None:
        draw_background_spectrum(spectrum, portrait.background[:, 1], portrait.rate)
    draw_envelope_spectrum(figure.add_subplot(frequency_rows[1]), portrait)
    figure.text(0.06, 0.975, heading(portrait), fontsize=13, fontweight="bold", color=INK)
    figure.text(0.06, 0.954, summary(portrait), fontsize=9, color=GREY)
    figure.text(0.06, 0.938, care(portrait), fontsize=8, color=VERMILLION)
    return figure


def _draw_whole(figure: Figure, place: SubplotSpec, portrait: Portrait) -> None:
    """Clean signal, background and sum, one below the other; the sum alone where the parts are not known."""
    clean, background = portrait.undisturbed, portrait.background
    if not portrait.has_parts or clean is None or background is None:
        draw_trace(figure.add_subplot(place), portrait)
        return
    strips = place.subgridspec(3, 1, hspace=0.5)
    layers = str(portrait.labels.get("background_layers", "")) or "background"
    parts = (
        (clean, BLUE, "Clean acceleration at the sensor, y axis"),
        (background, VERMILLION, f"Background ({layers.replace('_', ' ')})"),
        (portrait.acceleration, INK, "Sum, as recorded (close-up marked)"),
    )
    for row, (signal, colour, title) in enumerate(parts):
        axes = figure.add_subplot(strips[row])
        draw_part(axes, portrait, signal, colour, title)
        axes.tick_params(labelbottom=row == 2)
    axes.set_xlabel("time (s)", labelpad=1)


def _ends(portrait: Portrait) -> tuple[float, float]:
    arcs = shown_arcs(portrait.shown_spall)
    return math.degrees(arcs[0]), math.degrees(arcs[-1])


def heading(portrait: Portrait) -> str:
    """One line: which record, its condition and where."""
    labels = portrait.labels
    count, race = len(portrait.scene.spalls), f"{labels['location']} race"
    single = f"{labels['condition']} spall, {race}"
    several = f"{count} spalls, {race} (the largest: {labels['condition']})"
    state = several if count > 1 else single if count else "healthy"
    return f"{portrait.corpus}, record {labels['record']}: {state}"


def summary(portrait: Portrait) -> str:
    """One line: machine, speed, load, noise and how exactly it was simulated."""
    labels = portrait.labels
    parts = [
        f"{labels['rig']} rig, bearing {labels['bearing']}",
        f"{digits(labels['speed_rpm'], 4)} rpm",
        f"{digits(labels['load_n'], 4)} N",
        _noise(portrait),
        f"{portrait.duration:.4g} s at {portrait.rate:.6g} Hz",
    ]
    if math.isfinite(labels["error_estimate"]):
        parts.append(f"estimated error {digits(labels['error_estimate'] * 100.0, 2)} %")
    return "  ·  ".join(parts)


def care(portrait: Portrait) -> str:
    """One line: why the record is to be read with care, shortened if that is long; empty if it need not be."""
    reasons = str(portrait.labels["validity"])
    told = textwrap.shorten(reasons, CARE_CHARACTERS, placeholder=" … (the label validity has all)")
    return f"Read with care: {told}" if told else ""


def _noise(portrait: Portrait) -> str:
    labels = portrait.labels
    if math.isfinite(labels["snr_db"]):
        return f"SNR {labels['snr_db']:.1f} dB"
    return "no signal" if labels["background_layers"] else "no background"
