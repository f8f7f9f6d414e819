"""Where the shaft rests at one instant after another, each looked for where those before let one expect it."""

from __future__ import annotations

from physics._jit import njit_inline, njit_lean
from physics.arrays import Array
from physics.contact.forces import Contacts, stand_at
from physics.motion import MotionModel, outer_load
from physics.statics.rest import LARGEST_MOVE, NO_EQUILIBRIUM, ElasticSums, elastic, solve_at

# A shaft that moved by less than this share of its displacement is expected to move on as far.
NEARBY = 0.05
# From below this share Newton's method needs no safeguards, if the determinant of the stiffness is above that share of
# its trace squared; and how many steps of it are made.
NEAR, REGULAR, MOST_STEPS = 1e-2, 1e-6, 4


@njit_inline
def rest_at(
    contacts: Contacts, motion: MotionModel, time: float, x: float, y: float, tolerance: float
) -> tuple[float, float, ElasticSums, bool]:
    """Where the shaft rests (m, m) at `time` (s), what the contacts hold there, and whether any position carries the
    load.

    It is looked for from the expected place (x, y), m. Where no position carries the load, the first two are those of
    the centre.
    """
    stand_at(contacts, time)
    load_x, load_y = outer_load(motion, time)
    return _settle(contacts, load_x, load_y, x, y, tolerance)


@njit_inline
def _settle(
    contacts: Contacts, load_x: float, load_y: float, x: float, y: float, tolerance: float
) -> tuple[float, float, ElasticSums, bool]:
    """What `rest_at` gives, under the load (N, N).

    If (x, y) is nearly right, a few steps of Newton's method without safeguards lead to where less than `tolerance` of
    the load is unbalanced; otherwise the whole search is made from there.
    """
    load = load_x * load_x + load_y * load_y
    sums = elastic(contacts, x, y)
    for _ in range(MOST_STEPS):
        gx, gy = load_x - sums.force_x, load_y - sums.force_y
        missing = gx * gx + gy * gy
        if missing <= tolerance**2 * load and load > 0.0 and x * x + y * y <= LARGEST_MOVE**2:
            return x, y, sums, True
        determinant = sums.xx * sums.yy - sums.xy * sums.xy
        if not (missing <= NEAR**2 * load and determinant > REGULAR * (sums.xx + sums.yy) ** 2):
            break
        x += (sums.yy * gx - sums.xy * gy) / determinant
        y += (sums.xx * gy - sums.xy * gx) / determinant
        sums = elastic(contacts, x, y)
    x, y, sums, status = solve_at(contacts, load_x, load_y, x, y)
    return x, y, sums, status != NO_EQUILIBRIUM


@njit_lean
def expected(position: Array, k: int, stride: int) -> tuple[float, float]:
    """Where the shaft may be expected (m, m) at instant `k`: on the parabola through the last three of `position` (T, 2
    or more), m, a `stride` apart, or where it was last if it moved far since the one before."""
    if k < stride:
        return 0.0, 0.0
    x, y = position[k - stride, 0], position[k - stride, 1]
    if k < 2 * stride:
        return x, y
    before_x, before_y = position[k - 2 * stride, 0], position[k - 2 * stride, 1]
    if (x - before_x) ** 2 + (y - before_y) ** 2 >= NEARBY**2 * (x * x + y * y):
        return x, y
    if k < 3 * stride:
        return 2.0 * x - before_x, 2.0 * y - before_y
    return 3.0 * (x - before_x) + position[k - 3 * stride, 0], 3.0 * (y - before_y) + position[k - 3 * stride, 1]
