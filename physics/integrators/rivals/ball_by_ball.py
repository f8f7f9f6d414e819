"""The equations of motion in one flat loop over the balls, as a careful user would write them [P14 Eq. 4-16]."""

from __future__ import annotations

import math

import numpy as np

from physics._jit import njit
from physics.arrays import Array
from physics.integrators.reference.equations import (
    AHEAD,
    AMPLITUDE,
    ANGLE,
    BALL_ROW,
    DEVIATION,
    FIRST,
    LAST,
    ORDER,
    PHASE,
    SIGN,
    SPALL_ROW,
    SPALL_SPEED,
    WAVE_SPEED,
    Equations,
    polynomial_at,
)


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
    cos_alpha, push_x, push_y = law.cosine_of_contact_angle, 0.0, 0.0
    for ball in range(balls.shape[0]):
        row = int(balls[ball, BALL_ROW])
        angle, speed = angles[row] + balls[ball, AHEAD], speeds[row]
        c, s = math.cos(angle), math.sin(angle)
        depth, rate = law.clearance - balls[ball, DEVIATION], 0.0
        for k in range(spalls.shape[0]):
            if spalls[k, SPALL_ROW] == row:
                arc = spalls[k, SIGN] * (angle - spalls[k, ANGLE] - spalls[k, SPALL_SPEED] * time)
                arc -= 2.0 * math.pi * math.floor(arc / (2.0 * math.pi) + 0.5)
                first, last = int(spalls[k, FIRST]), int(spalls[k, LAST])
                if edges[first] <= arc <= edges[last - 1]:
                    drop, slope = polynomial_at(edges, cubics, first, last, arc)
                    depth += drop
                    rate += slope * spalls[k, SIGN] * (speed - spalls[k, SPALL_SPEED])
        for k in range(waves.shape[0]):
            phase = waves[k, ORDER] * (angle - waves[k, WAVE_SPEED] * time) + waves[k, PHASE]
            depth += waves[k, AMPLITUDE] * math.cos(phase)
            rate -= waves[k, AMPLITUDE] * waves[k, ORDER] * math.sin(phase) * (speed - waves[k, WAVE_SPEED])
        compression = cos_alpha * (dx * c + dy * s - depth)
        if compression > 0.0:
            closing = cos_alpha * (vx * c + vy * s + speed * (dy * c - dx * s) - rate)
            force = cos_alpha * (law.hertz_factor * compression**law.exponent + law.film_damping * closing)
            if force > 0.0 or not law.no_tension:
                push_x += force * c
                push_y += force * s
    return _accelerated(equations, push_x, push_y, time, state)


@njit
def _accelerated(equations: Equations, push_x: float, push_y: float, time: float, state: Array) -> Array:
    """Time derivative (12,) of the state; not that of `equations`, so that no change there slows the rival."""
    loads, axes = equations.loads, equations.axes
    turned = loads.shaft_speed * time
    result = np.empty(12)
    for axis in range(2):
        push = push_x if axis == 0 else push_y
        phase = turned + loads.unbalance_phase
        load = loads.unbalance * (math.cos(phase) if axis == 0 else math.sin(phase))
        if axis == 1:
            load -= loads.static * (1.0 + loads.fluctuation * math.cos(turned + loads.fluctuation_phase))
        link = axes[5, axis] * (state[2 + axis] - state[4 + axis]) + axes[6, axis] * (
            state[8 + axis] - state[10 + axis]
        )
        support = axes[3, axis] * state[2 + axis] + axes[4, axis] * state[8 + axis]
        result[6 + axis] = (load - push) / axes[0, axis]
        result[8 + axis] = (push - support - link) / axes[1, axis]
        result[10 + axis] = link / axes[2, axis]
    result[:6] = state[6:]
    return result
