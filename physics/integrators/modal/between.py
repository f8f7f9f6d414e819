"""Weights of steps between whole numbers of units, read off those of eight whole numbers around.

A contact change or a kink ends a step anywhere, and to compute its weights anew costs as much as the step. As functions
of its length they are as smooth as the fastest mode turns slowly, so that a polynomial through eight rows of the table
gives them in a tenth of the time.
"""

from __future__ import annotations

from physics._jit import njit_inner, njit_pasted
from physics.arrays import Array
from physics.integrators.modal.flow import LinearFlow
from physics.integrators.modal.memory import BETWEEN, UNITS, Memory
from physics.integrators.modal.weights import set_step

NODES, NODES_BEHIND = 8, 3
# Radians that the fastest mode may turn in a unit. A weight is then wrong by 2e-10 of the largest of its kind in the
# table at most: by LONGEST_TURN^8 / 8! times the product of the distances to the nodes, 660 between the first two.
LONGEST_TURN = 0.1


@njit_pasted
def set_between(flow: LinearFlow, memory: Memory, step: float, unit: float) -> None:
    """Fill the row BETWEEN of the memory's weights for a step of `step` (s), on a grid of `unit` (s)."""
    if flow.fastest * unit > LONGEST_TURN or step > UNITS * unit:
        set_step(flow, memory.weights[BETWEEN], step, memory.phi)
    else:
        read_between(memory.weights, step / unit)


@njit_inner
def read_between(table: Array, units: float) -> None:
    """Fill the row BETWEEN of `table` (26, 168) for a step of `units`, up to 16, from the first rows, by Lagrange's
    polynomials."""
    first = min(max(int(units) - NODES_BEHIND, 0), UNITS + 1 - NODES)
    d0 = units - first
    d1, d2, d3, d4, d5, d6, d7 = d0 - 1.0, d0 - 2.0, d0 - 3.0, d0 - 4.0, d0 - 5.0, d0 - 6.0, d0 - 7.0
    low2 = d0 * d1
    low3 = low2 * d2
    low4 = low3 * d3
    high5 = d6 * d7
    high4 = d5 * high5
    high3 = d4 * high4
    s0, s1 = d1 * d2 * d3 * high3 / -5040.0, d0 * d2 * d3 * high3 / 720.0
    s2, s3 = low2 * d3 * high3 / -240.0, low3 * high3 / 144.0
    s4, s5 = low4 * high4 / -144.0, low4 * d4 * high5 / 240.0
    s6, s7 = low4 * d4 * d5 * d7 / -720.0, low4 * d4 * d5 * d6 / 5040.0
    for place in range(table.shape[1]):
        table[BETWEEN, place] = (
            (s0 * table[first, place] + s1 * table[first + 1, place])
            + (s2 * table[first + 2, place] + s3 * table[first + 3, place])
        ) + (
            (s4 * table[first + 4, place] + s5 * table[first + 5, place])
            + (s6 * table[first + 6, place] + s7 * table[first + 7, place])
        )
