"""The equations of motion in one flat loop over the balls, as a careful user would write them [P14 Eq. 4-16]."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit
from physics.integrators.reference.equations import Equations, polynomial_at

Array = NDArray[np.float64]


@njit
def ball_by_ball_slopes(equations: Equations, time: float, state: Array) -> Array:
    """Time derivative (12,) of the state, a sine and a cosine a ball; a ball touches if it is compressed now."""
    law, balls, spalls, waves = equations.law, equations.balls, equations.spalls, equations.waves
    edges, cubics = equations.path
    cage_edges, cage_pieces = equations.cages[0]
    angles, speeds = np.empty(2), np.empty(2)
    angles[0], speeds[0] = polynomial_at(cage_edges, cage_pieces, 0, cage_edges.size, time)
    cage_edges, cage_pieces = equations.cages[1]
    angles[1], speeds[1] = polynomial_at(cage_edges, cage_pieces, 0, cage_edges.size, time)
    dx, dy, vx, vy = state[0] - state[2], state[1] - state[3], state[6] - state[8], state[7] - state[9]
    push_x, push_y = 0.0, 0.0
    for ball in range(balls.shape[0]):
        row = int(balls[ball, 0])
        angle, speed = angles[row] + balls[ball, 1], speeds[row]
        c, s = math.cos(angle), math.sin(angle)
        depth, rate = law[4] - balls[ball, 2], 0.0
        for k in range(spalls.shape[0]):
            if spalls[k, 0] == row:
                arc = spalls[k, 2] * (angle - spalls[k, 1] - spalls[k, 3] * time)
                arc -= 2.0 * math.pi * math.floor(arc / (2.0 * math.pi) + 0.5)
                first, last = int(spalls[k, 4]), int(spalls[k, 5])
                if edges[first] <= arc <= edges[last - 1]:
                    drop, slope = polynomial_at(edges, cubics, first, last, arc)
                    depth += drop
                    rate += slope * spalls[k, 2] * (speed - spalls[k, 3])
        for k in range(waves.shape[0]):
            phase = waves[k, 0] * (angle - waves[k, 3] * time) + waves[k, 2]
            depth += waves[k, 1] * math.cos(phase)
            rate -= waves[k, 1] * waves[k, 0] * math.sin(phase) * (speed - waves[k, 3])
        compression = law[3] * (dx * c + dy * s - depth)
        if compression > 0.0:
            closing = law[3] * (vx * c + vy * s + speed * (dy * c - dx * s) - rate)
            force = law[3] * (law[0] * compression ** law[1] + law[2] * closing)
            if law[5] == 0.0 or force > 0.0:
                push_x += force * c
                push_y += force * s
    return _accelerated(equations, push_x, push_y, time, state)


@njit
def _accelerated(equations: Equations, push_x: float, push_y: float, time: float, state: Array) -> Array:
    loads, axes = equations.loads, equations.axes
    phase = equations.law[6] * time
    result = np.empty(12)
    for axis in range(2):
        push = push_x if axis == 0 else push_y
        load = loads[1] * (math.cos(phase + loads[2]) if axis == 0 else math.sin(phase + loads[2]))
        if axis == 1:
            load -= loads[0] * (1.0 + loads[3] * math.cos(phase + loads[4]))
        link = axes[5, axis] * (state[2 + axis] - state[4 + axis]) + axes[6, axis] * (
            state[8 + axis] - state[10 + axis]
        )
        support = axes[3, axis] * state[2 + axis] + axes[4, axis] * state[8 + axis]
        result[6 + axis] = (load - push) / axes[0, axis]
        result[8 + axis] = (push - support - link) / axes[1, axis]
        result[10 + axis] = link / axes[2, axis]
    result[:6] = state[6:]
    return result
