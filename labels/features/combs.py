"""Combs: the lines of an impulse train, at all multiples of its rate, as they stand in envelope spectra.

What knocks regularly on another shaft, as a broken tooth, a coupling or a cam does, makes one. Some of its lines lie
where those of a race are looked for, so they are taken out. `foreign_combs` and `race_combs` find its rate.
"""

import numpy as np

from labels.features.families import find_family
from labels.features.kinematics import SLIP_PRIOR, SLIP_TOLERANCE, Kinematics
from labels.features.known_lines import SHAFT_MARGIN, near_multiples
from labels.features.lines import Lines
from physics.arrays import Array, Flags

# Slowest rate, in orders, that is looked for.
SLOWEST = 0.12
# How many multiples are looked at: a train whose intervals vary keeps the lowest ones only.
LOOKED_AT = (8, 16, 24)
# Lines that must stand out. No rate is found of which the spectrum holds fewer multiples.
FEWEST_LINES = 5
# Nats of a family of the bearing that is taken to be there.
EVIDENT = 8.0
# Share by which a rate must differ from one that the bearing makes.
OF_BEARING = 0.03
# The rate first found may be a multiple of the true one, up to the eighth.
MOST_PARTS = 8
# Share of a comb's rate that is taken out on each side of its lines, at most: more would take most of the spectrum.
WIDEST_OF_COMB = 0.2
# Components to each side of a line that it fills, of a Hann window, and strong lines of the vibration nearly so.
LINE_REACHES = 2.01
# Where the median beside a comb's lines is this many times the usual height, they reach as far; the median of noise is
# within a tenth.
BESIDE_A_LINE = 1.3
# Turns of the cage over a race that balls which differ mark.
CAGE_TURNS = (1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0, 2.0, 3.0, 4.0)


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


def evident_family(lines: Lines, order: float, known: Kinematics) -> tuple[float, Lines] | None:
    """Fundamental (Hz) of the bearing's family near an `order` of the shaft in the band that shows it best, and the
    lines of this band alone; None if it is not EVIDENT."""
    family = find_family(lines, order * known.shaft_hz, SLIP_TOLERANCE, known.shaft_hz, SLIP_PRIOR)
    band = int(family.evidence.argmax())
    if family.evidence[band] < EVIDENT:
        return None
    return float(family.fundamental[band]), Lines(lines.cumulated[band : band + 1], lines.step)


def made_by_bearing(
    orders: Array, known: Kinematics, doubt: float, cage_turns: tuple[float, ...] = CAGE_TURNS
) -> Flags:
    """Which (N,) of the `orders` (N,) of a shaft the bearing or the shaft itself makes, or halves of what they make.

    The speed of `known` may be wrong by the share `doubt`; `cage_turns` are the turns of the cage over a race that
    count as made by the bearing.
    """
    made = np.abs(2.0 * orders - np.round(2.0 * orders)) < 2.0 * (OF_BEARING * np.minimum(orders, 1.0) + doubt * orders)
    # Multiples of a shaft whose speed is exact are taken out before; those of one in doubt lie on combs of a part.
    turns = np.round(1.0 / np.minimum(orders, 1.0))
    made |= (turns <= MOST_PARTS) & (np.abs(turns * orders - 1.0) < doubt)
    parts = [part * share for part in (known.bpfo, known.bpfi, 2.0 * known.ball_spin) for share in (0.5, 1.0, 2.0)]
    # Balls that differ mark the cage's turns over the outer race, and those over the inner one.
    cages = (known.ftf, 1.0 - known.ftf)
    parts += [cage * share for cage in cages for share in cage_turns]
    return np.asarray(made | (np.abs(orders[:, None] / np.array(parts) - 1.0) < OF_BEARING + doubt).any(axis=1))
