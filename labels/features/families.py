"""Evidence of a family of lines (a fundamental, its harmonics, its sidebands) in spectra over their noise floor.

Evidence is the log likelihood ratio, in nats, of lines against exponential noise: for the mean r > 1 of a components it
is a (r − 1 − ln r), so it means the same for records of any length and for lines of any width. What a search over n
places would find in noise alone, about ln n, is taken off.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.features.kinematics import Kinematics
from physics.arrays import Array
from physics.compiled import njit_inline, njit_lean

HARMONICS = 4
# Nats that noise gives one line in 500.
STANDS_OUT = 4.0
# Nats beyond which a line counts with its logarithm, so that a lone tone (mains) does not decide alone.
KNEE = 12.0
# Harmonics of a fundamental beside which sidebands are looked for.
SIDEBAND_CARRIERS = 2
# Widths of the first harmonic in shaft orders; those of harmonic k are k times as wide, since slip smears so.
WIDTHS = (0.0, 0.02, 0.06)
HANN_BINS = 1.5
MAINS = (50.0, 60.0)
# Share by which mains (0.4 % in an interconnected grid, EN 50160) and a stated rate may be off together, and the most
# (Hz) that is allowed for it: high multiples are weak, and their margins would cover the axis.
MAINS_SPREAD, MAINS_REACH = 0.006, 0.8
# The share that is allowed for at every multiple.
STEADY_MAINS = 0.001
COARSEST_STEP = 1.3
# Components so near (in orders) to a multiple of the shaft speed are not counted for a defect family.
SHAFT_MARGIN = 0.025
# The most orders around each multiple in which components are left out: more would take a large part of the axis.
WIDEST_MARGIN = 0.12


@dataclass(frozen=True)
class Lines:
    """Spectra over their floor, ready to be read between components: cumulated excess (B, F + 1), `step` apart."""

    cumulated: Array
    step: float

    def means(self, centres: Array, half_widths: Array) -> Array:
        """Mean excess (H, B, N) over `centres` (H, N) ± `half_widths` (H,), in the unit of `step`; 0 beyond the end."""
        found = np.empty((len(centres), len(self.cumulated), centres.shape[1]))
        _read_means(self.cumulated, self.step, centres, half_widths, found)
        return found


@njit_lean
def _read_means(cumulated: Array, step: float, centres: Array, half_widths: Array, found: Array) -> None:
    """Fill `found` (H, B, N) as `Lines.means` says."""
    size = cumulated.shape[1]
    end = step * (size - 1.5)
    for k in range(centres.shape[0]):
        half = half_widths[k]
        scale = step / (2.0 * half)
        for n in range(centres.shape[1]):
            if not centres[k, n] + half <= end:  # what is no number lies nowhere
                found[k, :, n] = 0.0
                continue
            first, early = _place((centres[k, n] - half) / step, size)
            last, late = _place((centres[k, n] + half) / step, size)
            for band in range(cumulated.shape[0]):
                low = cumulated[band, first] * (1.0 - early) + cumulated[band, first + 1] * early
                high = cumulated[band, last] * (1.0 - late) + cumulated[band, last + 1] * late
                found[k, band, n] = (high - low) * scale


@njit_inline
def _place(component: float, size: int) -> tuple[int, float]:
    """Entry of `size` cumulated sums at or below a `component`, and how far beyond it lies towards the next.

    Component j covers (j − 1/2 … j + 1/2) steps; the cumulated sum at its left edge is entry j.
    """
    inside = min(max(component + 0.5, 0.0), size - 1.0)
    entry = min(int(inside), size - 2)
    return entry, inside - entry


def lines_in(excess: Array, step: float) -> Lines:
    """Lines of spectra over their floor (B, F)."""
    zero = np.zeros((*excess.shape[:-1], 1))
    return Lines(np.concatenate([zero, np.cumsum(excess, axis=-1)], axis=-1), step)


def without_shaft(excess: Array, step: float, shaft_hz: float) -> Array:
    """The spectra (B, F) with components near multiples of the shaft speed set to the floor, 1."""
    return np.where(shaft_components(excess.shape[-1], step, shaft_hz), 1.0, excess)


def shaft_components(count: int, step: float, shaft_hz: float) -> NDArray[np.bool_]:
    """Which of `count` components, `step` (Hz) apart from 0, count as the shaft's.

    None in a record of so few turns that the margin would cover a large part of the axis.
    """
    margin = multiple_margin(step, shaft_hz)
    if margin > WIDEST_MARGIN * shaft_hz:
        return np.zeros(count, dtype=bool)
    return near_multiples(count, step, shaft_hz, margin)


def multiple_margin(step: float, shaft_hz: float) -> float:
    """How near (Hz) to a multiple of a rotating part's rate a component of the envelope counts as one."""
    return max(SHAFT_MARGIN * shaft_hz, 1.01 * step)


def near_multiples(count: int, step: float, rate: float, margin: float) -> NDArray[np.bool_]:
    """Which of `count` components, `step` (Hz) apart from 0, lie within `margin` (Hz) of a multiple of `rate` (Hz)."""
    order = np.arange(count) * step / rate
    return np.asarray((np.abs(order - np.round(order)) * rate <= margin) & (order > 0.5))


def mains_components(count: int, step: float) -> NDArray[np.bool_]:
    """Which of `count` components, `step` (Hz) apart from 0, count as mains of 50 or 60 Hz: none if too far apart.

    Motors and their supplies modulate at twice the mains frequency, often near a ball-pass frequency.
    """
    if step > COARSEST_STEP:
        return np.zeros(count, dtype=bool)
    return _taken_for_mains(np.arange(count) * step, step)


def races_in_mains(kinematics: Kinematics, step: float) -> tuple[str, ...]:
    """The races whose ball pass frequency counts as mains in a spectrum of components `step` (Hz) apart: with all its
    harmonics it is left out, and a fault of that race is hardly seen."""
    if step > COARSEST_STEP:
        return ()
    orders = {"outer": kinematics.bpfo, "inner": kinematics.bpfi}
    hidden = _taken_for_mains(np.array([*orders.values()], dtype=np.float64) * kinematics.shaft_hz, step)
    return tuple(race for race, is_hidden in zip(orders, hidden, strict=True) if is_hidden)


def _taken_for_mains(frequency: NDArray[Any], step: float) -> NDArray[np.bool_]:
    """Which frequencies (F,), Hz, count as mains in a spectrum of components `step` (Hz) apart."""
    margin = np.maximum(np.minimum(MAINS_SPREAD * frequency, MAINS_REACH), STEADY_MAINS * frequency)
    return near_mains(frequency, 1.01 * step + margin)


def near_mains(frequency: NDArray[Any], margin: NDArray[Any]) -> NDArray[np.bool_]:
    """True where a frequency (F,) lies within its `margin` (F,), both in Hz, of a multiple of 50 or 60 Hz."""
    near = np.zeros(frequency.size, dtype=bool)
    for mains in MAINS:
        near |= np.abs(frequency - mains * np.maximum(np.round(frequency / mains), 1.0)) <= margin
    return near


def evidence(ratio: Array, components: Array | float) -> Array:
    """Log likelihood ratio, nats, of a mean excess `ratio` over that many `components`; 0 where it is not above 1."""
    safe = np.maximum(ratio, 1.0)
    return np.asarray(components * (safe - 1.0 - np.log(safe)))


def harmonic_evidence(lines: Lines, fundamentals: Array, shaft_hz: float, width: float, harmonics: int) -> Array:
    """Evidence (H, B, N) of each harmonic of N `fundamentals` (Hz) at one of WIDTHS."""
    order = np.arange(1.0, harmonics + 1.0)
    half = np.maximum(0.5 * order * width * shaft_hz, 0.75 * lines.step)
    components = np.maximum(2.0 * half / lines.step / HANN_BINS, 1.0)
    return evidence(lines.means(order[:, None] * fundamentals, half), components[:, None, None])


def tempered(nats: Array) -> Array:
    """Evidence of single lines, those far above KNEE by their logarithm."""
    return np.asarray(KNEE * np.log1p(nats / KNEE))


@dataclass(frozen=True)
class Family:
    """The strongest family with a fundamental in a window, band by band.

    `evidence` (B,) in nats over all harmonics, `parts` (B, H) of each of them, `fundamental` (B,) in Hz.
    """

    evidence: Array
    parts: Array
    fundamental: Array


def find_family(
    lines: Lines, centre: float, tolerance: float, shaft_hz: float, prior: float = np.inf, harmonics: int = HARMONICS
) -> Family:
    """The strongest family whose fundamental lies within `tolerance` (a share) of `centre` (Hz), for each band.

    `prior` is the standard deviation (a share) of a normal prior of the fundamental around the centre.
    """

    def at_width(width: float) -> Family:
        grid = _grid(centre, tolerance, max(lines.step, width * shaft_hz), harmonics)
        parts = harmonic_evidence(lines, grid, shaft_hz, width, harmonics)
        places = max(1.0, 2.0 * tolerance * centre * harmonics / max(lines.step, width * shaft_hz))
        doubt = np.log(places) + 0.5 * ((grid / centre - 1.0) / prior) ** 2
        total = parts.sum(axis=0) - doubt
        return _at(total, parts, grid)

    return reduce(_stronger, map(at_width, WIDTHS))


def _grid(centre: float, tolerance: float, width: float, harmonics: int) -> Array:
    count = int(np.ceil(2.0 * tolerance * centre * harmonics / width)) + 1
    return centre * np.linspace(1.0 - tolerance, 1.0 + tolerance, max(5, min(count, 400)))


def _at(total: Array, parts: Array, grid: Array) -> Family:
    place = total.argmax(axis=-1)
    bands = np.arange(total.shape[0])
    return Family(np.maximum(total[bands, place], 0.0), parts[:, bands, place].T, grid[place])


def _stronger(old: Family, new: Family) -> Family:
    wins = new.evidence > old.evidence
    return Family(
        np.where(wins, new.evidence, old.evidence),
        np.where(wins[:, None], new.parts, old.parts),
        np.where(wins, new.fundamental, old.fundamental),
    )


def sideband_evidence(lines: Lines, fundamental: Array, spacing: float, shaft_hz: float) -> Array:
    """Evidence (B,) of the first sidebands, `spacing` (Hz) apart from the first harmonics of one fundamental a band."""
    half = max(0.02 * shaft_hz, 0.75 * lines.step)
    components = max(2.0 * half / lines.step / HANN_BINS, 1.0)
    places = [k * fundamental + sign * spacing for k in range(1, SIDEBAND_CARRIERS + 1) for sign in (-1.0, 1.0)]
    bands = np.arange(fundamental.size)
    ratio = lines.means(np.array(places), np.full(len(places), half))[:, bands, bands]
    return np.asarray(evidence(ratio, components).sum(axis=0))
