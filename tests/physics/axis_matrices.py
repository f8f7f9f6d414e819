"""The linear part of a rig along one axis, as a matrix, and a rig whose modes creep back."""

import dataclasses
import math

import numpy as np

STIFFNESS, DAMPING = (60e6, 95e6), (300.0, 500.0)


def matrix(rig, axis, k=None, c=None):
    """(6, 6) of one axis, written down from the equations of motion with a spring and a damper for the balls."""
    k, c = STIFFNESS[axis] if k is None else k, DAMPING[axis] if c is None else c
    ko, co = (rig.support_stiffness_x, rig.support_damping_x) if axis == 0 else (
        rig.support_stiffness_y, rig.support_damping_y
    )  # fmt: skip
    stiff = np.array([[k, -k, 0], [-k, k + ko + rig.resonator_stiffness, -rig.resonator_stiffness],
                      [0, -rig.resonator_stiffness, rig.resonator_stiffness]])  # fmt: skip
    damp = np.array([[c, -c, 0], [-c, c + co + rig.resonator_damping, -rig.resonator_damping],
                     [0, -rig.resonator_damping, rig.resonator_damping]])  # fmt: skip
    mass = np.array([rig.inner_mass, rig.outer_mass, rig.resonator_mass])[:, None]
    full = np.zeros((6, 6))
    full[0::2, 1::2] = np.eye(3)
    full[1::2, 0::2], full[1::2, 1::2] = -stiff / mass, -damp / mass
    return full


def overdamped(rig):
    return dataclasses.replace(
        rig, resonator_damping=3.0 * 2.0 * math.sqrt(rig.resonator_mass * rig.resonator_stiffness)
    )
