"""Combs of another shaft, told from the lines of a faulty bearing by lines that no part of a bearing makes.

Those are neither multiples of the shaft, of the cage or of the balls' way over a race, nor sidebands of the races'
lines.
"""

import numpy as np
from scipy.stats import binom

from labels.features.combs import FEWEST_LINES, LOOKED_AT, MOST_PARTS, SLOWEST, evident_family, made_by_bearing
from labels.features.families import STANDS_OUT, harmonic_evidence, most_standing, standing, tempered
from labels.features.kinematics import Kinematics
from labels.features.known_lines import WIDEST_MARGIN, multiple_margin, near_multiples
from labels.features.lines import Lines, lines_in
from physics.arrays import Array, Flags

# Fastest rate, in orders, that is looked for.
FASTEST = 6.5
# Share of the lines looked at that must stand out.
SHARE_OF_LINES = 0.7
# Accept a comb only if random lines would match as well with a probability below this; one of 1362 spectra of simulated
# machines without another shaft has such a one.
CHANCE = 1e-5
# Smallest share of places at which a line is assumed to stand out by chance.
FEWEST_BY_CHANCE = 0.01
# Places that one line covers, half a component apart.
COVERED = 6
# Rates that are tried, at most.
MOST_PLACES = 60_000
# Most foreign shafts that are looked for.
MOST_COMBS = 3
# Most sidebands of the shaft and of the cage that lines of the outer race, of the inner race and of balls have.
SIDEBANDS = ((2, 2), (5, 1), (1, 3))
# Half width of a sideband: in orders, and in shares of its carrier, which slip smears.
SIDEBAND_WIDTH, SIDEBAND_SPREAD = 0.01, 0.001
# Lines between those of a comb that must be readable to show that it is a multiple.
FEWEST_BETWEEN = 3


def foreign_combs(excess: Array, step: float, known: Kinematics, readable: Flags, doubt: float = 0.0) -> list[float]:
    """Rates (Hz) of impulse trains that no part of the bearing makes, in spectra (B, F) over their floor.

    Components lie `step` (Hz) apart; those from which nothing has been taken out are `readable` (F,). The speed of
    `known` may be wrong by the share `doubt`, and a rate so near to one of the bearing's is left out. A record of so
    few turns that lines of the shaft run into others has none.
    """
    margin = multiple_margin(step, known.shaft_hz)
    if margin > WIDEST_MARGIN * known.shaft_hz:
        return []
    mean = excess.mean(axis=0)
    free = readable & ~_of_bearing(lines_in(excess, step), mean.size, known)
    found: list[float] = []
    while len(found) < MOST_COMBS:
        comb = _strongest(np.where(free, mean, 1.0), free, step, known, doubt)
        if comb is None:
            break
        found.append(comb)
        free &= ~near_multiples(mean.size, step, comb, margin)
    return found


def _of_bearing(lines: Lines, count: int, known: Kinematics) -> Flags:
    """Which of `count` components a fault of the bearing explains: lines of races and balls, and their sidebands.

    Only around lines that are there: what a comb lends to a race are one or two of its lines.
    """
    shaft, cage = known.shaft_hz, known.ftf * known.shaft_hz
    place = np.arange(count) * lines.step
    explained = np.zeros(count, dtype=bool)
    for order, (turns, cages) in zip((known.bpfo, known.bpfi, 2.0 * known.ball_spin), SIDEBANDS, strict=True):
        family = evident_family(lines, order, known)
        if family is None:
            continue
        carrier, best = family
        carriers = int(place[-1] / carrier)
        shown = harmonic_evidence(best, np.array([carrier]), shaft, 0.0, carriers)[:, 0, 0] >= STANDS_OUT
        for k in 1 + np.flatnonzero(shown):
            width = max(1.01 * lines.step, SIDEBAND_WIDTH * shaft + SIDEBAND_SPREAD * k * carrier)
            for beside in range(-cages, cages + 1):
                away = place - k * carrier - beside * cage
                explained |= np.abs(away - shaft * np.clip(np.round(away / shaft), -turns, turns)) <= width
    return explained


def _strongest(mean: Array, free: Flags, step: float, known: Kinematics, doubt: float) -> float | None:
    """The rate (Hz) of the comb that is least likely to be chance, in the bands' `mean` (F,) where it is `free` (F,) of
    lines of the bearing; None if chance could make one as good."""
    shaft, top = known.shaft_hz, (mean.size - 3) * step
    low, high = max(SLOWEST * shaft, 4.0 * step), min(FASTEST * shaft, top / FEWEST_LINES)
    if high <= low:
        return None
    lines = lines_in(mean[None], step)
    places = min(int(np.ceil((high - low) * LOOKED_AT[-1] / (0.5 * step))) + 1, MOST_PLACES)
    every = np.linspace(low, high, places)
    rates = every[~made_by_bearing(every / shaft, known, doubt)]
    if rates.size == 0:
        return None
    stands, readable = _standing(lines, free, rates, shaft)
    chance = _log_chance(stands, readable, _standing_elsewhere(lines, free, low, shaft)) + np.log(rates.size)
    best = int(chance.argmin())
    if chance[best] > np.log(CHANCE):
        return None
    rate = _slowest_part(lines, free, float(rates[best]), known, doubt)
    return _sharpened(lines, rate, float(every[1] - every[0]), shaft)


def _standing(lines: Lines, free: Flags, rates: Array, shaft_hz: float) -> tuple[Flags, Flags]:
    """Whether multiple k of each of the `rates` (N,) stands out, and whether it can be read at all: (K, N) each."""
    nats = harmonic_evidence(lines, rates, shaft_hz, 0.0, LOOKED_AT[-1])[:, 0]
    places = np.arange(1, LOOKED_AT[-1] + 1)[:, None] * rates
    inside = places < (free.size - 3) * lines.step
    readable = inside & free[np.minimum(np.round(places / lines.step).astype(np.int64), free.size - 1)]
    return (nats > STANDS_OUT) & readable, readable


def _standing_elsewhere(lines: Lines, free: Flags, low: float, shaft_hz: float) -> tuple[int, int]:
    """At how many places half a component apart, free of lines of the bearing, a line stands out, and of how many."""
    places = np.arange(low, (free.size - 3) * lines.step, 0.5 * lines.step)
    nats = harmonic_evidence(lines, places, shaft_hz, 0.0, 1)[0, 0]
    unmarked = free[np.round(places / lines.step).astype(np.int64)]
    return int(np.count_nonzero(unmarked & (nats > STANDS_OUT))), int(np.count_nonzero(unmarked))


def _log_chance(stands: Flags, readable: Flags, elsewhere: tuple[int, int]) -> Array:
    """Logarithm (N,) of the probability that random lines make as many lines of a comb stand out; 0 if the comb has too
    few."""
    # Lines that stand out because they belong to the comb itself are no evidence against it.
    others = np.maximum(elsewhere[0] - COVERED * stands.sum(axis=0), 0) / max(elsewhere[1], 1)
    chance = np.clip(others, FEWEST_BY_CHANCE, 1.0)
    least = np.zeros(stands.shape[1])
    for count in LOOKED_AT:
        found, tried = stands[:count].sum(axis=0), readable[:count].sum(axis=0)
        enough = (found >= FEWEST_LINES) & (found >= SHARE_OF_LINES * tried)
        doubt = binom.logsf(found[enough] - 1, tried[enough], chance[enough])
        least[enough] = np.minimum(least[enough], doubt)
    return least


def _slowest_part(lines: Lines, free: Flags, comb: float, known: Kinematics, doubt: float) -> float:
    """The rate of which `comb` is a multiple, if the lines between those of `comb` stand out as well and a shaft whose
    speed is in `doubt` does not make it; else `comb`."""
    off = np.linspace(-1.0, 1.0, 9) * lines.step / (3.0 * comb)
    for part in range(MOST_PARTS, 1, -1):
        rates = comb / part * (1.0 + off)
        if rates[0] < max(SLOWEST * known.shaft_hz, 4.0 * lines.step):
            continue
        if doubt > 0.0 and made_by_bearing(rates / known.shaft_hz, known, doubt).any():
            continue
        stands, readable = _standing(lines, free, rates, known.shaft_hz)
        between = np.arange(1, LOOKED_AT[-1] + 1) % part != 0
        found, tried = stands[between].sum(axis=0), readable[between].sum(axis=0)
        complete = (tried >= FEWEST_BETWEEN) & (found >= SHARE_OF_LINES * tried)
        if complete.any():
            return float(rates[complete.argmax()])
    return comb


def _sharpened(lines: Lines, rate: float, between: float, shaft_hz: float) -> float:
    """The rate (Hz) within three times `between` of `rate` whose multiples in the spectrum stand out most."""
    rates = np.linspace(rate - 3.0 * between, rate + 3.0 * between, 121)
    multiples = int((lines.cumulated.shape[-1] - 4) * lines.step / rates[-1])
    nats = harmonic_evidence(lines, rates, shaft_hz, 0.0, multiples)[:, 0]
    return float(rates[most_standing(standing(nats), tempered(nats).sum(axis=0))])
