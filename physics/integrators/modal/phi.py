"""The φ-functions of the modes, which weigh the contact force of a step: φ0 = exp, φm(z) = (φ(m−1)(z) − 1/(m − 1)!)/z.

Each comes from the power series of φ5 at half the step, recursion down to φ0, and the doubling formulas, all without
cancellation. A pair of amplitudes multiplies like a complex number if it swings, and part by part if it decays;
`product` does both.
"""

from __future__ import annotations

import numpy as np

from physics._jit import njit_inline, njit_inner
from physics.arrays import Array
from physics.integrators.modal.flow import AMPLITUDES, PAIRS
from physics.integrators.modal.layout import POWERS

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
            double(swing, phi, phi, pair)


@njit_inline
def double(twist: float, half: Array, whole: Array, pair: int) -> None:
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
