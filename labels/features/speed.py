"""The speed of the shaft, refined from the signal: shaft harmonics and the defect families' comb jointly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from labels.features.conditioning import FEWEST_BINS, Array, Conditioned, local_mean_power
from labels.features.envelopes import EnvelopeSpectra
from labels.features.families import Lines, find_family, harmonic_evidence, lines_in
from labels.features.kinematics import Kinematics

SPEED_TOLERANCE = 0.022
"""The share by which the shaft may turn faster or slower than stated."""
SHAFT_HARMONICS = 8
SPECTRUM_FLOOR_ORDERS = 3.0
"""Width, in orders of the shaft, of the blocks from which the floor under the lines of the vibration is taken."""
SLIP_SPREAD = 0.007
"""Standard deviation of the cage's speed about the one of pure rolling, as a share: slip and unknown contact angle."""
KNEE = 12.0
"""Nats beyond which a line counts with its logarithm, so that a lone tone (mains) does not set the speed."""
DECISIVE = 12.0


@dataclass(frozen=True)
class Speed:
    """Refined shaft speed in Hz and the evidence (nats) of shaft harmonics there."""

    shaft_hz: float
    evidence: float


def vibration_lines(record: Conditioned, shaft_hz: float, top_hz: float) -> tuple[Lines, Array]:
    """Lines of the raw spectrum, over the angle turned where the speed changes, over its local floor up to `top_hz`,
    and that excess (1, F)."""
    count = min(record.raw.size, int(top_hz / record.step) + 2)
    power = np.abs(record.slow(count)[None]) ** 2
    block = max(FEWEST_BINS, int(SPECTRUM_FLOOR_ORDERS * shaft_hz / record.step))
    floor = local_mean_power(power[:, 1:], min(block, max(2, count // 2)))
    excess = np.zeros_like(power)
    excess[:, 1:] = power[:, 1:] / np.maximum(floor, np.finfo(np.float64).tiny)
    return lines_in(excess, record.step), excess


def refine_speed(
    spectrum: Lines, envelopes: EnvelopeSpectra, known: Kinematics, tolerance: float = SPEED_TOLERANCE
) -> Speed:
    """The most likely shaft speed within the `tolerance` (a share) of the one given, 0 if that is exact.

    Counts shaft harmonics 1 to 8 of the vibration, 1 to 4 of the widest band's envelope, and how near a cage without
    slip comes to the strongest outer or inner family. Without evidence the speed given is kept.
    """
    step = spectrum.step
    count = int(np.ceil(2.0 * tolerance * known.shaft_hz * SHAFT_HARMONICS / (0.5 * step))) + 1
    places = max(45, min(count, 800)) // 2 * 2 + 1 if tolerance > 0.0 else 1
    factors = np.linspace(1.0 - tolerance, 1.0 + tolerance, places)
    speeds = known.shaft_hz * factors
    shaft = _tempered(harmonic_evidence(spectrum, speeds, known.shaft_hz, 0.0, SHAFT_HARMONICS)[:, 0])
    turning = lines_in(envelopes.excess[:1], envelopes.step)
    modulation = _tempered(harmonic_evidence(turning, speeds, known.shaft_hz, 0.0, 4)[:, 0])
    comb = shaft.sum(axis=0) + modulation.sum(axis=0)
    joint = comb + _families_term(envelopes, known, factors) - 0.5 * ((factors - 1.0) / 0.008) ** 2
    place = int(joint.argmax())
    return Speed(float(speeds[place]), float(comb[place]))


def _tempered(nats: Array) -> Array:
    return np.asarray(KNEE * np.log1p(nats / KNEE))


def _families_term(envelopes: EnvelopeSpectra, known: Kinematics, factors: Array) -> Array:
    """Log prior of the slip that each speed would ask of the strongest family, where there is a decisive one."""
    lines = lines_in(envelopes.excess, envelopes.step)
    best, term = DECISIVE, np.zeros(factors.size)
    for order in (known.bpfo, known.bpfi):
        family = find_family(lines, order * known.shaft_hz, 2.0 * SPEED_TOLERANCE, known.shaft_hz, 0.015, 3)
        band = int(family.evidence.argmax())
        if family.evidence[band] > best:
            best = float(family.evidence[band])
            observed = family.fundamental[band] / (order * known.shaft_hz)
            term = -0.5 * ((observed / factors - 1.0) / SLIP_SPREAD) ** 2
    return term
