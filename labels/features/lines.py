"""Spectra over their noise floor, read between their components."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physics.arrays import Array
from physics.compiled import njit_inline, njit_lean

# Noise bandwidth of a Hann window, components: fewer do not tell a line from noise, nor one line from another.
HANN_BINS = 1.5


@dataclass(frozen=True)
class Lines:
    """Spectra over their floor, ready to be read between components: cumulated excess (B, F + 1), `step` apart."""

    cumulated: Array
    step: float

    @property
    def narrowest(self) -> float:
        """Half the width, in the unit of `step`, over which a mean is taken at least."""
        return 0.5 * HANN_BINS * self.step

    def components(self, half_widths: Array) -> Array:
        """How many independent components (H,), 1 or more, lie within ± `half_widths` (H,), in the unit of `step`."""
        return np.maximum(2.0 * half_widths / self.step / HANN_BINS, 1.0)

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
    """Lines of spectra over their floor, `excess` (B, F), whose components lie `step` (Hz) apart."""
    zero = np.zeros((*excess.shape[:-1], 1))
    return Lines(np.concatenate([zero, np.cumsum(excess, axis=-1)], axis=-1), step)
