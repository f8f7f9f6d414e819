"""The scenes behind the figures: the paper's two rigs with the reference spalls and others, and its slip."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline

from physics.angular_speed import in_hertz
from physics.arrays import Array
from physics.bearing import Bearing
from physics.cage import CagePath
from physics.catalog import rig
from physics.imperfections import Imperfections
from physics.operation import Operation
from physics.paths.roughness import HALVED_WAVE_WIDTHS, draw_roughness
from physics.paths.spall_surface import window
from physics.reference_scenes import (
    EXTENDED_EXTENT,
    EXTENDED_TAPER,
    SLIP,
    extended_spall,
    rough_extended_spall,
    slipping,
)
from physics.request import FixedSteps
from physics.rig import Rig
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall

RATE = 65536.0
ANALYSED = 1.4
LEAD = 0.1  # the start rings down before the analysed part
DEEPEST = 15e-6  # the lower end of the depth axes of the paper's Figure 5
# A spline through cut waves swings past the cut, by about this where its steps are a quarter of those of the waves.
SWING, FINER = 0.05e-6, 4
WAVY_DEPTH, WAVY_DEVIATION, SHORTEST_WAVE = 4e-6, 8e-6, 2e-3
SEEDS = range(10)
SHOWN_SEED = 5  # near the middle of the ten in the levels of its velocity harmonics; a test holds it there


@cache
def machine(name: str) -> Rig:
    """The paper's "gearbox" or "fan" rig."""
    return rig(name)


def scene(
    name: str,
    *spalls: Spall,
    duration: float = LEAD + ANALYSED,
    slip_seed: int | None = None,
    slip: float = SLIP,
    imperfections: Imperfections | None = None,
) -> Scene:
    """A rig at its rated point; with a `slip_seed` the cage slips by `slip` (standard deviation), else it is steady."""
    found = machine(name)
    cage = CagePath(found.bearing.cage_speed(found.rated_speed), duration)
    operation = Operation(found.rated_speed, found.rated_load)
    steady = Scene(found, operation, cage, tuple(spalls), imperfections or Imperfections())
    return steady if slip_seed is None or slip == 0.0 else slipping(steady, slip, slip_seed)


def ball_angles(bearing: Bearing, cage: Array) -> Array:
    """Angles (T, rows, balls) of the balls at these angles (T,) of the cage, rad, not reduced to a turn."""
    of_row_1 = cage[:, None, None] + bearing.spacing * np.arange(bearing.balls)
    return np.asarray(of_row_1 + bearing.stagger * np.arange(bearing.rows)[:, None])


def half_arc(of: Scene) -> float:
    """Half the arc of the scene's spall, degrees; 0 of a healthy one."""
    return math.degrees(of.spalls[0].extent) / 2.0 if of.spalls else 0.0


def signal(of: Scene) -> Array:
    """Resonator acceleration along y (T,) of the last 1.4 s of a scene at 65 536 Hz, m/s²."""
    trace = simulate(of, RATE, FixedSteps(1))
    return trace.acceleration[-round(ANALYSED * RATE) :, 1]


def bpfo_hz(name: str) -> float:
    """Ball-pass frequency of the outer race at the rated speed, Hz."""
    return in_hertz(machine(name).bearing.bpfo * machine(name).rated_speed)


def ftf_hz(name: str) -> float:
    """Cage frequency at the rated speed, Hz."""
    return in_hertz(machine(name).bearing.ftf * machine(name).rated_speed)


def shaft_hz(name: str) -> float:
    """Shaft frequency at the rated speed, Hz."""
    return in_hertz(machine(name).rated_speed)


def reference_extended_spall(seed: int) -> Spall:
    """The extended spall of reference scene G2r."""
    return rough_extended_spall(machine("gearbox"), seed)


def wavy_extended_spall(
    seed: int, depth: float = WAVY_DEPTH, deviation: float = WAVY_DEVIATION, shortest_wave: float = SHORTEST_WAVE
) -> Spall:
    """An extended spall of 40° with long random waves that stays between the race and 15 µm below it.

    `depth` of the window plus noise of standard deviation `deviation` (m) whose waves shorter than `shortest_wave` (m,
    half amplitude) are filtered out, then cut off at 0 and at 15 µm.
    """
    bearing, generator = machine("gearbox").bearing, np.random.default_rng(seed)
    width = shortest_wave / HALVED_WAVE_WIDTHS
    waves = np.array(draw_roughness(generator, bearing, "outer", EXTENDED_EXTENT, deviation, width))
    return _kept_below_the_race(depth, waves, deviation)


def waved_extended_spall(depth: float, amplitude: float, wavelength: float, phase: float) -> Spall:
    """An extended spall of 40° with one wave along it, cut off at 0 and at 15 µm; m, m, rad, rad."""
    arc = np.linspace(-EXTENDED_EXTENT / 2.0, EXTENDED_EXTENT / 2.0, 801)
    flat = window(extended_spall(1.0e-3), arc)
    waves = amplitude * flat * np.cos(2.0 * np.pi * arc / wavelength + phase)
    waves[[0, -1]] = 0.0
    return _kept_below_the_race(depth, waves, amplitude / math.sqrt(2.0))


def _kept_below_the_race(depth: float, waves: Array, deviation: float) -> Spall:
    half = EXTENDED_EXTENT / 2.0
    arc = np.linspace(-half, half, FINER * (waves.size - 1) + 1)
    flat = depth * window(extended_spall(depth), arc)
    fine = CubicSpline(np.linspace(-half, half, waves.size), waves, bc_type="natural")(arc)
    cut = np.clip(flat + fine, 0.0, DEEPEST - SWING) - flat
    cut[[0, -1]] = 0.0
    values = tuple(float(value) for value in np.round(cut, 12) + 0.0)
    return extended_spall(depth, EXTENDED_TAPER, deviation, values)
