"""Evidence of a family of lines (a fundamental, its harmonics, its sidebands) in spectra over their noise floor.

Evidence is the log likelihood ratio, in nats, of lines against exponential noise: for the mean r > 1 of a components it
is a (r − 1 − ln r), so it means the same for records of any length and for lines of any width. What a search over n
places would find in noise alone, about ln n, is taken off.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce

import numpy as np

from labels.features.lines import Lines
from physics.arrays import Array

HARMONICS = 4
# Nats that noise gives one line in 500.
STANDS_OUT = 4.0
# Nats beyond which a line counts with its logarithm, so that a lone tone (mains) does not decide alone.
KNEE = 12.0
# Harmonics of a fundamental beside which sidebands are looked for.
SIDEBAND_CARRIERS = 2
# Half the width of a sideband, in shaft orders.
SIDEBAND_HALF_WIDTH = 0.02
# Widths of the first harmonic in shaft orders; those of harmonic k are k times as wide, since slip smears so.
WIDTHS = (0.0, 0.02, 0.06)


def evidence(ratio: Array, components: Array | float) -> Array:
    """Log likelihood ratio, nats, of a mean excess `ratio` (any shape) over that many `components`; 0 where the ratio
    is 1 or less."""
    safe = np.maximum(ratio, 1.0)
    return np.asarray(components * (safe - 1.0 - np.log(safe)))


def harmonic_evidence(lines: Lines, fundamentals: Array, shaft_hz: float, width: float, harmonics: int) -> Array:
    """Evidence (H, B, N), nats, of harmonics 1 to H of the `fundamentals` (N,), Hz, in B bands, at one of WIDTHS."""
    order = np.arange(1.0, harmonics + 1.0)
    half = np.maximum(0.5 * order * width * shaft_hz, lines.narrowest)
    return evidence(lines.means(order[:, None] * fundamentals, half), lines.components(half)[:, None, None])


def tempered(nats: Array) -> Array:
    """Evidence of single lines (any shape), nats, of which what exceeds KNEE counts by its logarithm."""
    return np.asarray(KNEE * np.log1p(nats / KNEE))


def standing(nats: Array) -> Array:
    """How many lines stand out, (N,) in multiples of STANDS_OUT, of `nats` (H, N): none counts more than once."""
    return np.asarray(np.minimum(nats, STANDS_OUT).sum(axis=0))


def most_standing(stands: Array, height: Array) -> int:
    """Which of N places has the most lines that stand out, by what `standing` (N,) gives; of places that differ by less
    than a line the one of the largest `height` (N,), as strong lines stand out in some components beside their middle
    too."""
    return int(np.where(stands > stands.max() - STANDS_OUT, height, 0.0).argmax())


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
        grid = fundamentals(centre, tolerance, max(lines.step, width * shaft_hz), harmonics)
        parts = harmonic_evidence(lines, grid, shaft_hz, width, harmonics)
        places = max(1.0, 2.0 * tolerance * centre * harmonics / max(lines.step, width * shaft_hz))
        doubt = np.log(places) + 0.5 * ((grid / centre - 1.0) / prior) ** 2
        total = parts.sum(axis=0) - doubt
        return _at(total, parts, grid)

    return reduce(_stronger, map(at_width, WIDTHS))


def fundamentals(
    centre: float, tolerance: float, width: float, harmonics: int, *, fewest: int = 5, most: int = 400
) -> Array:
    """The fundamentals (G,) to try within `tolerance` (a share) of `centre` (Hz), of which the highest of so many
    `harmonics` lie `width` (Hz) apart; no fewer and no more than said."""
    count = int(np.ceil(2.0 * tolerance * centre * harmonics / width)) + 1
    return centre * np.linspace(1.0 - tolerance, 1.0 + tolerance, max(fewest, min(count, most)))


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
    """Evidence (B,), nats, of the sidebands `spacing` (Hz) beside the first harmonics of each band's own `fundamental`
    (B,), Hz."""
    places = [k * fundamental + sign * spacing for k in range(1, SIDEBAND_CARRIERS + 1) for sign in (-1.0, 1.0)]
    half = np.full(len(places), max(SIDEBAND_HALF_WIDTH * shaft_hz, lines.narrowest))
    bands = np.arange(fundamental.size)
    ratio = lines.means(np.array(places), half)[:, bands, bands]
    return np.asarray(evidence(ratio, lines.components(half)[:, None]).sum(axis=0))
