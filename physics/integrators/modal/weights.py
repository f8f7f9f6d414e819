"""What a step of given length does to the modes: their free turn and what the contact force adds, summed up beforehand.

Everything a step needs is summed up over the modes as far as it goes, and lies in one row of numbers at fixed places
(layout.py), so that the kernels read it without a loop of unknown length.
"""

from __future__ import annotations

from physics._jit import njit_inline, njit_lean
from physics.arrays import Array
from physics.integrators.modal.flow import DISPLACEMENT, PAIRS, PER_AXIS, LinearFlow
from physics.integrators.modal.layout import (
    AT_END,
    AT_HALF,
    END,
    HALF,
    HALF_POWERS,
    INSIDE_KICKS,
    INSIDE_OTHER,
    INSIDE_READINGS,
    INSIDE_TURN,
    KICKS,
    MOTION_READINGS,
    OTHER,
    POWERS,
    POWERS_AT,
    RING_PUSHED,
    SECTION,
    TURN,
    TURN_NUMBERS,
)
from physics.integrators.modal.phi import double, phi_functions, product


@njit_inline
def set_turn(weights: Array, place: int, twist: float, a: float, b: float) -> None:
    """Put the multiplication by the pair (a, b) as a matrix of four numbers to `place`."""
    weights[place], weights[place + 1] = a, -twist * b
    weights[place + 2], weights[place + 3] = twist * b, twist * a + (1.0 - twist) * b


@njit_lean
def set_step(flow: LinearFlow, weights: Array, step: float, phi: Array) -> None:
    """Fill `weights` (168,) for a step of `step` (s); `phi` (2, 6, 12) is scratch."""
    half, whole = phi[0], phi[1]
    phi_functions(flow.rate, flow.twist, 0.5 * step, half)
    for axis in range(2):
        for place in range(axis * OTHER + AT_HALF, axis * OTHER + KICKS):
            weights[place] = 0.0
    for pair in range(2 * PAIRS):
        axis, own = divmod(pair, PAIRS)
        here, base = 2 * own, axis * OTHER
        re, im, twist = 2 * pair, 2 * pair + 1, flow.twist[pair]
        double(twist, half, whole, pair)
        set_turn(weights, base + TURN + TURN_NUMBERS * own, twist, whole[0, re], whole[0, im])
        for read in range(MOTION_READINGS):
            a, b = flow.read[DISPLACEMENT + read, re], flow.read[DISPLACEMENT + read, im]
            place = base + PER_AXIS * read + here
            weights[place + HALF], weights[place + HALF + 1] = _read_turned(twist, a, b, half[0, re], half[0, im])
            weights[place + END], weights[place + END + 1] = _read_turned(twist, a, b, whole[0, re], whole[0, im])
        scale, early = step, 0.5 * step
        for power in range(POWERS):
            real, imaginary = product(
                twist, scale * flow.kick[re], scale * flow.kick[im], whole[power + 1, re], whole[power + 1, im]
            )
            place = base + KICKS + POWERS * here + power
            weights[place], weights[place + POWERS] = real, imaginary
            for read in range(MOTION_READINGS):
                a, b = flow.read[DISPLACEMENT + read, re], flow.read[DISPLACEMENT + read, im]
                weights[base + AT_END + MOTION_READINGS * power + read] += a * real + b * imaginary
            if power < HALF_POWERS:
                real, imaginary = product(
                    twist, early * flow.kick[re], early * flow.kick[im], half[power + 1, re], half[power + 1, im]
                )
                for read in range(MOTION_READINGS):
                    a, b = flow.read[DISPLACEMENT + read, re], flow.read[DISPLACEMENT + read, im]
                    weights[base + AT_HALF + MOTION_READINGS * power + read] += a * real + b * imaginary
            scale *= power + 1.0
            early *= 0.5 * (power + 1.0)


@njit_inline
def _read_turned(twist: float, a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Shares of a pair in what is read with the shares (a, b) after the pair was multiplied by (c, d)."""
    return a * c + twist * (b * d), twist * (b * c - a * d) + (1.0 - twist) * (b * d)


@njit_lean
def set_inside(flow: LinearFlow, inside: Array, step: float, phi: Array) -> None:
    """Fill `inside` (S − 1, 172) for the samples that a step of S samples and `step` (s) passes over.

    The powers of the contact force are of the share of the whole step. `phi` (6, 12) is scratch.
    """
    count = inside.shape[0] + 1
    for k in range(1, count):
        share, weights = k / count, inside[k - 1]
        weights[:] = 0.0
        phi_functions(flow.rate, flow.twist, share * step, phi)
        for pair in range(2 * PAIRS):
            axis, own = divmod(pair, PAIRS)
            here, base = 2 * own, axis * INSIDE_OTHER
            re, im, twist = 2 * pair, 2 * pair + 1, flow.twist[pair]
            for section in range(len(INSIDE_READINGS)):
                a, b = flow.read[INSIDE_READINGS[section], re], flow.read[INSIDE_READINGS[section], im]
                place = base + SECTION * section + here
                weights[place], weights[place + 1] = _read_turned(twist, a, b, phi[0, re], phi[0, im])
            set_turn(weights, base + INSIDE_TURN + TURN_NUMBERS * own, twist, phi[0, re], phi[0, im])
            scale = share * step
            for power in range(POWERS):
                real, imaginary = product(
                    twist, scale * flow.kick[re], scale * flow.kick[im], phi[power + 1, re], phi[power + 1, im]
                )
                kick = base + INSIDE_KICKS + POWERS * here + power
                weights[kick], weights[kick + POWERS] = real, imaginary
                for section in range(len(INSIDE_READINGS)):
                    a, b = flow.read[INSIDE_READINGS[section], re], flow.read[INSIDE_READINGS[section], im]
                    weights[base + SECTION * section + POWERS_AT + power] += a * real + b * imaginary
                scale *= share * (power + 1.0)
        # The ring's acceleration is read but for the force on it.
        for power in range(POWERS):
            weights[RING_PUSHED + power] += share**power / flow.outer_mass
            weights[INSIDE_OTHER + RING_PUSHED + power] += share**power / flow.outer_mass
