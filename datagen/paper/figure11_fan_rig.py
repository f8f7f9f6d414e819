"""Figure 11: the fan rig's line spall in time, time and frequency, in the demodulation band and in the envelope."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.drawing.decibel_panel import draw_decibels, frequencies_along_y, mark_frequencies
from datagen.drawing.style import GREY, INK, LINE, PURPLE, faint_grid, with_panels
from datagen.drawing.time_panels import shade_passes
from datagen.paper.chapter import Chapter, Row, beside, only_ours
from datagen.paper.panels import cursor, heading, letter, power_decibel
from datagen.paper.scenes import ANALYSED, LEAD, RATE, SHOWN_SEED, bpfo_hz, machine, scene, shaft_hz
from labels.density import power_density
from labels.envelope import band_envelope, squared_envelope_spectrum
from labels.spectrogram import spectrogram
from labels.truth import PassTable, ball_passes
from physics.arrays import Array
from physics.catalog.claims import resonator_alone_hz, resonator_damping_ratio
from physics.modes import modes, rated_matrices
from physics.reference_scenes import gap_line_spall, gradual_line_spall, line_spall
from physics.request import FixedSteps
from physics.simulate import simulate
from physics.spall import Spall

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


NAME = "figure11"
PAPER_BAND = (9200.0, 10200.0)
LOW_BAND, HIGH_BAND = (1.0, 3000.0), (8500.0, 11300.0)
SPALL_LENGTH = 1.2e-3
PASSES_SHOWN = 2.0
HARMONICS = 8
TOP_HZ = 12500.0
DYNAMIC_RANGE_DB = 60.0
ENVELOPE_TOP = 700.0
HARDLY, CLEARLY = 0.15, 0.3


@dataclass(frozen=True)
class Recording:
    """Acceleration along y (T,) of the fan rig over 1.5 s, m/s², and its complete ball passes after the start."""

    acceleration: Array
    passes: PassTable
    complete: NDArray[np.int64]

    @property
    def analysed(self) -> Array:
        """The last 1.4 s."""
        return self.acceleration[-round(ANALYSED * RATE) :]

    def entry_over_exit(self, band: tuple[float, float]) -> float:
        """Mean peak of the envelope in a band (Hz) from entry to mid-spall over the mean peak around exit."""
        early, late = self.peaks(band)
        return early / late

    def peaks(self, band: tuple[float, float]) -> tuple[float, float]:
        """Mean peaks of the envelope in a band (Hz): from entry to mid-spall, and around exit, m/s²."""
        envelope = band_envelope(self.acceleration, RATE, band)
        entry, leave = self.passes.entry_time[self.complete], self.passes.exit_time[self.complete]
        length = leave - entry
        early = [_peak(envelope, a, b) for a, b in zip(entry, entry + 0.5 * length, strict=True)]
        late = [_peak(envelope, a, b) for a, b in zip(leave - 0.15 * length, leave + 0.5 * length, strict=True)]
        return float(np.mean(early)), float(np.mean(late))

    def released_share(self) -> float:
        """Time from release to regain of contact over that from entry to exit, mean over the passes."""
        k = self.complete
        released = self.passes.regain_time[k] - self.passes.release_time[k]
        return float(np.nanmean(released / (self.passes.exit_time[k] - self.passes.entry_time[k])))


def _peak(envelope: Array, start: float, stop: float) -> float:
    return float(envelope[math.ceil(start * RATE) : int(stop * RATE) + 1].max())


def recording(spall: Spall) -> Recording:
    """The fan rig at 800 rpm and 100 N with 1 % slip."""
    of = scene("fan", spall, slip_seed=SHOWN_SEED)
    trace = simulate(of, RATE, FixedSteps(1))
    passes = ball_passes(of, trace.changes, of.duration)
    complete = np.flatnonzero(passes.complete & (passes.entry_time > LEAD))
    return Recording(trace.acceleration[:, 1], passes, complete)


def vertical_modes() -> Array:
    """Natural frequencies (3,) of the healthy fan rig's modes along y at its rated load, cage angle 0, Hz."""
    return frequencies_along_y(modes(machine("fan"), *rated_matrices(machine("fan"))))


def chapter() -> Chapter:
    """Figure 11 with its table."""
    gradual = recording(gradual_line_spall("fan"))
    return Chapter(
        NAME,
        "Figure 11: response of the fan rig (called Figure 10 in section 6.2)",
        "800 rpm, 100 N, clearance 3 µm, line spall of 2.6° on the outer race, row 1, 12 µm deep at the ball's "
        "centre, gradual entry (0.9 of the length) and sharp exit (0.1): reference scene F1s. Slip of 1 %, 1.4 s at "
        "65 536 Hz. Demodulated in the paper's 9.2 to 10.2 kHz, which holds the simulated mode. The table also has "
        "equal tapers (F1) and a deep gap on the path of the ball's centre (F1p).",
        tuple(rows(gradual, recording(line_spall("fan")), recording(gap_line_spall("fan")))),
        lambda: draw(gradual),
    )


def rows(gradual: Recording, equal: Recording, gap: Recording) -> list[Row]:
    """The table of Figure 11."""
    rig, along_y = machine("fan"), vertical_modes() * 1e-3
    alone, ratio = resonator_alone_hz(rig), resonator_damping_ratio(rig)
    angle = math.degrees(SPALL_LENGTH / rig.bearing.raceway_radius("outer"))
    return [
        beside(NAME, "bpfo", "BPFO", bpfo_hz("fan")),
        beside(NAME, "spall_angle", "arc of a spall of 1.2 mm on the outer race", angle),
        beside(NAME, "lower_mode", "lower mode along y", along_y[0]),
        beside(NAME, "upper_mode", "upper mode along y", along_y[1], "the paper cuts off the last digit"),
        beside(NAME, "resonator_alone", "resonator alone", alone * 1e-3),
        beside(NAME, "resonance_mode", "resonator on the outer ring", along_y[2], "the paper gives that of it alone"),
        beside(NAME, "damping", "damping of the resonator alone", ratio * 100.0),
        *_event_rows(gradual, equal),
        *_share_rows(gradual, equal, gap),
    ]


def _event_rows(gradual: Recording, equal: Recording) -> list[Row]:
    high, low = gradual.entry_over_exit(HIGH_BAND), gradual.entry_over_exit(LOW_BAND)
    low_exit, high_exit = gradual.peaks(LOW_BAND)[1], gradual.peaks(HIGH_BAND)[1]
    bands = "envelopes in 0 to 3 and in 8.5 to 11.3 kHz"
    return [
        beside(
            NAME,
            "entry_is_low",
            "entry over exit, high band, gradual entry",
            high,
            bands,
            agrees=high < HARDLY,
            unit="1",
        ),
        beside(
            NAME, "entry_is_low", "entry over exit, low band, gradual entry", low, bands, agrees=low > CLEARLY, unit="1"
        ),
        beside(
            NAME,
            "exit_is_both",
            "exit, low over high band",
            low_exit / high_exit,
            agrees=low_exit / high_exit > HARDLY,
            unit="1",
        ),
        beside(
            NAME, "exit_is_higher", "exit over entry, high band, gradual entry", 1.0 / high, agrees=high < 1.0, unit="1"
        ),
        only_ours(
            "entry over exit, high band, equal tapers",
            equal.entry_over_exit(HIGH_BAND),
            "1",
            "equal tapers do not show what the paper reports",
        ),
    ]


def _share_rows(gradual: Recording, equal: Recording, gap: Recording) -> list[Row]:
    named = {"gradual entry (F1s)": gradual, "equal tapers (F1)": equal, "path of the ball's centre (F1p)": gap}
    return [
        beside(
            NAME,
            "half_size",
            f"release to regain over the length, {name}",
            recording.released_share(),
            "depends on load and profile; half is one case",
            agrees=abs(recording.released_share() - 0.5) < 0.1,
            unit="1",
        )
        for name, recording in named.items()
    ]


def draw(found: Recording) -> Figure:
    """Trace above spectrogram on the left, spectrum in the band above envelope spectrum on the right."""
    figure, grid = with_panels(2, 2, figsize=(11.0, 7.4), gridspec_kw={"width_ratios": (1.25, 1.0)})
    first = found.complete[found.complete.size // 2]
    start = float(found.passes.entry_time[first]) - 2.0e-3
    stop = start + PASSES_SHOWN / bpfo_hz("fan")
    _draw_trace(grid[0, 0], found, start, stop)
    _draw_spectrogram(grid[1, 0], found, start, stop)
    _draw_band(grid[0, 1], found)
    _draw_envelope(grid[1, 1], found)
    titles = ("Acceleration along y", "The paper's band", "Its spectrogram", "Squared envelope spectrum")
    for name, axes, title in zip("abcd", grid.ravel(), titles, strict=True):
        letter(axes, name, title)
    heading(
        figure,
        "The fan rig's response to a line spall (counterpart of Figure 11, modelled side)",
        "800 rpm, 100 N, clearance 3 µm, 1.2 mm (2.6°), gradual entry and sharp exit, 1 % slip; shaded: a ball in "
        "the spall",
    )
    figure.subplots_adjust(left=0.06, right=0.985, top=0.885, bottom=0.075, hspace=0.3, wspace=0.21)
    return figure


def _draw_trace(axes: Axes, found: Recording, start: float, stop: float) -> None:
    part = slice(int(start * RATE), int(stop * RATE) + 1)
    time = (np.arange(part.start, part.stop) / RATE - start) * 1e3
    axes.plot(time, found.acceleration[part], color=LINE, linewidth=0.7)
    shade_passes(axes, found.passes, start)
    axes.set(xlim=(0.0, (stop - start) * 1e3), ylabel="m/s²", xlabel="time (ms)")
    faint_grid(axes)


def _draw_spectrogram(axes: Axes, found: Recording, start: float, stop: float) -> None:
    time, frequency, power = spectrogram(found.acceleration, RATE, start, stop)
    draw_decibels(axes, time - start, frequency, power, span=DYNAMIC_RANGE_DB, top=TOP_HZ)
    mark_frequencies(axes, vertical_modes())
    axes.set(
        xlim=(0.0, (stop - start) * 1e3),
        ylabel="kHz",
        xlabel=f"time (ms); dashed: modes along y; {DYNAMIC_RANGE_DB:.0f} dB",
    )


def _draw_band(axes: Axes, found: Recording) -> None:
    frequency, power = power_density(found.analysed, RATE, 1.0)
    inside = (frequency >= PAPER_BAND[0]) & (frequency <= PAPER_BAND[1])
    axes.plot(frequency[inside] * 1e-3, power_decibel(power[inside]), color=LINE, linewidth=0.6)
    mode = vertical_modes()[2] * 1e-3
    axes.axvline(mode, color=GREY, linewidth=0.9, linestyle=":")
    axes.annotate(
        f"mode {mode:.2f} kHz",
        (mode, 0.0),
        (4, 4),
        xycoords=("data", "axes fraction"),
        textcoords="offset points",
        fontsize=7.5,
        color=INK,
    )
    axes.set(xlim=(PAPER_BAND[0] * 1e-3, PAPER_BAND[1] * 1e-3), ylabel="dB re 1 (m/s²)²/Hz", xlabel="frequency (kHz)")
    faint_grid(axes)


def _draw_envelope(axes: Axes, found: Recording) -> None:
    frequency, amplitude = squared_envelope_spectrum(band_envelope(found.analysed, RATE, PAPER_BAND), RATE)
    shown = (frequency > 0.0) & (frequency < ENVELOPE_TOP)
    axes.plot(frequency[shown], amplitude[shown], color=LINE, linewidth=0.8)
    bpfo, shaft = bpfo_hz("fan"), shaft_hz("fan")
    top = 1.18 * float(amplitude[shown].max())
    for k in range(1, int(ENVELOPE_TOP / shaft) + 1):
        axes.plot([k * shaft] * 2, [0.0, 0.02 * top], color=PURPLE, linewidth=0.8)
    axes.plot([], [], "|", color=PURPLE, label=f"shaft {shaft:.2f} Hz and harmonics")
    targets = [k * bpfo for k in range(1, HARMONICS + 1)]
    cursor(axes, frequency, amplitude, targets, 2.0, ("o", INK, f"BPFO {bpfo:.2f} Hz and harmonics"))
    axes.set(xlim=(0.0, ENVELOPE_TOP), ylim=(0.0, top), xlabel="frequency (Hz)", ylabel="(m/s²)²")
    axes.legend(loc="upper right")
    faint_grid(axes)
