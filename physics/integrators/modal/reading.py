"""Reading the weights of a step: the free turn of amplitudes, what the contact force adds to them and to the motion."""

from __future__ import annotations

from physics._jit import njit_inline
from physics.arrays import Array
from physics.integrators.modal.flow import DISPLACEMENT, PAIRS, PER_AXIS, VELOCITY, Motion, weigh
from physics.integrators.modal.layout import (
    INSIDE_OTHER,
    MOTION_READINGS,
    OTHER,
    POWERS,
    POWERS_AT,
    SECTION,
    TURN_NUMBERS,
)


@njit_inline
def turn(weights: Array, first: int, stride: int, start: Array, end: Array) -> None:
    """Put into `end` (12,) the amplitudes `start` after the free turn from `first` on, along y `stride` further."""
    for axis in range(2):
        for pair in range(PAIRS):
            place, part = axis * stride + first + TURN_NUMBERS * pair, axis * PER_AXIS + 2 * pair
            a, b = start[part], start[part + 1]
            end[part] = weights[place] * a + weights[place + 1] * b
            end[part + 1] = weights[place + 2] * a + weights[place + 3] * b


@njit_inline
def push(weights: Array, first: int, stride: int, course: Array, end: Array) -> None:
    """Add to `end` (12,) what the contact force of `course` (2, 5) does, by the kicks from `first` on."""
    for axis in range(2):
        kicks = axis * stride + first
        c0, c1, c2, c3, c4 = course[axis, 0], course[axis, 1], course[axis, 2], course[axis, 3], course[axis, 4]
        for part in range(PER_AXIS):
            place = kicks + POWERS * part
            end[axis * PER_AXIS + part] += (
                (weights[place] * c0 + weights[place + 1] * c1)
                + (weights[place + 2] * c2 + weights[place + 3] * c3)
                + weights[place + 4] * c4
            )


@njit_inline
def read_inside(weights: Array, section: int, axis: int, start: Array, course: Array) -> float:
    """What a sample inside a step reads along one axis, but for the loads, from the amplitudes `start` (12,) and the
    `course` (2, 5) of the contact force."""
    first, part = axis * INSIDE_OTHER + SECTION * section, axis * PER_AXIS
    kick = first + POWERS_AT
    c0, c1, c2, c3, c4 = course[axis, 0], course[axis, 1], course[axis, 2], course[axis, 3], course[axis, 4]
    # In pairs, so that fewer operations wait for each other than in a chain.
    one = weights[first] * start[part] + weights[first + 1] * start[part + 1]
    two = weights[first + 2] * start[part + 2] + weights[first + 3] * start[part + 3]
    three = weights[first + 4] * start[part + 4] + weights[first + 5] * start[part + 5]
    pushed = (weights[kick] * c0 + weights[kick + 1] * c1) + (weights[kick + 2] * c2 + weights[kick + 3] * c3)
    return ((one + two) + three) + (pushed + weights[kick + 4] * c4)


@njit_inline
def free_motion(weights: Array, first: int, start: Array, rest: Array) -> Motion:
    """Relative motion without contact force, by the shares from `first` on."""
    return (
        rest[0, DISPLACEMENT] + weigh(weights, first, start, 0),
        rest[1, DISPLACEMENT] + weigh(weights, OTHER + first, start, 1),
        rest[0, VELOCITY] + weigh(weights, first + PER_AXIS, start, 0),
        rest[1, VELOCITY] + weigh(weights, OTHER + first + PER_AXIS, start, 1),
    )


@njit_inline
def pushed(weights: Array, first: int, power: int, motion: Motion, force: tuple[float, float]) -> Motion:
    """Relative `motion` with what a `force` (N, N) times one power of the share of the step adds, by the weights from
    `first` on."""
    along_x, along_y = first + MOTION_READINGS * power, OTHER + first + MOTION_READINGS * power
    return (
        motion[0] + weights[along_x] * force[0],
        motion[1] + weights[along_y] * force[1],
        motion[2] + weights[along_x + 1] * force[0],
        motion[3] + weights[along_y + 1] * force[1],
    )
