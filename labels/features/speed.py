"""The speed of the shaft, refined from the signal: shaft harmonics and the defect families' comb jointly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from labels.features.conditioning import FEWEST_BINS, Conditioned, over_floor
from labels.features.envelopes import EnvelopeSpectra
from labels.features.families import (
    STANDS_OUT,
    find_family,
    harmonic_evidence,
    most_standing,
    standing,
    tempered,
)
from labels.features.kinematics import MEASURED_WITHIN, SLIP_SPREAD, Kinematics
from labels.features.lines import Lines, lines_in
from physics.arrays import Array, Flags

SHAFT_HARMONICS = 8
# Width, in orders of the shaft, of the blocks from which the floor under the lines of the vibration is taken.
SPECTRUM_FLOOR_ORDERS = 3.0
# Standard deviation of the shaft's speed about the one stated, over the most that it may be off.
PRIOR_SPREAD = 4.0 / 11.0
# Fewest and most speeds that are tried.
PLACES = (45, 800)
# How far apart, in components of the spectrum, the highest harmonics of neighbouring speeds lie.
BINS_BETWEEN = 0.5
# How far a family usually lies from its place at the speed stated, as a share: by slip and a wrong speed.
FAMILY_PRIOR = 0.015
# Evidence (nats) that a family needs before it says anything about the speed.
DECISIVE = 12.0
# A speed is preferred to another only if this many more lines stand out at it.
MORE_LINES = 4
# Another speed than the one stated has to be better by so many nats, over the most that it may be off: chance finds
# more where more speeds are tried. These are 3 nats for a measured speed.
WORTH_LEAVING = 3.0 / MEASURED_WITHIN
# A harmonic of the shaft as near to a line of a race as slip and a wrong speed together may move it, may be that line.
# Slip moves what lies at multiples of BPFO and BPFI by up to this share.
MOVED_BY_SLIP = 0.027


@dataclass(frozen=True)
class Speed:
    """Refined shaft speed in Hz and the evidence (nats) of shaft harmonics there, and of all but the strongest."""

    shaft_hz: float
    evidence: float
    of_others: float


def vibration_excess(power: Array, step: float, shaft_hz: float) -> Array:
    """`power` (B, F) of spectra of the vibration itself, components `step` (Hz) apart, over its local floor, taken over
    so many orders that single harmonics of a shaft at `shaft_hz` do not raise it."""
    block = max(FEWEST_BINS, int(SPECTRUM_FLOOR_ORDERS * shaft_hz / step))
    return over_floor(power, min(block, max(2, power.shape[-1] // 2)))


def vibration_lines(record: Conditioned, shaft_hz: float, top_hz: float) -> tuple[Lines, Array]:
    """Lines of the raw spectrum, over the angle turned where the speed changes, over its local floor up to `top_hz`,
    and that excess (1, F)."""
    count = min(record.raw.size, int(top_hz / record.step) + 2)
    power = np.abs(record.slow(count)[None]) ** 2
    excess = vibration_excess(power, record.step, shaft_hz)
    return lines_in(excess, record.step), excess


def refine_speed(spectrum: Lines, envelopes: EnvelopeSpectra, known: Kinematics, *, exact: bool = False) -> Speed:
    """The most likely shaft speed within what the one given may be off, or that one if it is `exact`.

    Counts shaft harmonics 1 to 8 of the vibration, 1 to 4 of the widest band's envelope, and how near a cage without
    slip comes to the strongest outer or inner family. Harmonics on which lines of a race may lie say nothing: a spall
    at BPFO = 3.05 would pass for a third harmonic at a speed 1.8 % higher. Without evidence the speed given is kept,
    and so is a measured one from which one line alone would lead away: it may be of another bearing or machine.
    Where the shaft shows, all its harmonics in the spectra then refine it, to one component at the highest of them: of
    a shaft that knocks, harmonics 40 to 50 lie where those of the races are looked for.
    """
    turning = lines_in(envelopes.excess[:1], envelopes.step)
    tolerance = 0.0 if exact else known.speed_within
    count = int(np.ceil(2.0 * tolerance * known.shaft_hz * SHAFT_HARMONICS / (BINS_BETWEEN * spectrum.step))) + 1
    places = max(PLACES[0], min(count, PLACES[1])) // 2 * 2 + 1 if tolerance > 0.0 else 1
    factors = np.linspace(1.0 - tolerance, 1.0 + tolerance, places)
    speeds = known.shaft_hz * factors
    unambiguous = unambiguous_harmonics(known)[:, None]
    shaft = unambiguous * tempered(harmonic_evidence(spectrum, speeds, known.shaft_hz, 0.0, SHAFT_HARMONICS)[:, 0])
    modulation = unambiguous[:4] * tempered(harmonic_evidence(turning, speeds, known.shaft_hz, 0.0, 4)[:, 0])
    harmonics = np.concatenate([shaft, modulation])
    comb = harmonics.sum(axis=0)
    joint = (
        comb
        + families_term(envelopes, known, factors)
        - 0.5 * ((factors - 1.0) / (PRIOR_SPREAD * known.speed_within)) ** 2
    )
    stated, place = places // 2, int(joint.argmax())
    gain = joint[place] - joint[stated]
    if known.speed_within <= MEASURED_WITHIN:
        gain -= (harmonics[:, place] - harmonics[:, stated]).max()
    if gain < WORTH_LEAVING * known.speed_within:
        place = stated
    factor, nats = float(factors[place]), float(comb[place])
    if places > 1 and nats > 0.0:
        factor = sharpened(spectrum, turning, known, factor, float(factors[1] - factors[0]))
    return Speed(known.shaft_hz * factor, nats, nats - float(harmonics[:, place].max()))


def unambiguous_harmonics(known: Kinematics) -> Flags:
    """Which of the shaft's harmonics 1 to SHAFT_HARMONICS (H,) no line of a race can be taken for.

    A spall of the inner race goes through the load zone once a turn: beside each of its lines lie others, a turn apart.
    """
    harmonic = np.arange(1.0, SHAFT_HARMONICS + 1.0)[:, None]
    orders, beside = np.array([known.bpfo, known.bpfi, known.bpfi, known.bpfi]), np.array([0.0, -1.0, 0.0, 1.0])
    passes = np.maximum(np.round((harmonic - beside) / orders), 1.0) * orders
    moved = MOVED_BY_SLIP * passes + known.speed_within * (passes + beside)
    return np.asarray((np.abs(harmonic - passes - beside) > moved).all(axis=1))


def sharpened(spectrum: Lines, turning: Lines, known: Kinematics, factor: float, between: float) -> float:
    """The ratio of the shaft's speed to the stated one, within `between` of `factor`, that fits all harmonics in the
    spectra best.

    A line counts with STANDS_OUT at most, and `factor` is kept unless MORE_LINES more such lines stand out at another
    ratio: one line of a race near a multiple of the shaft says nothing about its speed.
    """
    found = []
    for lines in (spectrum, turning):
        harmonics = int((lines.cumulated.shape[-1] - 3) * lines.step / (known.shaft_hz * (factor + between)))
        steps = int(np.ceil(between * known.shaft_hz * harmonics / (BINS_BETWEEN * lines.step)))
        found.append((lines, max(harmonics, 1), steps))
    steps = max(1, *(needed for *_, needed in found))
    factors = factor + between * np.arange(-steps, steps + 1) / steps
    stands, height = np.zeros(factors.size), np.zeros(factors.size)
    for lines, harmonics, _ in found:
        nats = harmonic_evidence(lines, known.shaft_hz * factors, known.shaft_hz, 0.0, harmonics)[:, 0]
        stands += standing(nats)
        height += tempered(nats).sum(axis=0)
    if stands.max() < stands[steps] + MORE_LINES * STANDS_OUT:
        return factor
    return float(factors[most_standing(stands, height)])


def families_term(envelopes: EnvelopeSpectra, known: Kinematics, factors: Array) -> Array:
    """Log prior (N,) of the slip that each of the `factors` (N,) on the speed would imply for the strongest family; 0
    where no family is decisive."""
    lines = lines_in(envelopes.excess, envelopes.step)
    best, term = DECISIVE, np.zeros(factors.size)
    for order in (known.bpfo, known.bpfi):
        family = find_family(lines, order * known.shaft_hz, 2.0 * known.speed_within, known.shaft_hz, FAMILY_PRIOR, 3)
        band = int(family.evidence.argmax())
        if family.evidence[band] > best:
            best = float(family.evidence[band])
            observed = family.fundamental[band] / (order * known.shaft_hz)
            term = -0.5 * ((observed / factors - 1.0) / SLIP_SPREAD) ** 2
    return term
