"""Figure 9: squared envelope spectra of the gearbox rig in the paper's band and around the simulated resonance."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from datagen.drawing.style import INK, faint_grid, with_panels
from datagen.paper.chapter import Chapter, Row, beside, only_ours
from datagen.paper.panels import cursor, heading, legend_below, letter, spread
from datagen.paper.published import published_value
from datagen.paper.scenes import RATE, SEEDS, bpfo_hz, machine
from datagen.paper.simulated import CONDITIONS, SAME_FOR_ALL, shown, simulated
from labels.band import Band
from labels.envelope import band_envelope, default_band, squared_envelope_spectrum
from labels.spectrum import line_amplitude
from physics.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

NAME = "figure9"
PAPER_BAND = (10200.0, 10400.0)
REACH = 1.5
TOP = 350.0
HARMONICS = 10


def envelope_line(acceleration: Array, band: Band = PAPER_BAND) -> float:
    """Height of the BPFO line of the squared envelope's spectrum in a band (Hz), (m/s²)²."""
    frequency, amplitude = squared_envelope_spectrum(band_envelope(acceleration, RATE, band), RATE)
    return line_amplitude(frequency, amplitude, bpfo_hz("gearbox"), REACH)


def pole_band() -> Band:
    """The band around the resonator as it rings on the outer ring, ± 5 %, Hz."""
    return default_band(machine("gearbox"), RATE)


def chapter(count: int = len(SEEDS)) -> Chapter:
    """Figure 9 with its table."""
    names = (*CONDITIONS, "gap")
    lines = {name: np.array([envelope_line(trace) for trace in simulated(name, count)]) for name in names}
    pole = {
        name: np.array([envelope_line(trace, pole_band()) for trace in simulated(name, count)]) for name in CONDITIONS
    }
    low, high = pole_band()
    return Chapter(
        NAME,
        "Figure 9: squared envelope spectra, gearbox rig",
        f"{SAME_FOR_ALL} Demodulated in the paper's 10.2 to 10.4 kHz and, because the simulated resonator rings at "
        f"{(low + high) / 2e3:.2f} kHz on its ring, in {low / 1e3:.2f} to {high / 1e3:.2f} kHz too. Spectra of the "
        "squared envelope, amplitudes in (m/s²)². The extracted text gives the paper's unit as mm²s⁻⁴ and two "
        "exponents without saying to which axis they belong, so only ratios are compared.",
        tuple(rows(lines, pole)),
        draw,
    )


def rows(lines: dict[str, Array], pole: dict[str, Array]) -> list[Row]:
    """The table of Figure 9 from the BPFO lines of each condition in the paper's band and around the pole."""
    density = 10.0 ** (published_value("figure10", "highest") / 10.0)
    most = 2.0 * density * (PAPER_BAND[1] - PAPER_BAND[0])
    end = f"{published_value(NAME, 'line_axis'):g}"
    unit = (
        f"Figure 10's axis bounds the mean squared envelope in that band by {most:.2g} (m/s²)², so {end} is no (m/s²)²"
    )
    top = {name: float(np.median(values)) for name, values in lines.items()}
    return [
        only_ours("BPFO line, line spall", top["line"], "(m/s²)²", f"axis of the paper to {end}; {unit}"),
        only_ours("BPFO line, line spall on the path of the ball's centre (G1p)", top["gap"], "(m/s²)²"),
        only_ours("BPFO line, extended", top["extended"], "(m/s²)²", _range(lines["extended"])),
        only_ours("BPFO line, extended G2r", top["reference"], "(m/s²)²", _range(lines["reference"])),
        only_ours("BPFO line, healthy", top["healthy"], "(m/s²)²", "nothing but rounding; no background is modelled"),
        *_ratio_rows("in 10.2 to 10.4 kHz", lines),
        *_ratio_rows("around the pole", pole, axes=False),
        beside(
            NAME,
            "extended_shows",
            "BPFO line, extended over healthy",
            top["extended"] / max(top["healthy"], 1e-300),
            agrees=top["extended"] > 1e3 * top["healthy"],
            unit="1",
        ),
    ]


def _range(values: Array) -> str:
    return f"median of {values.size}; {values.min():.2g} to {values.max():.2g}"


def _ratio_rows(where: str, lines: dict[str, Array], axes: bool = True) -> list[Row]:
    found = []
    for name, title in (("extended", "extended"), ("reference", "extended G2r")):
        ratio = lines["line"] / lines[name]
        middle = float(np.median(ratio))
        quantity = f"line over {title}, {where}"
        always = bool(ratio.min() > 1.0)
        found.append(
            beside(NAME, "line_is_higher", quantity, middle, spread(ratio), agrees=always or middle > 2.0, unit="1")
        )
        if axes:
            found.append(beside(NAME, "axes_ratio", quantity, middle, "the paper's is a ratio of the ends of two axes"))
    return found


def draw() -> Figure:
    """A row a condition; the paper's band on the left, the band around the pole on the right."""
    figure, grid = with_panels(len(CONDITIONS), 2, figsize=(10.0, 9.6), sharex=True)
    low, high = pole_band()
    titles = ("10.2 to 10.4 kHz", f"{low / 1e3:.2f} to {high / 1e3:.2f} kHz")
    for row, (name, (colour, title)) in enumerate(CONDITIONS.items()):
        for column, band in enumerate((PAPER_BAND, pole_band())):
            axes = grid[row, column]
            _draw_spectrum(axes, shown(name), band, colour)
            short = title.replace(" profile", "")
            letter(axes, "abcdefgh"[2 * row + column], f"{short[0].upper()}{short[1:]}" if column == 0 else titles[1])
        grid[row, 0].set_ylabel("(m/s²)²")
    for axes in grid[-1]:
        axes.set(xlabel="frequency (Hz)", xlim=(0.0, TOP), xticks=np.arange(0.0, TOP + 1.0, 35.0))
    heading(
        figure,
        "Squared envelope spectra (counterpart of Figure 9, modelled side)",
        f"gearbox rig, 1 % slip, 1.4 s; left: the paper's band, {titles[0]}; right: around the simulated pole, "
        f"{titles[1]}",
    )
    figure.subplots_adjust(left=0.075, right=0.985, top=0.91, bottom=0.09, hspace=0.42, wspace=0.16)
    legend_below(figure, [grid[0, 0]])
    return figure


def _draw_spectrum(axes: Axes, acceleration: Array, band: Band, colour: str) -> None:
    frequency, amplitude = squared_envelope_spectrum(band_envelope(acceleration, RATE, band), RATE)
    shown_part = (frequency > 0.0) & (frequency < TOP)
    axes.plot(frequency[shown_part], amplitude[shown_part], color=colour, linewidth=0.8)
    bpfo = bpfo_hz("gearbox")
    # A band holds no beats faster than it is wide.
    targets = [k * bpfo for k in range(1, HARMONICS + 1) if k * bpfo < band[1] - band[0]]
    cursor(axes, frequency, amplitude, targets, REACH, ("o", INK, f"BPFO {bpfo:.2f} Hz and harmonics"))
    axes.set_ylim(0.0, 1.15 * float(amplitude[shown_part].max()))
    axes.ticklabel_format(axis="y", scilimits=(-2, 2), useMathText=True)
    axes.yaxis.get_offset_text().set_position((1.0, 0.0))
    axes.yaxis.get_offset_text().set_horizontalalignment("right")
    faint_grid(axes)
