"""How long a step may be for an explicit method to be stable, from the fastest modes of the linearised scene."""

from __future__ import annotations

import math

import numpy as np

from physics.arrays import Array, ComplexArray
from physics.integrators.method import ALL_MODES, CONTACT_MODES, Method
from physics.modes import coupled_matrix
from physics.outcome import Outcome, SimulationFailed
from physics.rig import Rig
from physics.scene import Scene
from physics.statics.load_distribution import Equilibrium
from physics.statics.stiffness import symmetric_matrices

MOST_STABLE_SUBSTEPS = 1024


def limiting_modes(rig: Rig, limits: str, stiffness: Array, damping: Array) -> ComplexArray:
    """Eigenvalues λ (1/s) of the modes that limit a method, none for NO_MODES, for a bearing of `stiffness` and
    `damping` (3,): xx, yy, xy.

    The contact modes are those of the inner ring against a free outer ring, which the film damps.
    """
    if limits == ALL_MODES:
        mass, size = rig.mass_matrix(), 6
        k = coupled_matrix(rig.stiffness_matrix(), symmetric_matrices(stiffness))
        c = coupled_matrix(rig.damping_matrix(), symmetric_matrices(damping))
    elif limits == CONTACT_MODES:
        mass, size = np.eye(2) / (1.0 / rig.inner_mass + 1.0 / rig.outer_mass), 2
        k, c = symmetric_matrices(stiffness), symmetric_matrices(damping)
    else:
        return np.zeros(0, np.complex128)
    first_order = np.zeros((2 * size, 2 * size))
    first_order[:size, size:] = np.eye(size)
    first_order[size:, :size] = -np.linalg.solve(mass, k)
    first_order[size:, size:] = -np.linalg.solve(mass, c)
    # Displacements and velocities are brought to like size: eigenvalues of a badly scaled matrix lose digits.
    unit = math.sqrt(float(np.abs(first_order[size:, :size]).max())) or 1.0
    first_order[:size, size:] *= unit
    first_order[size:, :size] /= unit
    return np.linalg.eigvals(first_order).astype(np.complex128)


def longest_stable_step(rig: Rig, method: Method, stiffness: Array, damping: Array) -> float:
    """Longest step (s) at which every mode that limits `method` is stable, for a bearing of this `stiffness` and
    `damping` (3,); may be infinite."""
    modes = limiting_modes(rig, method.limits, stiffness, damping)
    steps = [method.limit_at(-mode.real / abs(mode)) / abs(mode) for mode in modes if mode != 0.0]
    return float(min(steps, default=math.inf))


def stable_substeps(scene: Scene, method: Method, rest: Equilibrium, rate: float) -> int:
    """Fewest steps a sample at which `method` is stable in every one of the quasi-static positions `rest`.

    A light load is carried by one ball of a row or by two, by turns, and then by one film or by two.
    """
    longest = min(
        longest_stable_step(scene.rig, method, stiffness, damping)
        for stiffness, damping in zip(rest.stiffness, rest.damping, strict=True)
    )
    return max(1, math.ceil(1.0 / (rate * longest) - 1e-9))


def require_stable(method: Method, rate: float, substeps: int, least: int) -> None:
    """Raise SimulationFailed if `substeps` a sample of `rate` (Hz) are fewer than `least`, or more than are made."""
    if substeps < least or substeps > MOST_STABLE_SUBSTEPS:
        raise SimulationFailed(
            Outcome.UNSTABLE_STEP,
            f"{substeps} step(s) a sample of {rate:.6g} Hz; {method.name} is stable up to |λ| h = {_told(method)} of "
            f"{method.limits}, which here takes {least} steps a sample (at most {MOST_STABLE_SUBSTEPS} are made)",
        )


def _told(method: Method) -> str:
    limits = [method.stability_limit, *(limit for _, limit in method.damped_limits)]
    return f"{min(limits):g} to {max(limits):g}, by the damping," if len(limits) > 1 else f"{limits[0]:g}"
