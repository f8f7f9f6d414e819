"""Question 3: what slip of the cage does to the harmonics of the ball-pass frequency, on both rigs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from datagen.drawing.style import BLUE, GREEN, INK, ORANGE, VERMILLION, faint_grid, with_panels
from datagen.paper.chapter import Chapter, Row, beside, only_ours
from datagen.paper.panels import heading, letter
from datagen.paper.scenes import ANALYSED, RATE, bpfo_hz, machine, scene, signal
from labels.band import Band
from labels.envelope import band_envelope, squared_envelope_spectrum
from labels.window import periodic_hann
from physics.arrays import Array
from physics.modes import coupled_resonator_frequency, rated_matrices
from physics.reference_scenes import gradual_line_spall
from physics.rms import rms

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


NAME = "question3"
RIGS = ("gearbox", "fan")
SLIPS = (0.0, 0.005, 0.01, 0.02)
COLOURS = dict(zip(SLIPS, (INK, BLUE, ORANGE, VERMILLION), strict=True))
SEEDS = 12
BAND_SHARE = 0.1
HARMONICS = 20
# Instants of the analysed time between which the predicted phase is compared.
INSTANTS = 400
TABLED = (1, 2, 5, 10, 20)
FIRST_JUDGED = 5
FADED = -10.0  # dB


@dataclass(frozen=True)
class Smearing:
    """Heights of the BPFO lines of a rig's squared envelope: (20,) RMS over the seeds for each slip, (m/s²)²."""

    rig: str
    heights: dict[float, Array]

    def drop(self, slip: float) -> Array:
        """Lines (20,) relative to those without slip, dB."""
        return np.asarray(20.0 * np.log10(self.heights[slip] / self.heights[0.0]))


def wide_band(rig: str) -> Band:
    """The band around the resonator as it rings on the outer ring, ± 10 %, wide enough for 20 harmonics, Hz."""
    mode = coupled_resonator_frequency(machine(rig), rated_matrices(machine(rig))[0])
    return mode * (1.0 - BAND_SHARE), mode * (1.0 + BAND_SHARE)


def lines_at(squared_envelope: Array, frequencies: Array) -> Array:
    """Amplitudes (N,) at exact frequencies (Hz) of a signal (T,) under a Hann window, the unit of the signal."""
    time = np.arange(squared_envelope.size) / RATE
    centred = (squared_envelope - squared_envelope.mean()) * periodic_hann(time.size)
    turning = (np.exp(-2j * np.pi * frequency * time) for frequency in frequencies)
    return np.array([2.0 * abs(np.dot(centred, turn)) / time.size for turn in turning])


def heights(rig: str, slip: float, seed: int) -> Array:
    """BPFO lines (20,) of the squared envelope around the resonator's mode, (m/s²)²."""
    found = signal(scene(rig, gradual_line_spall(rig), slip_seed=seed, slip=slip))
    envelope = band_envelope(found, RATE, wide_band(rig))
    return lines_at(envelope**2, bpfo_hz(rig) * np.arange(1.0, HARMONICS + 1.0))


def measure(rig: str, slips: tuple[float, ...] = SLIPS, seeds: int = SEEDS) -> Smearing:
    """The lines of one rig for every slip."""
    found = {}
    for slip in slips:
        each = [heights(rig, slip, seed) for seed in range(seeds if slip > 0.0 else 1)]
        found[slip] = np.sqrt(np.mean(np.square(each), axis=0))
    return Smearing(rig, found)


def predicted_drop(rig: str, slip: float) -> Array:
    """Drop (20,) in dB of the RMS line at k · BPFO that a phase wandering with the cage alone causes.

    The cage's angle strays by a variance 2 (σ ωc τ)² (t/τ − 1 + exp(−t/τ)) within t, τ one ball pass, σ the slip; the
    mean power of a line of phase k Nb φc under the window w is ∬ w w' exp(−(k Nb)² variance / 2) over its square.
    """
    bearing = machine(rig).bearing
    cage = bearing.cage_speed(machine(rig).rated_speed)
    correlation = bearing.spacing / cage
    time = (np.arange(INSTANTS) + 0.5) / INSTANTS * ANALYSED
    window = 1.0 - np.cos(2.0 * np.pi * time / ANALYSED)
    apart = np.abs(time[:, None] - time) / correlation
    variance = 2.0 * (slip * cage * correlation) ** 2 * (apart - 1.0 + np.exp(-apart))
    order = (bearing.balls * np.arange(1, HARMONICS + 1))[:, None, None]
    power = np.einsum("i,kij,j->k", window, np.exp(-(order**2) * variance / 2.0), window) / window.sum() ** 2
    return np.asarray(10.0 * np.log10(power))


def chapter() -> Chapter:
    """Question 3 with its table."""
    found = [measure(rig) for rig in RIGS]
    return Chapter(
        NAME,
        "Question 3: what does slip do to the harmonics?",
        "Line spalls with a gradual entry and a sharp exit (G1s, F1s: one ring a pass), 1.4 s, slip "
        "of 0, 0.5, 1 and 2 % standard deviation with one ball pass of correlation time, twelve "
        "seeds; squared envelope around the resonator's mode ± 10 %, amplitude at exactly k times "
        "the nominal BPFO, RMS over the seeds. The curve is what the wandering of the cage's phase "
        "alone predicts. " + answer(found),
        tuple(rows(found)),
        lambda: draw(found),
    )


def answer(found: list[Smearing]) -> str:
    """What came out, in words."""
    first = {(smearing.rig, slip): faded(smearing.drop(slip)) for smearing in found for slip in SLIPS[1:]}
    lines = "; ".join(
        f"{rig} rig: " + ", ".join(f"{slip:.1%} {_shown(first[rig, slip])}" for slip in SLIPS[1:]) for rig in RIGS
    )
    return f"Lines that slip takes down by 10 dB or more: {lines}."


def _shown(harmonic: float) -> str:
    return f"from harmonic {harmonic:.0f} on" if math.isfinite(harmonic) else f"none of {HARMONICS}"


def faded(drop: Array) -> float:
    """Number of the first harmonic that lies 10 dB or more below its height without slip; NaN if none does."""
    low = np.flatnonzero(drop <= FADED)
    return float(low[0] + 1) if low.size else math.nan


def rows(found: list[Smearing]) -> list[Row]:
    """The table of question 3."""
    table = []
    for smearing in found:
        for slip in SLIPS[1:]:
            drop, predicted = smearing.drop(slip), predicted_drop(smearing.rig, slip)
            for k in TABLED:
                title = f"{smearing.rig} rig, slip {slip:.1%}, harmonic {k} over that without slip"
                height, comment = float(drop[k - 1]), f"predicted {predicted[k - 1]:.1f} dB"
                if k < FIRST_JUDGED:
                    table.append(only_ours(title, height, "dB", comment))
                else:
                    table.append(beside(NAME, "smearing", title, height, comment, agrees=height < 0.0, unit="dB"))
            away = rms(drop - predicted)
            table.append(only_ours(f"{smearing.rig} rig, slip {slip:.1%}, RMS of measured less predicted", away, "dB"))
    return table


def draw(found: list[Smearing]) -> Figure:
    """Drop against harmonic above, spectra with and without slip below; gearbox rig left, fan rig right."""
    figure, grid = with_panels(2, 2, figsize=(11.0, 7.4))
    for column, smearing in enumerate(found):
        _draw_drop(grid[0, column], smearing)
        letter(grid[0, column], "ab"[column], f"Lines over those without slip, {smearing.rig} rig")
        _draw_spectra(grid[1, column], smearing.rig)
        letter(grid[1, column], "cd"[column], f"One record each, {smearing.rig} rig")
    grid[0, 0].set_ylabel("dB")
    grid[1, 0].set_ylabel("squared envelope ((m/s²)²)")
    grid[0, 0].legend(loc="lower left")
    grid[1, 0].legend(loc="upper right")
    heading(
        figure,
        "Question 3: what slip does to the harmonics",
        "line spalls G1s and F1s, squared envelope around the resonator's mode, 1.4 s; dots: simulated, RMS of "
        "twelve seeds; curves: wandering phase alone",
    )
    figure.subplots_adjust(left=0.07, right=0.985, top=0.885, bottom=0.075, hspace=0.33, wspace=0.12)
    return figure


def _draw_drop(axes: Axes, smearing: Smearing) -> None:
    number = np.arange(1, HARMONICS + 1)
    for slip in SLIPS[1:]:
        colour = COLOURS[slip]
        axes.plot(number, predicted_drop(smearing.rig, slip), color=colour, linewidth=1.1)
        axes.plot(number, smearing.drop(slip), "o", color=colour, markersize=4, label=f"slip {slip:.1%}")
    axes.axhline(FADED, color=GREEN, linewidth=0.8, linestyle=(0, (4, 3)))
    axes.set(xlim=(0.0, HARMONICS + 0.5), xticks=np.arange(2, HARMONICS + 1, 2), xlabel="harmonic of the BPFO")
    axes.set_ylim(-20.0, 2.0)
    faint_grid(axes)


def _draw_spectra(axes: Axes, rig: str) -> None:
    top = 10.6 * bpfo_hz(rig)
    for slip, colour, name in ((0.0, INK, "no slip"), (0.01, ORANGE, "1 % slip")):
        found = signal(scene(rig, gradual_line_spall(rig), slip_seed=0, slip=slip))
        envelope = band_envelope(found, RATE, wide_band(rig))
        frequency, amplitude = squared_envelope_spectrum(envelope, RATE)
        shown = (frequency > 0.0) & (frequency < top)
        axes.plot(frequency[shown], amplitude[shown], color=colour, linewidth=0.9, label=name)
    axes.set(xlim=(0.0, top), xlabel="frequency (Hz)")
    axes.set_ylim(bottom=0.0)
    faint_grid(axes)
