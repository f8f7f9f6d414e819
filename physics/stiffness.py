"""The quasi-static stiffness of the bearing over time, the parametric excitation behind the vibration [P14 Eq. 26]."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics.scene import Scene
from physics.statics import equilibrium

Array = NDArray[np.float64]

COMPONENTS = ("xx", "yy", "xy")


def stiffness_trace(scene: Scene, time: Array) -> Array:
    """Stiffness (T, 3): kxx, kyy, kxy in N/m at the times (T,), s, each at its instant's load and angles.

    Zero where no ball is loaded.
    """
    return equilibrium(scene, time).stiffness


def matrix(components: Array) -> Array:
    """Symmetric matrices (…, 2, 2) from components (…, 3) in the order xx, yy, xy."""
    xx, yy, xy = np.moveaxis(np.asarray(components), -1, 0)
    return np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)
