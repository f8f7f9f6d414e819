"""Combs of another shaft in the envelopes: what knocks there regularly, as a broken tooth, a coupling or a cam does.

Such an impulse train has lines at all multiples of its rate, and some of them lie where those of a race are looked for.
A train of another shaft has lines that a faulty bearing does not make: neither multiples of the shaft, of the cage or
of the balls' way over a race, nor sidebands of the races' lines.
"""

from __future__ import annotations

import numpy as np
from scipy.stats import binom

from labels.features.families import STANDS_OUT, find_family, harmonic_evidence, tempered
from labels.features.kinematics import SLIP_PRIOR, SLIP_TOLERANCE, Kinematics
from labels.features.known_lines import SHAFT_MARGIN, WIDEST_MARGIN, multiple_margin, near_multiples
from labels.features.lines import Lines, lines_in
from physics.arrays import Array, Flags

# Orders between which a comb's rate is looked for.
SLOWEST, FASTEST = 0.12, 6.5
# How many multiples are looked at: a train whose intervals vary keeps the lowest ones only.
LOOKED_AT = (8, 16, 24)
# Lines that must stand out. No rate is found of which the spectrum holds fewer multiples.
FEWEST_LINES = 5
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
# The rate first found may be a multiple of the true one, up to the eighth.
MOST_PARTS = 8
# Share by which a rate must differ from one that the bearing makes.
OF_BEARING = 0.03
# Nats of a family from which its sidebands are left out.
EVIDENT = 8.0
# Most sidebands of the shaft and of the cage that lines of the outer race, of the inner race and of balls have.
SIDEBANDS = ((2, 2), (5, 1), (1, 3))
# Half width of a sideband: in orders, and in shares of its carrier, which slip smears.
SIDEBAND_WIDTH, SIDEBAND_SPREAD = 0.01, 0.001
# Share of a comb's rate that is taken out on each side of its lines, at most: more would take most of the spectrum.
WIDEST_OF_COMB = 0.2
# Components to each side of a line that it fills, of a Hann window, and strong lines of the vibration nearly so.
LINE_REACHES = 2.01
# Where the median beside a comb's lines is this many times the usual height, they reach as far; the median of noise is
# within a tenth.
BESIDE_A_LINE = 1.3
# Most parts into which the lines of a race are divided; which share of the lines between them stands out in a comb of
# another shaft, and which share of their height these have.
MOST_RACE_PARTS, SHARE_BETWEEN, AS_HIGH = 12, 0.9, 0.5
# Turns of the cage over a race that balls which differ mark; of these, those that no quarter of a row of sixteen is.
CAGE_TURNS = (1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0, 2.0, 3.0, 4.0)
FEW_CAGE_TURNS = CAGE_TURNS[:-1]
# Lines between those of a comb that must be readable to show that it is a multiple.
FEWEST_BETWEEN = 3


def without_combs(excess: Array, step: float, combs: list[float], shaft_hz: float) -> Array:
    """The spectra (B, F) over their floor, components `step` (Hz) apart, with those near lines of `combs` (Hz) set to
    the floor, 1, as far as the lines of each comb reach."""
    for comb in combs:
        margin = _reach(excess.mean(axis=0), step, comb, SHAFT_MARGIN * shaft_hz)
        if margin < WIDEST_OF_COMB * comb:
            excess = np.where(near_multiples(excess.shape[-1], step, comb, margin), 1.0, excess)
    return excess


def _reach(mean: Array, step: float, comb: float, widest: float) -> float:
    """How far (Hz) from multiples of `comb` (Hz) its lines stand out of the bands' `mean` (F,).

    To where the median over the multiples falls to the usual height, or `widest`, and at least as far as a line reaches
    that does not vary. More would take lines of a race that lie beside.
    """
    multiples = np.round(comb * np.arange(1, LOOKED_AT[-1] + 1) / step).astype(np.int64)
    away = np.arange(int(LINE_REACHES) + 1, int(widest / step) + 1)
    inside = multiples[multiples + int(widest / step) < mean.size]
    if inside.size == 0:
        return LINE_REACHES * step + step * away.size
    beside = np.concatenate([mean[inside - away[:, None]], mean[inside + away[:, None]]], axis=1)
    standing = np.median(beside, axis=1) > BESIDE_A_LINE * np.median(mean)
    return LINE_REACHES * step + step * (away.size if standing.all() else int(standing.argmin()))


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


def race_combs(excess: Array, step: float, known: Kinematics, readable: Flags) -> list[float]:
    """Rates (Hz) of impulse trains of which every third to twelfth line passes for one of a race.

    Takes spectra (B, F) over their floor, and which components are `readable` (F,), as `foreign_combs` does. Between
    the lines of a race nothing stands as high as they do, except what the cage and the shaft make. Every second line is
    not looked at, as recordings of faults have lines at halves of BPFO.
    """
    lines, shaft = lines_in(excess, step), known.shaft_hz
    slowest = max(SLOWEST * shaft, 4.0 * step)
    found = []
    for race in (known.bpfo, known.bpfi):
        family = find_family(lines, race * shaft, SLIP_TOLERANCE, shaft, SLIP_PRIOR)
        band = int(family.evidence.argmax())
        if family.evidence[band] < EVIDENT:
            continue
        clearest = Lines(lines.cumulated[band : band + 1], step)
        for part in range(MOST_RACE_PARTS, 2, -1):
            rate = float(family.fundamental[band]) / part
            if rate < slowest or _made_by_bearing(np.array([rate / shaft]), known, 0.0, FEW_CAGE_TURNS).any():
                continue
            if _all_as_high(clearest, readable, rate, part):
                found.append(rate)
                break
    return found


def _all_as_high(lines: Lines, readable: Flags, rate: float, part: int) -> bool:
    """Whether the multiples of `rate` (Hz) stand about as high as every `part`th of them, as far as those stand out."""
    count = min(LOOKED_AT[-1], int((readable.size - 3) * lines.step / rate))
    multiple = np.arange(1, count + 1)
    nats = harmonic_evidence(lines, np.array([rate]), rate, 0.0, count)[:, 0, 0]
    seen = readable[np.round(multiple * rate / lines.step).astype(np.int64)]
    of_race = seen & (multiple % part == 0)
    ends = np.flatnonzero(of_race & (nats <= STANDS_OUT))
    of_race &= multiple < (multiple[ends[0]] if ends.size else count + 1)
    between = seen & (multiple % part != 0) & (multiple < multiple[of_race].max(initial=0))
    stand = between & (nats > STANDS_OUT)
    enough = between.sum() >= FEWEST_LINES and stand.sum() >= SHARE_BETWEEN * between.sum()
    return bool(enough and np.median(nats[between]) > AS_HIGH * np.median(nats[of_race]))


def _of_bearing(lines: Lines, count: int, known: Kinematics) -> Flags:
    """Which of `count` components a fault of the bearing explains: lines of races and balls, and their sidebands.

    Only around lines that are there: what a comb lends to a race are one or two of its lines.
    """
    shaft, cage = known.shaft_hz, known.ftf * known.shaft_hz
    place = np.arange(count) * lines.step
    explained = np.zeros(count, dtype=bool)
    for order, (turns, cages) in zip((known.bpfo, known.bpfi, 2.0 * known.ball_spin), SIDEBANDS, strict=True):
        family = find_family(lines, order * shaft, SLIP_TOLERANCE, shaft, SLIP_PRIOR)
        band = int(family.evidence.argmax())
        if family.evidence[band] < EVIDENT:
            continue
        carrier = family.fundamental[band]
        carriers = int(place[-1] / carrier)
        best = Lines(lines.cumulated[band : band + 1], lines.step)
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
    rates = every[~_made_by_bearing(every / shaft, known, doubt)]
    if rates.size == 0:
        return None
    stands, readable = _standing(lines, free, rates, shaft)
    chance = _log_chance(stands, readable, _standing_elsewhere(lines, free, low, shaft)) + np.log(rates.size)
    best = int(chance.argmin())
    if chance[best] > np.log(CHANCE):
        return None
    rate = _slowest_part(lines, free, float(rates[best]), known, doubt)
    return _sharpened(lines, rate, float(every[1] - every[0]), shaft)


def _made_by_bearing(
    orders: Array, known: Kinematics, doubt: float, cage_turns: tuple[float, ...] = CAGE_TURNS
) -> Flags:
    """Which `orders` (N,) of a shaft whose speed may be wrong by the share `doubt` are of the bearing or of the shaft
    itself, halves of them too, or of so many turns of the cage over a race."""
    made = np.abs(2.0 * orders - np.round(2.0 * orders)) < 2.0 * (OF_BEARING * np.minimum(orders, 1.0) + doubt * orders)
    # Multiples of a shaft whose speed is exact are taken out before; those of one in doubt lie on combs of a part.
    turns = np.round(1.0 / np.minimum(orders, 1.0))
    made |= (turns <= MOST_PARTS) & (np.abs(turns * orders - 1.0) < doubt)
    parts = [part * share for part in (known.bpfo, known.bpfi, 2.0 * known.ball_spin) for share in (0.5, 1.0, 2.0)]
    # Balls that differ mark the cage's turns over the outer race, and those over the inner one.
    cages = (known.ftf, 1.0 - known.ftf)
    parts += [cage * share for cage in cages for share in cage_turns]
    return np.asarray(made | (np.abs(orders[:, None] / np.array(parts) - 1.0) < OF_BEARING + doubt).any(axis=1))


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
        if doubt > 0.0 and _made_by_bearing(rates / known.shaft_hz, known, doubt).any():
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
    standing = np.minimum(nats, STANDS_OUT).sum(axis=0)
    # Strong lines stand out in some components beside their middle too.
    return float(rates[np.where(standing > standing.max() - STANDS_OUT, tempered(nats).sum(axis=0), 0.0).argmax()])
