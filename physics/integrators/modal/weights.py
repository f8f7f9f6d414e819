"""What a step of given length does to the modes: their free turn and the φ-functions that weigh the contact force.

φ0 = exp, φm(z) = (φ(m−1)(z) − 1/(m − 1)!)/z. Each comes from the power series of φ5 at half the step, recursion down to
φ0, and the doubling formulas, all without cancellation. A pair of amplitudes multiplies like a complex number if it
swings, and part by part if it decays; `product` does both.

Everything a step needs is summed up beforehand over the modes as far as it goes, and lies in one row of numbers at
fixed places, so that the kernels read it without a loop of unknown length.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_inner, njit_lean
from physics.integrators.modal.flow import (
    AMPLITUDES,
    AXIS,
    DISPLACEMENT,
    OUTER,
    OUTER_ACCELERATION,
    OUTER_SPEED,
    OUTPUT,
    PAIRS,
    VELOCITY,
    LinearFlow,
    Motion,
    weigh,
)

Array = NDArray[np.float64]

# The contact force of a step is a polynomial in the share of the step, of this many powers.
POWERS = 5
# Weights of a step along x; those along y follow at OTHER. The shares of the six amplitudes at its beginning in
# displacement and velocity in the middle and at the end; the free turn, four numbers a pair; what a force of 1, s, s² …
# adds to displacement and velocity in the middle and at the end, and all powers to each of the six amplitudes.
HALF_POWERS = 4
TURN_NUMBERS, READ_TWICE = 4, 2
HALF, END = 0, READ_TWICE * AXIS
TURN = END + READ_TWICE * AXIS
AT_HALF = TURN + TURN_NUMBERS * PAIRS
AT_END = AT_HALF + READ_TWICE * HALF_POWERS
KICKS = AT_END + READ_TWICE * POWERS
OTHER = KICKS + AXIS * POWERS
STEP_WEIGHTS = 2 * OTHER
# Weights of a sample inside a step along x; those along y follow at INSIDE_OTHER. Each of its readings has a SECTION:
# the shares of the amplitudes at the beginning of the step, and from POWERS_AT on those of the powers of the contact
# force. Then the free turn up to the sample, and the amplitudes that each of the powers adds by then.
INSIDE_READINGS = (OUTPUT, OUTER, OUTER_SPEED, OUTER_ACCELERATION)
POWERS_AT, SECTION = AXIS, AXIS + POWERS
RING_PUSHED = SECTION * INSIDE_READINGS.index(OUTER_ACCELERATION) + POWERS_AT
INSIDE_TURN = SECTION * len(INSIDE_READINGS)
INSIDE_KICKS = INSIDE_TURN + TURN_NUMBERS * PAIRS
INSIDE_OTHER = INSIDE_KICKS + AXIS * POWERS
INSIDE_WEIGHTS = 2 * INSIDE_OTHER
SERIES_TOLERANCE = 1e-15
MOST_TERMS = 60
# Longer lengths are halved until the series of a fast decay loses no digits to its alternating terms.
LARGEST_ARGUMENT = 4.0
# 1/(j + 5) for j = 0 … 60: a division costs more than all else in a term of the series.
SHARES = 1.0 / np.arange(float(POWERS), POWERS + MOST_TERMS + 1.0)
# 1/m! for m = 0 … 5.
INVERSE_FACTORIALS = 1.0 / np.cumprod(np.array([1.0, 1.0, 2.0, 3.0, 4.0, 5.0]))


@njit_inline
def product(twist: float, a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Of the pairs (a, b) and (c, d): as complex numbers if `twist` is 1, part by part if it is 0."""
    return a * c - twist * (b * d), twist * (a * d + b * c) + (1.0 - twist) * (b * d)


@njit_inner
def phi_functions(rate: Array, twist: Array, length: float, phi: Array) -> None:
    """Fill `phi` (6, 12): φ0 to φ5 of every pair of amplitudes over `length` (s)."""
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
    top = phi[POWERS]
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
        a, b = top[re] * INVERSE_FACTORIALS[POWERS], top[im] * INVERSE_FACTORIALS[POWERS]
        top[re], top[im] = a, b
        for order in range(POWERS - 1, -1, -1):
            a, b = product(swing, length * rate[re], length * rate[im], a, b)
            a += INVERSE_FACTORIALS[order]
            b += INVERSE_FACTORIALS[order] * (1.0 - swing)
            phi[order, re], phi[order, im] = a, b
        for _ in range(doublings):
            _double(swing, phi, phi, pair)


@njit_inline
def _double(twist: float, half: Array, whole: Array, pair: int) -> None:
    """φ0 to φ5 of one pair over twice the length of `half` (6, 12), which may be `whole`."""
    re, im = 2 * pair, 2 * pair + 1
    e, f = half[0, re], half[0, im]
    scale = 0.5**POWERS
    for order in range(POWERS, 0, -1):
        a, b = product(twist, e, f, half[order, re], half[order, im])
        for lower in range(1, order + 1):
            a += INVERSE_FACTORIALS[order - lower] * half[lower, re]
            b += INVERSE_FACTORIALS[order - lower] * half[lower, im]
        whole[order, re], whole[order, im] = scale * a, scale * b
        scale *= 2.0
    whole[0, re], whole[0, im] = product(twist, e, f, e, f)


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
        axis, here = pair // PAIRS, 2 * (pair % PAIRS)
        base, re, im, twist = axis * OTHER, 2 * pair, 2 * pair + 1, flow.twist[pair]
        _double(twist, half, whole, pair)
        set_turn(weights, base + TURN + 2 * here, twist, whole[0, re], whole[0, im])
        for read in range(2):
            a, b = flow.read[DISPLACEMENT + read, re], flow.read[DISPLACEMENT + read, im]
            place = base + AXIS * read + here
            weights[place + HALF], weights[place + HALF + 1] = _read_turned(twist, a, b, half[0, re], half[0, im])
            weights[place + END], weights[place + END + 1] = _read_turned(twist, a, b, whole[0, re], whole[0, im])
        scale, early = step, 0.5 * step
        for power in range(POWERS):
            real, imaginary = product(
                twist, scale * flow.kick[re], scale * flow.kick[im], whole[power + 1, re], whole[power + 1, im]
            )
            place = base + KICKS + POWERS * here + power
            weights[place], weights[place + POWERS] = real, imaginary
            for read in range(2):
                a, b = flow.read[DISPLACEMENT + read, re], flow.read[DISPLACEMENT + read, im]
                weights[base + AT_END + 2 * power + read] += a * real + b * imaginary
            if power < HALF_POWERS:
                real, imaginary = product(
                    twist, early * flow.kick[re], early * flow.kick[im], half[power + 1, re], half[power + 1, im]
                )
                for read in range(2):
                    a, b = flow.read[DISPLACEMENT + read, re], flow.read[DISPLACEMENT + read, im]
                    weights[base + AT_HALF + 2 * power + read] += a * real + b * imaginary
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
            axis, here = pair // PAIRS, 2 * (pair % PAIRS)
            base, re, im, twist = axis * INSIDE_OTHER, 2 * pair, 2 * pair + 1, flow.twist[pair]
            for section in range(len(INSIDE_READINGS)):
                a, b = flow.read[INSIDE_READINGS[section], re], flow.read[INSIDE_READINGS[section], im]
                place = base + SECTION * section + here
                weights[place], weights[place + 1] = _read_turned(twist, a, b, phi[0, re], phi[0, im])
            set_turn(weights, base + INSIDE_TURN + 2 * here, twist, phi[0, re], phi[0, im])
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


@njit_inline
def turn(weights: Array, first: int, stride: int, start: Array, end: Array) -> None:
    """Put into `end` (12,) the amplitudes `start` after the free turn from `first` on, along y `stride` further."""
    for axis in range(2):
        for pair in range(PAIRS):
            place, part = axis * stride + first + 4 * pair, axis * AXIS + 2 * pair
            a, b = start[part], start[part + 1]
            end[part] = weights[place] * a + weights[place + 1] * b
            end[part + 1] = weights[place + 2] * a + weights[place + 3] * b


@njit_inline
def push(weights: Array, first: int, stride: int, course: Array, end: Array) -> None:
    """Add to `end` (12,) what the contact force of `course` (2, 5) does, by the kicks from `first` on."""
    for axis in range(2):
        kicks = axis * stride + first
        c0, c1, c2, c3, c4 = course[axis, 0], course[axis, 1], course[axis, 2], course[axis, 3], course[axis, 4]
        for part in range(AXIS):
            place = kicks + POWERS * part
            end[axis * AXIS + part] += (
                (weights[place] * c0 + weights[place + 1] * c1)
                + (weights[place + 2] * c2 + weights[place + 3] * c3)
                + weights[place + 4] * c4
            )


@njit_inline
def read_inside(weights: Array, section: int, axis: int, start: Array, course: Array) -> float:
    """What a sample inside a step reads along one axis, but for the loads, from the amplitudes `start` (12,) and the
    `course` (2, 5) of the contact force."""
    first, part = axis * INSIDE_OTHER + SECTION * section, axis * AXIS
    kick = first + POWERS_AT
    c0, c1, c2, c3, c4 = course[axis, 0], course[axis, 1], course[axis, 2], course[axis, 3], course[axis, 4]
    # In pairs, so that fewer operations wait for each other than in a chain.
    one = weights[first] * start[part] + weights[first + 1] * start[part + 1]
    two = weights[first + 2] * start[part + 2] + weights[first + 3] * start[part + 3]
    three = weights[first + 4] * start[part + 4] + weights[first + 5] * start[part + 5]
    pushed = (weights[kick] * c0 + weights[kick + 1] * c1) + (weights[kick + 2] * c2 + weights[kick + 3] * c3)
    return ((one + two) + three) + (pushed + weights[kick + 4] * c4)


@njit_inline
def free_motion(weights: Array, first: int, start: Array, rest: Array) -> Motion:
    """Relative motion without contact force, by the shares from `first` on."""
    return (
        rest[0, DISPLACEMENT] + weigh(weights, first, start, 0),
        rest[1, DISPLACEMENT] + weigh(weights, OTHER + first, start, 1),
        rest[0, VELOCITY] + weigh(weights, first + AXIS, start, 0),
        rest[1, VELOCITY] + weigh(weights, OTHER + first + AXIS, start, 1),
    )


@njit_inline
def pushed(weights: Array, first: int, power: int, motion: Motion, force: tuple[float, float]) -> Motion:
    """Relative `motion` with what a `force` (N, N) times one power of the share of the step adds, by the weights from
    `first` on."""
    along_x, along_y = first + 2 * power, OTHER + first + 2 * power
    return (
        motion[0] + weights[along_x] * force[0],
        motion[1] + weights[along_y] * force[1],
        motion[2] + weights[along_x + 1] * force[0],
        motion[3] + weights[along_y + 1] * force[1],
    )
