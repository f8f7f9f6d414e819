"""The quasi-static stiffness of the bearing over time, the parametric excitation behind the vibration [P14 Eq. 26]."""

from __future__ import annotations

import numpy as np

from physics._jit import njit, njit_inline, njit_lean
from physics.arrays import Array
from physics.assembly import assemble
from physics.contact.forces import Contacts, set_time, stand_at
from physics.motion import MotionModel, motion_model, outer_load
from physics.scene import Scene
from physics.statics.load_distribution import require_carried
from physics.statics.rest import LARGEST_MOVE, NO_EQUILIBRIUM, Hold, elastic, solve_at

# A shaft that moved by less than this share of its displacement is expected to move on as far.
NEARBY = 0.05
# Unbalanced force over the load at which a search ends; the stiffness is wrong by no more than about that share. From
# below the larger one Newton's method needs no safeguards, if the stiffness is regular.
EXACT, NEAR = 1e-11, 1e-2
MOST_STEPS = 4
REGULAR = 1e-6


def stiffness_trace(scene: Scene, time: Array, tolerance: float = EXACT) -> Array:
    """Stiffness (T, 3): kxx, kyy, kxy in N/m at the times (T,), s, each at its instant's load and angles.

    Zero where there is no load and no ball is pressed. The `stiffness` of `equilibrium`, in half the time where many
    instants follow closely. `tolerance` is the share of the load that may be left unbalanced. Raises SimulationFailed
    where no position carries the load.
    """
    time = np.ascontiguousarray(time, dtype=np.float64)
    stiffness, place = np.zeros((time.size, 3)), np.zeros((time.size, 2))
    require_carried(scene, time, _follow(assemble(scene), motion_model(scene), time, tolerance, place, stiffness))
    return stiffness


@njit_lean
def _follow(
    contacts: Contacts, motion: MotionModel, time: Array, tolerance: float, place: Array, stiffness: Array
) -> int:
    """Fill `stiffness` (T, 3) along the way of the shaft, `place` (T, 2), m; the first instant lost, see `rest_at`, or
    T."""
    lost = time.size
    for k in range(time.size):
        x, y = expected(place, k, 1)
        place[k, 0], place[k, 1], hold, carried = rest_at(contacts, motion, time[k], x, y, tolerance)
        stiffness[k, 0], stiffness[k, 1], stiffness[k, 2] = hold.xx, hold.yy, hold.xy
        lost = lost if carried else min(lost, k)
    return lost


@njit_inline
def rest_at(
    contacts: Contacts, motion: MotionModel, time: float, x: float, y: float, tolerance: float
) -> tuple[float, float, Hold, bool]:
    """Where the shaft rests (m, m) at `time` (s), looked for from the place (x, y) expected, and what holds there.

    Last whether a position carries the load; where none does, the instant is lost and the rest is that of the centre.
    """
    stand_at(contacts, time)
    load_x, load_y = outer_load(motion, time)
    return _settle(contacts, load_x, load_y, x, y, tolerance)


@njit_inline
def _settle(
    contacts: Contacts, load_x: float, load_y: float, x: float, y: float, tolerance: float
) -> tuple[float, float, Hold, bool]:
    """What `rest_at` tells, of the load (N, N).

    Where it is nearly there, few steps of Newton's method from there are its place, until less than `tolerance` of the
    load is unbalanced.
    """
    load = load_x * load_x + load_y * load_y
    hold = elastic(contacts, x, y)
    for _ in range(MOST_STEPS):
        gx, gy = load_x - hold.force_x, load_y - hold.force_y
        missing = gx * gx + gy * gy
        if missing <= tolerance**2 * load and load > 0.0 and x * x + y * y <= LARGEST_MOVE**2:
            return x, y, hold, True
        determinant = hold.xx * hold.yy - hold.xy * hold.xy
        if not (missing <= NEAR**2 * load and determinant > REGULAR * (hold.xx + hold.yy) ** 2):
            break
        x += (hold.yy * gx - hold.xy * gy) / determinant
        y += (hold.xx * gy - hold.xy * gx) / determinant
        hold = elastic(contacts, x, y)
    x, y, hold, status = solve_at(contacts, load_x, load_y, x, y)
    return x, y, hold, status != NO_EQUILIBRIUM


@njit_lean
def expected(place: Array, k: int, stride: int) -> tuple[float, float]:
    """Where the shaft (m, m) will be at instant `k`, going on as at the last three of `place` (T, 2 or more) a `stride`
    apart, unless it moved far."""
    if k < stride:
        return 0.0, 0.0
    x, y = place[k - stride, 0], place[k - stride, 1]
    if k < 2 * stride:
        return x, y
    before_x, before_y = place[k - 2 * stride, 0], place[k - 2 * stride, 1]
    if (x - before_x) ** 2 + (y - before_y) ** 2 >= NEARBY**2 * (x * x + y * y):
        return x, y
    if k < 3 * stride:
        return 2.0 * x - before_x, 2.0 * y - before_y
    return 3.0 * (x - before_x) + place[k - 3 * stride, 0], 3.0 * (y - before_y) + place[k - 3 * stride, 1]


def stiffness_at(scene: Scene, time: Array, displacement: Array) -> Array:
    """Stiffness (T, 3): kxx, kyy, kxy in N/m at the times (T,), s, where the inner ring has the `displacement` (T, 2),
    m, from the outer ring: that of the contacts in motion [P14 Eq. 26]."""
    return _stiffness_at(assemble(scene), time, np.ascontiguousarray(displacement))


@njit
def _stiffness_at(contacts: Contacts, time: Array, displacement: Array) -> Array:
    stiffness = np.zeros((time.size, 3))
    for k in range(time.size):
        set_time(contacts, time[k])
        hold = elastic(contacts, displacement[k, 0], displacement[k, 1])
        stiffness[k] = hold.xx, hold.yy, hold.xy
    return stiffness


def matrix(components: Array) -> Array:
    """Symmetric matrices (…, 2, 2) from components (…, 3) in the order xx, yy, xy."""
    xx, yy, xy = np.moveaxis(np.asarray(components), -1, 0)
    return np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)
