"""How long balls touch, and how long the oil film pulls them, summed up step by step."""

from __future__ import annotations

from physics._jit import njit_inner, njit_pasted
from physics.arrays import Array
from physics.contact.contact_set import NOTED_COMPRESSION, NOTED_RATE
from physics.contact.forces import ACTIVE, CLOSING, COMPRESSION, FORCE, Contacts, Law, law_force
from physics.integrators.modal.memory import PULLING, Memory
from physics.integrators.output import PULLED, TOUCHED, Output

# The instant at which a force changes its sign is found to 2^-12 of a step.
HALVINGS = 12


@njit_pasted
def add_contact_time(contacts: Contacts, memory: Memory, step: float, output: Output) -> None:
    """Add a `step` (s), at whose end `press` has left the `contacts`, to the time in contact and in tension."""
    balls, law, touching, pulling = contacts.balls, contacts.law, 0, 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            touching += balls[cage, ACTIVE, j] > 0.5
            pulling += balls[cage, FORCE, j] < 0.0
    output.touched[TOUCHED] += touching * step
    if not law.no_tension and pulling + memory.marks[PULLING] > 0:
        output.touched[PULLED] += step * pulled_share(balls, law, memory.noted, step)
    memory.marks[PULLING] = pulling


@njit_inner
def pulled_share(balls: Array, law: Law, noted: Array, step: float) -> float:
    """Share of a `step` (s) in which balls pull, added up over them; `noted` (G, 2, M) is their motion at its start."""
    total = 0.0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            if balls[cage, ACTIVE, j] < 0.5:
                continue
            first, first_rate = noted[cage, NOTED_COMPRESSION, j], noted[cage, NOTED_RATE, j]
            starts = law_force(law, first, first_rate) < 0.0
            ends = balls[cage, FORCE, j] < 0.0
            if starts and ends:
                total += 1.0
            elif starts or ends:
                last, last_rate = balls[cage, COMPRESSION, j], balls[cage, CLOSING, j]
                turn = sign_change(law, step, first, first_rate, last, last_rate, starts)
                total += turn if starts else 1.0 - turn
    return total


@njit_inner
def sign_change(
    law: Law, step: float, first: float, first_rate: float, last: float, last_rate: float, starts: bool
) -> float:
    """Share of a `step` (s) after which the force on a ball changes its sign; `starts`: it pulls until then.

    Compression runs as the cubic between its values (m) and rates (m/s) at both ends.
    """
    rise, begin, end = last - first, step * first_rate, step * last_rate
    square, cube = 3.0 * rise - 2.0 * begin - end, begin + end - 2.0 * rise
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        share = 0.5 * (low + high)
        compression = first + share * (begin + share * (square + share * cube))
        rate = (begin + share * (2.0 * square + share * 3.0 * cube)) / step
        if (law_force(law, compression, rate) < 0.0) == starts:
            low = share
        else:
            high = share
    return 0.5 * (low + high)
