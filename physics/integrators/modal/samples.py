"""What a march on the modes writes: samples at the ends of steps, samples inside strides, and what else is wanted."""

from __future__ import annotations

from physics._jit import njit_inline, njit_inner, njit_pasted
from physics.arrays import Array
from physics.contact.forces import FORCE, Contacts, of_ball, set_time
from physics.contact.turning import cosine_sine
from physics.integrators.modal.choice import Choice
from physics.integrators.modal.flow import (
    OUTER,
    OUTER_ACCELERATION,
    OUTER_SPEED,
    OUTPUT,
    PER_AXIS,
    LinearFlow,
    physical_state,
    reading,
    set_rest,
    weigh,
)
from physics.integrators.modal.layout import INSIDE_KICKS, INSIDE_OTHER, INSIDE_READINGS, INSIDE_TURN
from physics.integrators.modal.memory import FIRST_INSIDE, PASSED, UNITS, Memory, ModalGrid
from physics.integrators.modal.reading import push, read_inside, turn
from physics.integrators.modal.remainder import remaining_force
from physics.integrators.output import Output
from physics.integrators.trial import Trial


@njit_inline
def keep(
    balls: Array,
    flow: LinearFlow,
    rest: Array,
    time: float,
    state: Array,
    force: tuple[float, float],
    sample: int,
    output: Output,
) -> None:
    """Write what else is wanted of one sample: the outer ring's motion, the state, the balls' forces."""
    if output.outer.shape[0] > 0:
        keep_outer(flow.read, flow.outer_mass, rest, state, force, sample, output.outer)
    if keeps_state(output):
        keep_state(balls, flow, time, state, sample, output)


@njit_inline
def keeps_state(output: Output) -> bool:
    """Whether states or forces of the balls are wanted."""
    return output.state.shape[0] + output.force.shape[0] > 0


@njit_inner
def keep_outer(
    read: Array,
    outer_mass: float,
    rest: Array,
    state: Array,
    force: tuple[float, float],
    sample: int,
    outer: Array,
) -> None:
    """Write the outer ring's motion of one sample into `outer` (3, T, 2), from the amplitudes `state` (12,) by what the
    flow `read`s (11, 12), the loads' `rest` (2, 11) and the contact `force` (N).

    Given single arrays: each that is handed over costs about as much as its work.
    """
    for axis in range(2):
        outer[0, sample, axis] = weigh(read[OUTER], axis * PER_AXIS, state, axis) + rest[axis, OUTER]
        outer[1, sample, axis] = weigh(read[OUTER_SPEED], axis * PER_AXIS, state, axis) + rest[axis, OUTER_SPEED]
        rate = weigh(read[OUTER_ACCELERATION], axis * PER_AXIS, state, axis) + force[axis] / outer_mass
        outer[2, sample, axis] = rate + rest[axis, OUTER_ACCELERATION]


@njit_inner
def keep_state(balls: Array, flow: LinearFlow, time: float, state: Array, sample: int, output: Output) -> None:
    """Write the state and the balls' forces of one sample, if they are wanted."""
    if output.state.shape[0] > 0:
        physical_state(flow, time, state, output.state[sample])
    if output.force.shape[0] > 0:
        for ball in range(output.force.shape[1]):
            output.force[sample, ball] = of_ball(balls, FORCE, ball)


@njit_inner
def keep_outer_inside(
    inside: Array,
    start: Array,
    course: Array,
    loads: tuple[Array, Array, Array],
    turns: tuple[float, float],
    sample: int,
    outer: Array,
) -> None:
    """Write the outer ring's motion at the samples inside a stride into `outer` (3, T, 2), from their weights (S, 172)
    and the `course` (2, 5) of the contact force alone, as `write_inside` does the resonator's acceleration.

    The stride begins with the amplitudes `start` (12,) behind `sample`; `loads` (2, 11) are the flow's, constant and
    turning with the shaft, which has turned by the first of `turns` (rad) then and by the second from sample to sample.
    """
    still, along, across = loads
    cosine, sine = 0.0, 0.0
    for k in range(inside.shape[0]):
        if turns[1] != 0.0:
            cosine, sine = cosine_sine(turns[0] + (k + 1) * turns[1])
        for section in range(1, len(INSIDE_READINGS)):
            row = INSIDE_READINGS[section]
            for axis in range(2):
                value = still[axis, row] + cosine * along[axis, row] + sine * across[axis, row]
                value += read_inside(inside[k], section, axis, start, course)
                outer[section - 1, sample + 1 + k, axis] = value


@njit_inline
def keep_state_inside(
    contacts: Contacts,
    flow: LinearFlow,
    grid: ModalGrid,
    memory: Memory,
    choice: Choice,
    trial: Trial,
    output: Output,
) -> None:
    """Write state and forces of the samples inside the stride that was taken as tried.

    Leaves `contacts` and the memory's `rest` at the end of the stride.
    """
    between, rest = memory.between, memory.rest
    first, count = FIRST_INSIDE[choice.row - UNITS - 1], choice.units // UNITS
    for k in range(count - 1):
        w, time = memory.inside[first + k], trial.time + (k + 1) * grid.interval
        turn(w, INSIDE_TURN, INSIDE_OTHER, trial.now, between)
        push(w, INSIDE_KICKS, INSIDE_OTHER, memory.course, between)
        set_rest(flow, time, rest)
        if output.force.shape[0] > 0:
            set_time(contacts, time)
            remaining_force(contacts, flow, between, rest)
        keep_state(contacts.balls, flow, time, between, memory.marks[PASSED] // UNITS + 1 + k, output)
    set_rest(flow, trial.time + count * grid.interval, rest)
    set_time(contacts, trial.time + count * grid.interval)
    remaining_force(contacts, flow, trial.then, rest)


@njit_inline
def record(flow: LinearFlow, state: Array, rest: Array, sample: int, output: Output) -> float:
    """Write one sample; the square of the resonator's acceleration, m²/s⁴."""
    x = reading(flow, OUTPUT, state, 0) + rest[0, OUTPUT]
    y = reading(flow, OUTPUT, state, 1) + rest[1, OUTPUT]
    output.acceleration[sample, 0] = x
    output.acceleration[sample, 1] = y
    return x * x + y * y


@njit_pasted
def write_inside(
    contacts: Contacts,
    flow: LinearFlow,
    grid: ModalGrid,
    memory: Memory,
    choice: Choice,
    trial: Trial,
    output: Output,
) -> None:
    """Write the samples inside the stride that was taken as tried, from the memory's clock on.

    The memory's `rest` is of its end, and its `course` the contact force.
    """
    rest, course, sample = memory.rest, memory.course, memory.marks[PASSED] // UNITS
    first, count = FIRST_INSIDE[choice.row - UNITS - 1], choice.units // UNITS
    for k in range(count - 1):
        w = memory.inside[first + k]
        x, y = rest[0, OUTPUT], rest[1, OUTPUT]
        if flow.turning:
            cosine, sine = cosine_sine(flow.shaft_speed * (trial.time + (k + 1) * grid.interval))
            x = flow.rest[0, OUTPUT] + cosine * flow.cosine[0, OUTPUT] + sine * flow.sine[0, OUTPUT]
            y = flow.rest[1, OUTPUT] + cosine * flow.cosine[1, OUTPUT] + sine * flow.sine[1, OUTPUT]
        output.acceleration[sample + 1 + k, 0] = x + read_inside(w, 0, 0, trial.now, course)
        output.acceleration[sample + 1 + k, 1] = y + read_inside(w, 0, 1, trial.now, course)
    if output.outer.shape[0] > 0:
        turns = (flow.shaft_speed * trial.time, flow.shaft_speed * grid.interval) if flow.turning else (0.0, 0.0)
        weights, loads = memory.inside[first : first + count - 1], (flow.rest, flow.cosine, flow.sine)
        keep_outer_inside(weights, trial.now, course, loads, turns, sample, output.outer)
    if keeps_state(output):
        keep_state_inside(contacts, flow, grid, memory, choice, trial, output)
