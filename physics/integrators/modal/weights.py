"""What a step of given length does to the modes: their free turn and the φ-functions that weigh the contact force.

φ0 = exp, φm(z) = (φ(m−1)(z) − 1/(m − 1)!)/z. Each comes from the power series of φ3 at half the step, recursion down to
φ0, and the doubling formulas, all without cancellation.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_lean
from physics.integrators.modal.flow import DISPLACEMENT, KICK, OUTPUT, RATE

Array = NDArray[np.float64]

# Rows of the weights of one step (20, 2, M): row, axis, mode. Of every mode, real and imaginary: exp over half and
# over the whole step, and what the contact forces of stage 1, of stages 2 and 3, and of stage 4 add. Of each axis, in
# place of its first mode: what the force of one stage adds to displacement and velocity in a later one.
HALF, WHOLE, FIRST, MIDDLE, LAST = 0, 2, 4, 6, 8
TO_2, TO_3_FROM_1, TO_3_FROM_2, TO_4_FROM_1, TO_4_FROM_3 = 10, 12, 14, 16, 18
WEIGHT_ROWS = 20
# Rows of the weights of a sample inside a step (13, 2, M): the modes' shares in the resonator's acceleration, per axis
# those of the contact force at the beginning, in the middle and at the end; and of every mode, real and imaginary, exp
# up to the sample and what the force at the beginning, in the middle and at the end adds by then.
INSIDE_MODES, INSIDE_FIRST, INSIDE_MIDDLE, INSIDE_LAST = 0, 2, 3, 4
INSIDE_TURN, INSIDE_KICKS = 5, 7
INSIDE_ROWS = 13
SERIES_TOLERANCE = 1e-15
MOST_TERMS = 60
# 1/(j + 3) for j = 0 … 60: a division costs more than all else in a term of the series.
SHARES = 1.0 / np.arange(3.0, MOST_TERMS + 4.0)


@njit_lean
def phi_functions(rows: Array, length: float, phi: Array) -> None:
    """Fill `phi` (4, 2, 2, M): φ0 to φ3, real and imaginary, axis, mode, over `length` (s)."""
    size = 0.0
    for axis in range(2):
        for mode in range(phi.shape[3]):
            size = max(size, abs(rows[RATE, axis, mode]) + abs(rows[RATE + 1, axis, mode]))
    size *= length
    terms, term = 1, 0.25 * size
    while term > SERIES_TOLERANCE and terms < MOST_TERMS:
        terms += 1
        term *= size * SHARES[terms]
    for axis in range(2):
        for mode in range(phi.shape[3]):
            x, y = length * rows[RATE, axis, mode], length * rows[RATE + 1, axis, mode]
            real, imaginary = 1.0, 0.0
            for back in range(terms):
                share = SHARES[terms - back]
                a, b = share * x, share * y
                real, imaginary = 1.0 + (a * real - b * imaginary), a * imaginary + b * real
            for order in range(3, -1, -1):
                if order == 3:
                    real, imaginary = real / 6.0, imaginary / 6.0
                else:
                    constant = 0.5 if order == 2 else 1.0
                    real, imaginary = x * real - y * imaginary + constant, x * imaginary + y * real
                phi[order, 0, axis, mode], phi[order, 1, axis, mode] = real, imaginary


@njit_inline
def _double(phi: Array, twice: Array, axis: int, mode: int) -> None:
    """φ0 to φ3 of one mode over twice the length of `phi` (4, 2, 2, M)."""
    er, ei = phi[0, 0, axis, mode], phi[0, 1, axis, mode]
    r1, i1 = phi[1, 0, axis, mode], phi[1, 1, axis, mode]
    r2, i2 = phi[2, 0, axis, mode], phi[2, 1, axis, mode]
    r3, i3 = phi[3, 0, axis, mode], phi[3, 1, axis, mode]
    twice[0, 0, axis, mode], twice[0, 1, axis, mode] = er * er - ei * ei, 2.0 * er * ei
    twice[1, 0, axis, mode] = 0.5 * (er * r1 - ei * i1 + r1)
    twice[1, 1, axis, mode] = 0.5 * (er * i1 + ei * r1 + i1)
    twice[2, 0, axis, mode] = 0.25 * (er * r2 - ei * i2 + r1 + r2)
    twice[2, 1, axis, mode] = 0.25 * (er * i2 + ei * r2 + i1 + i2)
    twice[3, 0, axis, mode] = 0.125 * (er * r3 - ei * i3 + 0.5 * r1 + r2 + r3)
    twice[3, 1, axis, mode] = 0.125 * (er * i3 + ei * r3 + 0.5 * i1 + i2 + i3)


@njit_lean
def set_step(rows: Array, weights: Array, step: float, phi: Array) -> None:
    """Fill `weights` (20, 2, M) for a step of `step` (s); `phi` (2, 4, 2, 2, M) is scratch."""
    half, whole = phi[0], phi[1]
    phi_functions(rows, 0.5 * step, half)
    for axis in range(2):
        for row in range(TO_2, WEIGHT_ROWS):
            weights[row, axis, 0] = 0.0
        for mode in range(weights.shape[2]):
            _double(half, whole, axis, mode)
            kr, ki = step * rows[KICK, axis, mode], step * rows[KICK + 1, axis, mode]
            for part in range(2):
                weights[HALF + part, axis, mode] = half[0, part, axis, mode]
                weights[WHOLE + part, axis, mode] = whole[0, part, axis, mode]
            r1, i1 = whole[1, 0, axis, mode], whole[1, 1, axis, mode]
            r2, i2 = whole[2, 0, axis, mode], whole[2, 1, axis, mode]
            r3, i3 = whole[3, 0, axis, mode], whole[3, 1, axis, mode]
            real, imaginary = r1 - 3.0 * r2 + 4.0 * r3, i1 - 3.0 * i2 + 4.0 * i3
            weights[FIRST, axis, mode] = kr * real - ki * imaginary
            weights[FIRST + 1, axis, mode] = kr * imaginary + ki * real
            real, imaginary = 2.0 * r2 - 4.0 * r3, 2.0 * i2 - 4.0 * i3
            weights[MIDDLE, axis, mode] = kr * real - ki * imaginary
            weights[MIDDLE + 1, axis, mode] = kr * imaginary + ki * real
            real, imaginary = 4.0 * r3 - r2, 4.0 * i3 - i2
            weights[LAST, axis, mode] = kr * real - ki * imaginary
            weights[LAST + 1, axis, mode] = kr * imaginary + ki * real
            for read in range(2):
                dr = rows[DISPLACEMENT + 2 * read, axis, mode]
                di = rows[DISPLACEMENT + 1 + 2 * read, axis, mode]
                # Re(d · kick · h · φ) = a · Re φ − b · Im φ
                a, b = dr * kr - di * ki, dr * ki + di * kr
                half_1 = 0.5 * (a * half[1, 0, axis, mode] - b * half[1, 1, axis, mode])
                half_2 = a * half[2, 0, axis, mode] - b * half[2, 1, axis, mode]
                whole_1, whole_2 = a * r1 - b * i1, 2.0 * (a * r2 - b * i2)
                weights[TO_2 + read, axis, 0] += half_1
                weights[TO_3_FROM_1 + read, axis, 0] += half_1 - half_2
                weights[TO_3_FROM_2 + read, axis, 0] += half_2
                weights[TO_4_FROM_1 + read, axis, 0] += whole_1 - whole_2
                weights[TO_4_FROM_3 + read, axis, 0] += whole_2


@njit_lean
def set_inside(rows: Array, inside: Array, step: float, phi: Array) -> None:
    """Fill `inside` (S − 1, 13, 2, M) for the samples that a step of S samples and `step` (s) passes over.

    The contact force is the parabola through its values at the beginning, in the middle and at the end of the step.
    `phi` (4, 2, 2, M) is scratch.
    """
    count = inside.shape[0] + 1
    inside[:] = 0.0
    for k in range(1, count):
        share = k / count
        phi_functions(rows, share * step, phi)
        for axis in range(2):
            for mode in range(inside.shape[3]):
                out_r, out_i = rows[OUTPUT, axis, mode], rows[OUTPUT + 1, axis, mode]
                er, ei = phi[0, 0, axis, mode], phi[0, 1, axis, mode]
                inside[k - 1, INSIDE_MODES, axis, mode] = out_r * er - out_i * ei
                inside[k - 1, INSIDE_MODES + 1, axis, mode] = out_r * ei + out_i * er
                inside[k - 1, INSIDE_TURN, axis, mode], inside[k - 1, INSIDE_TURN + 1, axis, mode] = er, ei
                kr, ki = step * rows[KICK, axis, mode], step * rows[KICK + 1, axis, mode]
                for part in range(2):
                    constant = share * phi[1, part, axis, mode]
                    linear = share**2 * phi[2, part, axis, mode]
                    square = 2.0 * share**3 * phi[3, part, axis, mode]
                    inside[k - 1, INSIDE_KICKS + part, axis, mode] = constant - 3.0 * linear + 2.0 * square
                    inside[k - 1, INSIDE_KICKS + 2 + part, axis, mode] = 4.0 * (linear - square)
                    inside[k - 1, INSIDE_KICKS + 4 + part, axis, mode] = 2.0 * square - linear
                for row in range(3):
                    kick = INSIDE_KICKS + 2 * row
                    real, imaginary = inside[k - 1, kick, axis, mode], inside[k - 1, kick + 1, axis, mode]
                    real, imaginary = kr * real - ki * imaginary, kr * imaginary + ki * real
                    inside[k - 1, kick, axis, mode], inside[k - 1, kick + 1, axis, mode] = real, imaginary
                    inside[k - 1, INSIDE_FIRST + row, axis, 0] += out_r * real - out_i * imaginary
