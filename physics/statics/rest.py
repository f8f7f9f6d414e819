"""Where the shaft rests at one instant: safeguarded Newton's method on the energy of contacts and load.

The elastic energy of the contacts minus the work of the load is a convex function of the shaft's position, so Newton's
method with a line search finds the equilibrium from anywhere; where the stiffness is singular the answer says so.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from physics._jit import njit_inline, njit_inner
from physics.contact.forces import (
    COMPRESSION,
    COSINE,
    FLOOR,
    FORCE,
    FRAME_COSINE,
    FRAME_SINE,
    SINE,
    Contacts,
    Law,
    law_power,
)

LOADED, NOT_UNIQUE, NOT_LOADED, NO_EQUILIBRIUM = 0, 1, 2, 3

# Unbalanced force over the load at which a search ends, and up to which what it ended with is an equilibrium; the
# stiffness is wrong by no more than about that share.
EXACT, ACCEPTABLE = 1e-11, 1e-7
# The stiffness is singular if its determinant is below this share of its trace squared.
SINGULAR = 1e-9
# Without a load, balls compressed by less than this (m) are free.
NEGLIGIBLE_COMPRESSION = 1e-13
# No bearing carries its load at a displacement beyond this (m): the search has left it through a gap.
LARGEST_MOVE = 0.05
MOST_ITERATIONS = 200
MOST_SHORTENINGS = 40
# Beside the load, this share of what the balls press with counts where an unbalanced force is called small.
PRESSED_SHARE = 1e-3
# A step is no longer than so many typical compressions, and half the displacement.
LONGEST_STEP = 20.0
# The energy has to fall by this share of what its slope foretells (Armijo's rule), give or take its relative rounding.
SUFFICIENT_FALL, ENERGY_ROUNDING = 1e-4, 1e-14
# A step that does not make it fall so far is shortened to between these shares of its length.
SHORTEST_AGAIN, LONGEST_AGAIN = 0.01, 0.9


class ElasticSums(NamedTuple):
    """What the springs of all contacts add up to at one position of the shaft [P14 Eq. 22, 26].

    Elastic `energy` (J), net force on the outer ring (N), `pressed`: sum of the ball loads (N), stiffness (N/m).
    """

    energy: float
    force_x: float
    force_y: float
    pressed: float
    xx: float
    yy: float
    xy: float


@njit_inline
def elastic(contacts: Contacts, dx: float, dy: float) -> ElasticSums:
    """What the contacts hold without damping at the displacement (dx, dy), m.

    `set_time` must have been called; leaves compression and elastic force of every ball in `contacts.balls`.
    """
    balls, frames, law = contacts.balls, contacts.frames, contacts.law
    energy, force_x, force_y, pressed, xx, yy, xy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    n = law.exponent
    for cage in range(balls.shape[0]):
        cosine, sine = frames[cage, FRAME_COSINE], frames[cage, FRAME_SINE]
        p, q = dx * cosine + dy * sine, dy * cosine - dx * sine
        for j in range(balls.shape[2]):
            balls[cage, COMPRESSION, j] = p * balls[cage, COSINE, j] + q * balls[cage, SINE, j] - balls[cage, FLOOR, j]
            balls[cage, FORCE, j] = 0.0
        # Sums in the frame of the cage, turned back afterwards.
        along, across, both_along, both_across, mixed = 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(balls.shape[2]):
            compression = balls[cage, COMPRESSION, j]
            if compression > 0.0:
                c, s = balls[cage, COSINE, j], balls[cage, SINE, j]
                secant = law.stiffness * law_power(law, compression)
                force = secant * compression
                balls[cage, FORCE, j] = force
                energy += force * compression / (n + 1.0)
                along += force * c
                across += force * s
                pressed += force
                both_along += n * secant * c * c
                both_across += n * secant * s * s
                mixed += n * secant * c * s
        force_x += along * cosine - across * sine
        force_y += along * sine + across * cosine
        twice = 2.0 * mixed * cosine * sine
        xx += both_along * cosine * cosine - twice + both_across * sine * sine
        yy += both_along * sine * sine + twice + both_across * cosine * cosine
        xy += (both_along - both_across) * cosine * sine + mixed * (cosine * cosine - sine * sine)
    return ElasticSums(energy, force_x, force_y, pressed, xx, yy, xy)


@njit_inner
def solve_at(
    contacts: Contacts, load_x: float, load_y: float, dx: float, dy: float
) -> tuple[float, float, ElasticSums, int]:
    """Equilibrium position (m, m) under the load (N, N) from the guess (dx, dy), what holds there, and the status.

    Safeguarded Newton: a regularised step where the stiffness is singular, shortened until the energy falls.
    """
    law, load = contacts.law, math.hypot(load_x, load_y)
    if load == 0.0:
        dx, dy = 0.0, 0.0
    sums = elastic(contacts, dx, dy)
    for _ in range(MOST_ITERATIONS):
        gx, gy = load_x - sums.force_x, load_y - sums.force_y
        if _ends(sums, law, load, gx, gy, EXACT):
            break
        step_x, step_y = _newton_step(sums, law, load, gx, gy, 0.5 * math.hypot(dx, dy))
        x, y, sums = _descend(contacts, load_x, load_y, dx, dy, step_x, step_y, sums)
        stuck = math.hypot(x - dx, y - dy) <= 1e-15 * math.hypot(x, y)
        dx, dy = x, y
        if stuck or math.hypot(dx, dy) > LARGEST_MOVE:
            break
    status = _status(sums, law, load, load_x - sums.force_x, load_y - sums.force_y)
    status = NO_EQUILIBRIUM if math.hypot(dx, dy) > LARGEST_MOVE else status
    if status in (NO_EQUILIBRIUM, NOT_LOADED):
        dx, dy = 0.0, 0.0
        sums = elastic(contacts, dx, dy)
    return dx, dy, sums, status


@njit_inner
def _ends(sums: ElasticSums, law: Law, load: float, gx: float, gy: float, share: float) -> bool:
    """Whether the unbalanced force (gx, gy) is a small `share` of the load, or there is no load and no ball pressed."""
    # Under preload the balls press each other harder than the load, and rounding grows with that.
    return _is_free(sums, law, load) or math.hypot(gx, gy) <= share * (load + PRESSED_SHARE * sums.pressed)


@njit_inner
def _is_free(sums: ElasticSums, law: Law, load: float) -> bool:
    return load == 0.0 and sums.pressed <= law.stiffness * NEGLIGIBLE_COMPRESSION**law.exponent


@njit_inner
def _status(sums: ElasticSums, law: Law, load: float, gx: float, gy: float) -> int:
    if not _ends(sums, law, load, gx, gy, ACCEPTABLE):
        return NO_EQUILIBRIUM
    if _is_free(sums, law, load):
        return NOT_LOADED
    return NOT_UNIQUE if _singular(sums) else LOADED


@njit_inner
def _newton_step(
    sums: ElasticSums, law: Law, load: float, gx: float, gy: float, least_room: float
) -> tuple[float, float]:
    """Step (m, m) against the unbalanced force; softened where the stiffness is singular, and never very long."""
    force = max(load, sums.pressed)
    typical = (force / law.stiffness) ** (1.0 / law.exponent)
    extra = SINGULAR * max(sums.xx + sums.yy, force / typical) if _singular(sums) else 0.0
    xx, yy = sums.xx + extra, sums.yy + extra
    determinant = xx * yy - sums.xy * sums.xy
    x, y = (yy * gx - sums.xy * gy) / determinant, (xx * gy - sums.xy * gx) / determinant
    share = min(1.0, (LONGEST_STEP * typical + least_room) / math.hypot(x, y))
    return share * x, share * y


@njit_inner
def _descend(
    contacts: Contacts,
    load_x: float,
    load_y: float,
    dx: float,
    dy: float,
    step_x: float,
    step_y: float,
    sums: ElasticSums,
) -> tuple[float, float, ElasticSums]:
    """The position (m, m) along the step at which the energy has fallen enough, and what holds there."""
    objective = sums.energy - load_x * dx - load_y * dy
    descent = (load_x - sums.force_x) * step_x + (load_y - sums.force_y) * step_y
    share = 1.0
    for _ in range(MOST_SHORTENINGS):
        x, y = dx + share * step_x, dy + share * step_y
        sums = elastic(contacts, x, y)
        enough = objective - SUFFICIENT_FALL * share * descent + ENERGY_ROUNDING * abs(objective)
        if sums.energy - load_x * x - load_y * y <= enough:
            break
        # Past the lowest point along the step: the slope of the energy there and its stiffness say how far.
        slope = (sums.force_x - load_x) * step_x + (sums.force_y - load_y) * step_y
        bend = sums.xx * step_x * step_x + 2.0 * sums.xy * step_x * step_y + sums.yy * step_y * step_y
        if bend > 0.0:
            share = min(max(share - slope / bend, SHORTEST_AGAIN * share), LONGEST_AGAIN * share)
        else:
            share *= 0.5
    return x, y, sums


@njit_inner
def _singular(sums: ElasticSums) -> bool:
    return sums.xx * sums.yy - sums.xy * sums.xy <= SINGULAR * (sums.xx + sums.yy) ** 2
