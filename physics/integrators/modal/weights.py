"""What a step of given length does to the modes: their free turn and the φ-functions that weigh the contact force.

φ0 = exp, φm(z) = (φ(m−1)(z) − 1/(m − 1)!)/z. Each comes from the power series of φ3 at half the step, recursion down to
φ0, and the doubling formulas, all without cancellation. A pair of amplitudes multiplies like a complex number if it
swings, and part by part if it decays; `product` does both.

Everything a step needs is summed up beforehand over the modes as far as it goes, and lies in one row of numbers at
fixed places, so that the kernels read it without a loop of unknown length.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_lean
from physics.integrators.modal.flow import AMPLITUDES, AXIS, DISPLACEMENT, OUTPUT, PAIRS, LinearFlow

Array = NDArray[np.float64]

# Weights of a step along x; those along y follow at OTHER. The shares of the six amplitudes at its beginning in
# displacement and velocity in the middle and at the end; the free turn, four numbers a pair; the amplitudes per unit of
# the contact force of stage 1, of stages 2 and 3, and of stage 4; what the force of one stage adds to displacement and
# velocity in a later one and, from all of them, at the end.
HALF, END = 0, 12
TURN = 24
FIRST, MIDDLE, LAST = 36, 42, 48
TO_2, TO_3_FROM_1, TO_3_FROM_2, TO_4_FROM_1, TO_4_FROM_3 = 54, 56, 58, 60, 62
END_FIRST, END_MIDDLE, END_LAST = 64, 66, 68
OTHER = 70
STEP_WEIGHTS = 2 * OTHER
# Weights of a sample inside a step along x; those along y follow at INSIDE_OTHER. The shares of the amplitudes at the
# beginning of the step, and of the contact force at its beginning, in the middle and at its end, in the resonator's
# acceleration; the free turn up to the sample, and the amplitudes that each of the three forces adds by then.
INSIDE_READ, INSIDE_FIRST, INSIDE_MIDDLE, INSIDE_LAST = 0, 6, 7, 8
INSIDE_TURN, INSIDE_KICKS = 9, 21
INSIDE_OTHER = 39
INSIDE_WEIGHTS = 2 * INSIDE_OTHER
SERIES_TOLERANCE = 1e-15
MOST_TERMS = 60
# Longer lengths are halved until the series of a fast decay loses no digits to its alternating terms.
LARGEST_ARGUMENT = 4.0
# 1/(j + 3) for j = 0 … 60: a division costs more than all else in a term of the series.
SHARES = 1.0 / np.arange(3.0, MOST_TERMS + 4.0)


@njit_inline
def product(twist: float, a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Of the pairs (a, b) and (c, d): as complex numbers if `twist` is 1, part by part if it is 0."""
    return a * c - twist * (b * d), twist * (a * d + b * c) + (1.0 - twist) * (b * d)


@njit_lean
def phi_functions(rate: Array, twist: Array, length: float, phi: Array) -> None:
    """Fill `phi` (4, 12): φ0 to φ3 of every pair of amplitudes over `length` (s)."""
    size, doublings = 0.0, 0
    for part in range(AMPLITUDES):
        size = max(size, 2.0 * length * abs(rate[part]))
    while size > LARGEST_ARGUMENT:
        size *= 0.5
        length *= 0.5
        doublings += 1
    terms, term = 1, 0.25 * size
    while term > SERIES_TOLERANCE and terms < MOST_TERMS:
        terms += 1
        term *= size * SHARES[terms]
    top = phi[3]
    for pair in range(2 * PAIRS):
        top[2 * pair], top[2 * pair + 1] = 1.0, 1.0 - twist[pair]
    # The pairs take turns, so that their chains of operations overlap.
    for back in range(terms):
        share = length * SHARES[terms - back]
        for pair in range(2 * PAIRS):
            re, im, swing = 2 * pair, 2 * pair + 1, twist[pair]
            a, b = product(swing, share * rate[re], share * rate[im], top[re], top[im])
            top[re], top[im] = 1.0 + a, 1.0 - swing + b
    for pair in range(2 * PAIRS):
        re, im, swing = 2 * pair, 2 * pair + 1, twist[pair]
        a, b = top[re] / 6.0, top[im] / 6.0
        top[re], top[im] = a, b
        for order in range(2, -1, -1):
            constant = 0.5 if order == 2 else 1.0
            a, b = product(swing, length * rate[re], length * rate[im], a, b)
            a, b = a + constant, b + constant * (1.0 - swing)
            phi[order, re], phi[order, im] = a, b
        for _ in range(doublings):
            _double(swing, phi, phi, pair)


@njit_inline
def _double(twist: float, half: Array, whole: Array, pair: int) -> None:
    """φ0 to φ3 of one pair over twice the length of `half` (4, 12), which may be `whole`."""
    re, im = 2 * pair, 2 * pair + 1
    e, f = half[0, re], half[0, im]
    a, b = product(twist, e, f, half[3, re], half[3, im])
    whole[3, re] = 0.125 * (a + 0.5 * half[1, re] + half[2, re] + half[3, re])
    whole[3, im] = 0.125 * (b + 0.5 * half[1, im] + half[2, im] + half[3, im])
    a, b = product(twist, e, f, half[2, re], half[2, im])
    whole[2, re], whole[2, im] = 0.25 * (a + half[1, re] + half[2, re]), 0.25 * (b + half[1, im] + half[2, im])
    a, b = product(twist, e, f, half[1, re], half[1, im])
    whole[1, re], whole[1, im] = 0.5 * (a + half[1, re]), 0.5 * (b + half[1, im])
    whole[0, re], whole[0, im] = product(twist, e, f, e, f)


@njit_inline
def set_turn(weights: Array, place: int, twist: float, a: float, b: float) -> None:
    """Put the multiplication by the pair (a, b) as a matrix of four numbers to `place`."""
    weights[place], weights[place + 1] = a, -twist * b
    weights[place + 2], weights[place + 3] = twist * b, twist * a + (1.0 - twist) * b


@njit_lean
def set_step(flow: LinearFlow, weights: Array, step: float, phi: Array) -> None:
    """Fill `weights` (140,) for a step of `step` (s); `phi` (2, 4, 12) is scratch."""
    half, whole = phi[0], phi[1]
    phi_functions(flow.rate, flow.twist, 0.5 * step, half)
    for axis in range(2):
        for place in range(axis * OTHER + TO_2, (axis + 1) * OTHER):
            weights[place] = 0.0
    for pair in range(2 * PAIRS):
        axis, here = pair // PAIRS, 2 * (pair % PAIRS)
        base, re, im, twist = axis * OTHER, 2 * pair, 2 * pair + 1, flow.twist[pair]
        _double(twist, half, whole, pair)
        set_turn(weights, base + TURN + 2 * here, twist, whole[0, re], whole[0, im])
        kr, ki = step * flow.kick[re], step * flow.kick[im]
        kicks = (
            product(twist, kr, ki, whole[1, re] - 3.0 * whole[2, re] + 4.0 * whole[3, re],
                    whole[1, im] - 3.0 * whole[2, im] + 4.0 * whole[3, im]),
            product(twist, kr, ki, 2.0 * whole[2, re] - 4.0 * whole[3, re], 2.0 * whole[2, im] - 4.0 * whole[3, im]),
            product(twist, kr, ki, 4.0 * whole[3, re] - whole[2, re], 4.0 * whole[3, im] - whole[2, im]),
        )  # fmt: skip
        for stage in range(3):
            weights[base + FIRST + 6 * stage + here] = kicks[stage][0]
            weights[base + FIRST + 6 * stage + here + 1] = kicks[stage][1]
        half_1, half_2 = (
            product(twist, kr, ki, half[1, re], half[1, im]),
            product(twist, kr, ki, half[2, re], half[2, im]),
        )
        whole_1 = product(twist, kr, ki, whole[1, re], whole[1, im])
        whole_2 = product(twist, kr, ki, whole[2, re], whole[2, im])
        for read in range(2):
            a, b = flow.read[DISPLACEMENT + read, re], flow.read[DISPLACEMENT + read, im]
            first, second = _read_turned(twist, a, b, half[0, re], half[0, im])
            weights[base + HALF + AXIS * read + here], weights[base + HALF + AXIS * read + here + 1] = first, second
            first, second = _read_turned(twist, a, b, whole[0, re], whole[0, im])
            weights[base + END + AXIS * read + here], weights[base + END + AXIS * read + here + 1] = first, second
            early, late = 0.5 * (a * half_1[0] + b * half_1[1]), a * half_2[0] + b * half_2[1]
            weights[base + TO_2 + read] += early
            weights[base + TO_3_FROM_1 + read] += early - late
            weights[base + TO_3_FROM_2 + read] += late
            early, late = a * whole_1[0] + b * whole_1[1], 2.0 * (a * whole_2[0] + b * whole_2[1])
            weights[base + TO_4_FROM_1 + read] += early - late
            weights[base + TO_4_FROM_3 + read] += late
            for stage in range(3):
                weights[base + END_FIRST + 2 * stage + read] += a * kicks[stage][0] + b * kicks[stage][1]


@njit_inline
def _read_turned(twist: float, a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Shares of a pair in what is read with the shares (a, b) after the pair was multiplied by (c, d)."""
    return a * c + twist * (b * d), twist * (b * c - a * d) + (1.0 - twist) * (b * d)


@njit_lean
def set_inside(flow: LinearFlow, inside: Array, step: float, phi: Array) -> None:
    """Fill `inside` (S − 1, 78) for the samples that a step of S samples and `step` (s) passes over.

    The contact force is the parabola through its values at the beginning, in the middle and at the end of the step.
    `phi` (4, 12) is scratch.
    """
    count = inside.shape[0] + 1
    for k in range(1, count):
        share, weights = k / count, inside[k - 1]
        weights[:] = 0.0
        phi_functions(flow.rate, flow.twist, share * step, phi)
        for pair in range(2 * PAIRS):
            axis, here = pair // PAIRS, 2 * (pair % PAIRS)
            base, re, im, twist = axis * INSIDE_OTHER, 2 * pair, 2 * pair + 1, flow.twist[pair]
            a, b = flow.read[OUTPUT, re], flow.read[OUTPUT, im]
            first, second = _read_turned(twist, a, b, phi[0, re], phi[0, im])
            weights[base + INSIDE_READ + here], weights[base + INSIDE_READ + here + 1] = first, second
            set_turn(weights, base + INSIDE_TURN + 2 * here, twist, phi[0, re], phi[0, im])
            for row in range(3):
                # The parabola's part of this force: what it has of 1, of the share of the step, and of its square.
                constant = share if row == 0 else 0.0
                linear = share**2 * (-3.0 if row == 0 else 4.0 if row == 1 else -1.0)
                square = share**3 * (4.0 if row != 1 else -8.0)
                real, imaginary = product(
                    twist,
                    step * flow.kick[re],
                    step * flow.kick[im],
                    constant * phi[1, re] + linear * phi[2, re] + square * phi[3, re],
                    constant * phi[1, im] + linear * phi[2, im] + square * phi[3, im],
                )
                kick = base + INSIDE_KICKS + AXIS * row + here
                weights[kick], weights[kick + 1] = real, imaginary
                weights[base + INSIDE_FIRST + row] += a * real + b * imaginary


@njit_inline
def turn(weights: Array, first: int, stride: int, start: Array, end: Array) -> None:
    """Put into `end` (12,) the amplitudes `start` after the free turn from `first` on, along y `stride` further."""
    for axis in range(2):
        for pair in range(PAIRS):
            place, part = axis * stride + first + 4 * pair, axis * AXIS + 2 * pair
            a, b = start[part], start[part + 1]
            end[part] = weights[place] * a + weights[place + 1] * b
            end[part + 1] = weights[place + 2] * a + weights[place + 3] * b
