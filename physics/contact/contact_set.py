"""Which balls are in contact: the set that forces are summed over, and how motion agrees with it.

Steps are made with the set frozen; whoever made one asks here whether a ball has changed sides since.
"""

from __future__ import annotations

from physics._jit import njit_inline, njit_inner
from physics.arrays import Array
from physics.contact.forces import ACTIVE, CLOSING, COMPRESSION, LAW, Contacts, law_force

# A mark is a polynomial in this number (the multiplier of D. Knuth's generator for MMIX) with coefficients of 0 and 1,
# cut to 52 bits, so that a float holds it exactly, with room to add to it. The number's powers up to the 2^50th differ
# in these bits.
MARK_BASE, MARK_BITS = 6364136223846793005, (1 << 52) - 1
# Rows of what is noted of the balls: compression (m), and its rate (m/s).
NOTED_COMPRESSION, NOTED_RATE = range(2)


@njit_inline
def touches(contacts: Contacts, cage: int, place: int) -> bool:
    """Whether the contact law says that a ball is in contact, from what `press` left."""
    balls = contacts.balls
    return balls[cage, COMPRESSION, place] > 0.0 and (not contacts.law.no_tension or balls[cage, LAW, place] > 0.0)


@njit_inline
def contradicts(contacts: Contacts, cage: int, place: int) -> bool:
    """Whether a ball's contact differs from the contact set, from what `press` left."""
    return touches(contacts, cage, place) != (contacts.balls[cage, ACTIVE, place] > 0.5)


@njit_inline
def count_changes(contacts: Contacts) -> int:
    """Number of balls whose contact differs from the contact set, from what `press` left."""
    balls, changed = contacts.balls, 0
    for cage in range(balls.shape[0]):
        if contacts.law.no_tension:
            for j in range(balls.shape[2]):
                held = min(balls[cage, COMPRESSION, j], balls[cage, LAW, j]) > 0.0
                changed += held != (balls[cage, ACTIVE, j] > 0.5)
        else:
            for j in range(balls.shape[2]):
                changed += (balls[cage, COMPRESSION, j] > 0.0) != (balls[cage, ACTIVE, j] > 0.5)
    return changed


@njit_inline
def mark_of(balls: Array, quantity: int) -> float:
    """A whole number below 2^52 that tells apart which balls have this `quantity` above zero.

    Two sets that differ in one or two balls never have the same one, others by a chance of 1 in 2^52.
    """
    mark = 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            mark = mark * MARK_BASE + (1 if balls[cage, quantity, j] > 0.0 else 0)
    return float(mark & MARK_BITS)


@njit_inline
def count_ahead(balls: Array, ahead: float) -> int:
    """Number of balls that would contradict the contact set `ahead` s later if they went on at their present rate."""
    changing = 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            later = balls[cage, COMPRESSION, j] + ahead * balls[cage, CLOSING, j]
            changing += (later > 0.0) != (balls[cage, ACTIVE, j] > 0.5)
    return changing


@njit_inline
def note_motion(balls: Array, noted: Array) -> None:
    """Keep in `noted` (G, 2, M) the compression (m) and its rate (m/s) of every ball."""
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            noted[cage, NOTED_COMPRESSION, j] = balls[cage, COMPRESSION, j]
            noted[cage, NOTED_RATE, j] = balls[cage, CLOSING, j]


@njit_inline
def restore_motion(balls: Array, noted: Array) -> None:
    """Bring back what `note_motion` kept in `noted` (G, 2, M)."""
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            balls[cage, COMPRESSION, j] = noted[cage, NOTED_COMPRESSION, j]
            balls[cage, CLOSING, j] = noted[cage, NOTED_RATE, j]


@njit_inline
def count_dips(balls: Array, noted: Array, step: float) -> int:
    """Number of balls that agree with the contact set now and `step` s ago, as `noted`, but seem not to in between.

    Between, compression is taken for a parabola with the rates of both ends: it turns where its rate is zero.
    """
    dips = 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            side = 2.0 * balls[cage, ACTIVE, j] - 1.0
            away, back = side * noted[cage, NOTED_RATE, j], side * balls[cage, CLOSING, j]
            room = side * (noted[cage, NOTED_COMPRESSION, j] + balls[cage, COMPRESSION, j]) * (back - away)
            dips += (away < 0.0) & (back > 0.0) & (room < 0.5 * step * (away * away + back * back))
    return dips


@njit_inline
def count_brushes(balls: Array, noted: Array) -> int:
    """Number of free balls that were not compressed when `noted`, are now, and are not pressed.

    Without tension they have touched meanwhile and were let go of: where a ball meets the race its compression grows,
    which presses it.
    """
    brushes = 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            came = (noted[cage, NOTED_COMPRESSION, j] < 0.0) & (balls[cage, COMPRESSION, j] > 0.0)
            brushes += came & (balls[cage, ACTIVE, j] < 0.5) & (balls[cage, LAW, j] <= 0.0)
    return brushes


@njit_inline
def count_lapses(contacts: Contacts, noted: Array, step: float) -> int:
    """Number of balls that are pressed now and `step` s ago, as `noted`, but seem to have been let go of in between.

    Without tension the film lets go of a ball that is still compressed, if that unloads fast enough. Between, its force
    is taken for a parabola, and its compression halfway for that of the cubic with the rates of both ends.
    """
    balls, law, lapses = contacts.balls, contacts.law, 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            start, rate = noted[cage, NOTED_COMPRESSION, j], noted[cage, NOTED_RATE, j]
            end, end_rate = balls[cage, COMPRESSION, j], balls[cage, CLOSING, j]
            if balls[cage, ACTIVE, j] > 0.5 and min(rate, end_rate) < 0.0 and min(start, end) > 0.0:
                halfway = 0.5 * (start + end) + 0.125 * step * (rate - end_rate)
                halfway_rate = 1.5 * (end - start) / step - 0.25 * (rate + end_rate)
                first, middle = law_force(law, start, rate), law_force(law, halfway, halfway_rate)
                last = balls[cage, LAW, j]
                bend, slope = 2.0 * (first - 2.0 * middle + last), 4.0 * middle - 3.0 * first - last
                turns_inside = (slope < 0.0) & (slope + 2.0 * bend > 0.0)
                lapses += (first > 0.0) & (last > 0.0) & turns_inside & (slope * slope > 4.0 * first * bend)
    return lapses


@njit_inner
def reset_contact(contacts: Contacts) -> None:
    """Make the contact set what the compressions left by `press` say."""
    balls = contacts.balls
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            balls[cage, ACTIVE, j] = 1.0 if touches(contacts, cage, j) else 0.0
