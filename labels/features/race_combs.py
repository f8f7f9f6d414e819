"""Combs of another shaft of which every third to twelfth line passes for one of a race."""

import numpy as np

from labels.features.combs import CAGE_TURNS, FEWEST_LINES, LOOKED_AT, SLOWEST, evident_family, made_by_bearing
from labels.features.families import STANDS_OUT, harmonic_evidence
from labels.features.kinematics import Kinematics
from labels.features.lines import Lines, lines_in
from physics.arrays import Array, Flags

# Most parts into which the lines of a race are divided.
MOST_RACE_PARTS = 12
# In a comb of another shaft, which share of the lines between those of the race stands out, and with which share of
# their height.
SHARE_BETWEEN, AS_HIGH = 0.9, 0.5
# CAGE_TURNS but for 4: with sixteen balls these are a quarter of BPFO, which a comb of another shaft may pass for.
FEW_CAGE_TURNS = CAGE_TURNS[:-1]


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
        family = evident_family(lines, race, known)
        if family is None:
            continue
        fundamental, clearest = family
        for part in range(MOST_RACE_PARTS, 2, -1):
            rate = fundamental / part
            if rate < slowest or made_by_bearing(np.array([rate / shaft]), known, 0.0, FEW_CAGE_TURNS).any():
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
