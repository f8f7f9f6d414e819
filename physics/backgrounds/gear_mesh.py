"""Gear mesh: harmonics of the tooth frequency with sidebands of both gears' shafts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physics.angular_speed import in_hertz
from physics.arrays import Array
from physics.backgrounds.tones import draw_phases, tones
from physics.checks import require_between, require_count, require_not_negative, settle_tuples

MOST_TEETH = 1000
MOST_SIDEBANDS = 50


@dataclass(frozen=True)
class GearMesh:
    """A gear of `teeth` on the bearing's shaft in mesh with one of `other_teeth` (0: no sidebands of its shaft).

    `amplitudes` (m/s²) of the mesh harmonics on each axis. `modulation` by the bearing's shaft, `other_modulation` by
    the other's: sideband k (1 to `sidebands`) on each side has half of its k-th power times its harmonic's amplitude.
    InvalidParameter unless there are 1 to 1000 teeth (other teeth 0 to 1000), 0 to 50 sidebands, modulations from 0 to
    1 and no amplitude below 0.
    """

    teeth: int
    amplitudes: tuple[float, ...]
    other_teeth: int = 0
    modulation: float = 0.0
    other_modulation: float = 0.0
    sidebands: int = 1

    def __post_init__(self) -> None:
        settle_tuples(self, "amplitudes")
        require_count("teeth", self.teeth, 1, MOST_TEETH)
        require_count("other_teeth", self.other_teeth, 0, MOST_TEETH, what="other teeth")
        require_count("sidebands", self.sidebands, 0, MOST_SIDEBANDS)
        require_between("modulation", self.modulation, 0.0, 1.0)
        require_between("other_modulation", self.other_modulation, 0.0, 1.0, what="other modulation")
        for amplitude in self.amplitudes:
            require_not_negative("amplitudes", amplitude, "m/s²", what="mesh amplitude")


def gear_mesh(generator: np.random.Generator, layer: GearMesh, shaft_speed: float, samples: int, rate: float) -> Array:
    """The mesh (T, 2), m/s², at `shaft_speed` (rad/s) of the bearing's shaft.

    Harmonic h is A_h (1 + Σ_k m^k cos(k θ1 + ψ_k) + Σ_k m'^k cos(k θ2 + ψ'_k)) cos(h teeth θ1 + φ_h), with the shafts'
    angles θ1 and θ2 from 0. Draws φ (H, 2), one a harmonic and axis, then ψ (K, 2) and ψ' (K, 2). Single lines at or
    above half the `rate` (Hz) are left out.
    """
    harmonics = np.arange(1, len(layer.amplitudes) + 1, dtype=np.float64)
    order = np.arange(1, layer.sidebands + 1, dtype=np.float64)
    phase = draw_phases(generator, harmonics.size)
    shifts = [draw_phases(generator, order.size) for _ in range(2)]
    shaft = in_hertz(shaft_speed)
    other = shaft * layer.teeth / layer.other_teeth if layer.other_teeth else 0.0
    amplitude, mesh = np.array(layer.amplitudes), harmonics * layer.teeth * shaft
    total = tones(mesh, amplitude, phase, samples, rate)
    depths = (layer.modulation, layer.other_modulation if layer.other_teeth else 0.0)
    for frequency, depth, shift in zip((shaft, other), depths, shifts, strict=True):
        for side in (-1.0, 1.0):
            lines = np.add.outer(mesh, side * order * frequency)
            heights = np.multiply.outer(amplitude, 0.5 * depth**order)
            phases = phase[:, None] + side * shift[None]
            total += tones(lines.ravel(), heights.ravel(), phases.reshape(-1, 2), samples, rate)
    return total
