"""A step that is carried by the one before: exponential predictor and corrector of order 5 with two contact sums.

The force that the step before met at its beginning and in its middle foretells, with the force at the start, that in
the middle; these four foretell the end; and the polynomial through all five moves the modes (exponential multistep
methods: Hochbruck and Ostermann 2010, Acta Numerica 19, 209). The force met at the foretold end is kept as that of the
end: what the last correction would change of it is of the order of the step's own error.
"""

from __future__ import annotations

from physics._jit import njit_inline, njit_pasted
from physics.arrays import Array
from physics.contact.contact_set import count_changes
from physics.contact.forces import Contacts, move_to
from physics.integrators.modal.flow import LinearFlow, set_rest
from physics.integrators.modal.layout import AT_END, AT_HALF, END, HALF, KICKS, OTHER, TURN
from physics.integrators.modal.memory import BEFORE, Memory
from physics.integrators.modal.reading import free_motion, push, turn
from physics.integrators.modal.remainder import remainder_at


@njit_inline
def foretell(first: float, middle: float, force: float, ratio: float) -> tuple[float, float]:
    """The first two powers of the parabola through the `force` (N) at the start and those at the beginning and in the
    middle of the step before, `ratio` times as long."""
    early, late = (middle - first) * (2.0 / ratio), (force - middle) * (2.0 / ratio)
    bend = (late - early) * (1.0 / ratio)
    return late + 0.5 * ratio * bend, bend


@njit_inline
def through_middle(c0: float, c1: float, c2: float, middle: float, ratio: float) -> tuple[float, float, float]:
    """The first three powers when the course also meets the force `middle` (N) at half the step."""
    bend = (middle - (c0 + 0.5 * c1 + 0.25 * c2)) * (2.0 / ((0.5 + 0.5 * ratio) * (0.5 + ratio)))
    return c1 + 0.5 * ratio * ratio * bend, c2 + 1.5 * ratio * bend, bend


@njit_inline
def through_end(
    c0: float, c1: float, c2: float, c3: float, last: float, ratio: float
) -> tuple[float, float, float, float]:
    """The first four powers when the course also meets the force `last` (N) at the end of the step."""
    bend = (last - (c0 + c1 + c2 + c3)) * (2.0 / ((1.0 + 0.5 * ratio) * (1.0 + ratio)))
    return (
        c1 - 0.25 * ratio * ratio * bend,
        c2 + (0.5 * ratio - 0.75) * ratio * bend,
        c3 + (1.5 * ratio - 0.5) * bend,
        bend,
    )


@njit_pasted
def step_carried(
    contacts: Contacts,
    flow: LinearFlow,
    memory: Memory,
    row: int,
    time: float,
    step: float,
    start: Array,
    force: tuple[float, float],
    end: Array,
) -> tuple[int, tuple[float, float], tuple[float, float]]:
    """As `step_modal_rk4`, with the forces of the step before that the memory holds, and no note of the motion halfway.

    The force at the end is that of the foretold motion.
    """
    w, rest, past, course = memory.weights[row], memory.rest, memory.past, memory.course
    ratio = memory.clock[BEFORE] / step
    x0, y0 = force
    x1, x2 = foretell(past[0, 0], past[1, 0], x0, ratio)
    y1, y2 = foretell(past[0, 1], past[1, 1], y0, ratio)
    move_to(contacts, time + 0.5 * step)
    set_rest(flow, time + 0.5 * step, rest)
    x, y, u, v = free_motion(w, HALF, start, rest)
    a, b = AT_HALF, OTHER + AT_HALF
    x += w[a] * x0 + w[a + 2] * x1 + w[a + 4] * x2
    u += w[a + 1] * x0 + w[a + 3] * x1 + w[a + 5] * x2
    y += w[b] * y0 + w[b + 2] * y1 + w[b + 4] * y2
    v += w[b + 1] * y0 + w[b + 3] * y1 + w[b + 5] * y2
    middle = remainder_at(contacts, flow, (x, y, u, v))
    contradicted = count_changes(contacts)
    x1, x2, x3 = through_middle(x0, x1, x2, middle[0], ratio)
    y1, y2, y3 = through_middle(y0, y1, y2, middle[1], ratio)

    move_to(contacts, time + step)
    set_rest(flow, time + step, rest)
    x, y, u, v = free_motion(w, END, start, rest)
    a, b = AT_END, OTHER + AT_END
    x += w[a] * x0 + w[a + 2] * x1 + w[a + 4] * x2 + w[a + 6] * x3
    u += w[a + 1] * x0 + w[a + 3] * x1 + w[a + 5] * x2 + w[a + 7] * x3
    y += w[b] * y0 + w[b + 2] * y1 + w[b + 4] * y2 + w[b + 6] * y3
    v += w[b + 1] * y0 + w[b + 3] * y1 + w[b + 5] * y2 + w[b + 7] * y3
    last = remainder_at(contacts, flow, (x, y, u, v))
    course[0, 0], course[1, 0] = x0, y0
    course[0, 1], course[0, 2], course[0, 3], course[0, 4] = through_end(x0, x1, x2, x3, last[0], ratio)
    course[1, 1], course[1, 2], course[1, 3], course[1, 4] = through_end(y0, y1, y2, y3, last[1], ratio)
    turn(w, TURN, OTHER, start, end)
    push(w, KICKS, OTHER, course, end)
    return contradicted, middle, last
