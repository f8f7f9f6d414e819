"""Natural frequencies, damping ratios and shapes of a rig linearised about its quasi-static position."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig, eigh

from physics.angular_speed import in_hertz
from physics.arrays import Array, ComplexArray, Index
from physics.cage import CagePath
from physics.checks import require
from physics.operation import Operation
from physics.rig import Rig
from physics.scene import Scene
from physics.statics.load_distribution import equilibrium
from physics.statics.stiffness import symmetric_matrices


@dataclass(frozen=True)
class Modes:
    """The six modes of a linearised rig, by rising frequency.

    `frequency_hz` (6,) undamped natural frequencies, Hz; `damping_ratio` (6,); `shape` (6, 6) complex, one mode a
    column over (xi, yi, xo, yo, xr, yr), its largest displacement 1.
    """

    frequency_hz: Array
    damping_ratio: Array
    shape: ComplexArray


def coupled_matrix(rig_matrix: Array, bearing: Array) -> Array:
    """A rig's stiffness or damping matrix (6, 6) with the bearing's (2, 2) between the two rings [P14 Eq. 29].

    InvalidParameter if that has another shape or holds a value that is not finite.
    """
    bearing = np.asarray(bearing, dtype=np.float64)
    require(bearing.shape == (2, 2), f"bearing matrix has the shape {bearing.shape}; it must be (2, 2)")
    require(bool(np.all(np.isfinite(bearing))), "bearing matrix holds a value that is not finite")
    coupled = np.array(rig_matrix)
    coupled[0:2, 0:2] += bearing
    coupled[0:2, 2:4] -= bearing
    coupled[2:4, 0:2] -= bearing
    coupled[2:4, 2:4] += bearing
    return coupled


def modes(rig: Rig, stiffness: Array, damping: Array) -> Modes:
    """Modes of `rig` with the bearing's `stiffness` (2, 2) N/m and `damping` (2, 2) N s/m [P14 Eq. 28-31].

    Eq. 30 is solved with +K in its first row, without which its eigenvalues solve λ²M + λC − K = 0. An overdamped
    mode has two real eigenvalues: its frequency is the root of their product, its damping ratio is 1 or more.
    """
    mass = rig.mass_matrix()
    size = mass.shape[0]
    zero = np.zeros((size, size))
    k = coupled_matrix(rig.stiffness_matrix(), stiffness)
    c = coupled_matrix(rig.damping_matrix(), damping)
    # Time in units of the fastest frequency: both matrices of the problem then hold numbers of like size.
    unit = math.sqrt(float(np.max(np.diag(k) / np.diag(mass))))
    left = np.block([[zero, k / unit**2], [-mass, zero]])
    right = np.block([[mass, c / unit], [zero, mass]])
    values, vectors = eig(left, -right)
    frequency, ratio, columns = _pair(values * unit)
    order = np.argsort(frequency, kind="stable")
    shape = vectors[size:, columns[order]]
    largest = shape[np.argmax(np.abs(shape), axis=0), np.arange(size)]
    return Modes(in_hertz(frequency[order]), ratio[order], shape / largest)


def _pair(values: ComplexArray) -> tuple[Array, Array, Index]:
    """Frequency (rad/s), damping ratio and column of each mode from the eigenvalues of Eq. 30, (12,) [P14 Eq. 31]."""
    rising = np.flatnonzero(values.imag > 0.0)
    real = np.flatnonzero(values.imag == 0.0)
    real = real[np.argsort(np.abs(values[real]))]
    slow, fast = real[: real.size // 2], real[real.size // 2 :][::-1]
    product = np.sqrt(np.abs(values[slow]) * np.abs(values[fast]))
    frequency = np.concatenate([np.abs(values[rising]), product])
    decay = np.concatenate([-values[rising].real, -(values[slow] + values[fast]).real / 2.0])
    ratio = np.divide(decay, frequency, out=np.zeros_like(decay), where=frequency > 0.0)
    return frequency, ratio, np.concatenate([rising, slow])


def coupled_resonator_frequency(rig: Rig, stiffness: Array) -> float:
    """Undamped frequency (Hz) of the mode whose energy lies most in the resonator's spring along y.

    This, not √(k_r/m_r), is where the resonator rings while it hangs on the outer ring; `stiffness` (2, 2) N/m.
    """
    k = coupled_matrix(rig.stiffness_matrix(), stiffness)
    squared, shapes = eigh(k, rig.mass_matrix())
    stretch = shapes[5] - shapes[3]
    # Shapes are normalised to unit modal mass, so a mode's strain energy is half its squared frequency.
    share = rig.resonator_stiffness * stretch**2 / np.maximum(squared, 1e-9 * squared[-1])
    return in_hertz(math.sqrt(squared[int(np.argmax(share))]))


def rated_matrices(rig: Rig) -> tuple[Array, Array]:
    """Stiffness (2, 2) N/m and damping (2, 2) N s/m of the healthy bearing at the rated load, cage angle 0."""
    cage = CagePath(nominal_speed=rig.bearing.cage_speed(rig.rated_speed), duration=1.0)
    scene = Scene(rig=rig, operation=Operation(shaft_speed=rig.rated_speed, load=rig.rated_load), cage=cage)
    rest = equilibrium(scene, np.zeros(1))
    return symmetric_matrices(rest.stiffness[0]), symmetric_matrices(rest.damping[0])
