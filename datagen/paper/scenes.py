"""The scenes behind the figures: the paper's two rigs, its spalls and its slip."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from physics.cage import CagePath, draw_slip_knots
from physics.catalog import rig
from physics.hertz import contact_width
from physics.imperfections import Imperfections
from physics.operation import Operation
from physics.paths.roughness import HALVED_WAVE_WIDTHS, draw_roughness
from physics.paths.spall_surface import window
from physics.rig import Rig
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall

Array = NDArray[np.float64]

RATE = 65536.0
ANALYSED = 1.4
LEAD = 0.1  # the start rings down before the analysed part
SLIP = 0.01
BOTTOM = math.radians(270.0)
LINE_EXTENT = {"gearbox": math.radians(2.0), "fan": math.radians(2.6)}
LINE_DEPTH, LINE_TAPER = 12e-6, math.radians(0.3)
GAP_DEPTH = 0.3e-3
EXTENDED_EXTENT, EXTENDED_TAPER = math.radians(40.0), math.radians(1.0)
REFERENCE_DEPTH, REFERENCE_ROUGHNESS = 6e-6, 2e-6
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
    speed = found.bearing.cage_speed(found.rated_speed)
    cage = CagePath(speed, duration)
    if slip_seed is not None and slip > 0.0:
        generator = np.random.default_rng(slip_seed)
        step, start, knots = draw_slip_knots(generator, slip, found.bearing.spacing / speed, duration)
        cage = CagePath(speed, duration, knot_step=step, knot_start=start, knot_values=knots)
    operation = Operation(found.rated_speed, found.rated_load)
    return Scene(found, operation, cage, tuple(spalls), imperfections or Imperfections())


def signal(of: Scene) -> Array:
    """Resonator acceleration along y (T,) of the last 1.4 s of a scene at 65 536 Hz, m/s²."""
    trace = simulate(of, RATE, substeps=1, estimate_error=False)
    return trace.acceleration[-round(ANALYSED * RATE) :, 1]


def bpfo_hz(name: str) -> float:
    """Ball-pass frequency of the outer race at the rated speed, Hz."""
    return machine(name).bearing.bpfo * machine(name).rated_speed / (2.0 * math.pi)


def ftf_hz(name: str) -> float:
    """Cage frequency at the rated speed, Hz."""
    return machine(name).bearing.ftf * machine(name).rated_speed / (2.0 * math.pi)


def shaft_hz(name: str) -> float:
    """Shaft frequency at the rated speed, Hz."""
    return machine(name).rated_speed / (2.0 * math.pi)


def line_spall(name: str) -> Spall:
    """The line spall of reference scenes G1 and F1: 12 µm deep at the ball's centre, equal tapers of 0.3°."""
    return Spall("outer", 1, BOTTOM, LINE_EXTENT[name], LINE_DEPTH, LINE_TAPER, LINE_TAPER)


def gradual_line_spall(name: str) -> Spall:
    """The line spall of reference scenes G1s and F1s: entry taper 0.9 and exit taper 0.1 of the length."""
    extent = LINE_EXTENT[name]
    return Spall("outer", 1, BOTTOM, extent, LINE_DEPTH, 0.9 * extent, 0.1 * extent)


def gap_line_spall(name: str) -> Spall:
    """The line spall of reference scenes G1p and F1p: a deep gap crossed on the path of the ball's centre."""
    return Spall("outer", 1, BOTTOM, LINE_EXTENT[name], GAP_DEPTH, profile="ball_path")


def reference_extended_spall(seed: int) -> Spall:
    """The extended spall of reference scene G2r: 40°, 6 µm deep, 2 µm of roughness low-passed at the contact width."""
    bearing = machine("gearbox").bearing
    width = contact_width(bearing, "outer", bearing.stribeck_peak_load(machine("gearbox").rated_load))
    generator = np.random.default_rng(seed)
    values = draw_roughness(generator, bearing, "outer", EXTENDED_EXTENT, REFERENCE_ROUGHNESS, width)
    return _extended(REFERENCE_DEPTH, REFERENCE_ROUGHNESS, values)


def smooth_extended_spall(depth: float, taper: float) -> Spall:
    """A smooth extended spall of 40° with equal tapers, m and rad."""
    return Spall("outer", 1, BOTTOM, EXTENDED_EXTENT, depth, taper, taper)


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
    flat = window(_extended(1.0e-3), arc)
    waves = amplitude * flat * np.cos(2.0 * np.pi * arc / wavelength + phase)
    waves[[0, -1]] = 0.0
    return _kept_below_the_race(depth, waves, amplitude / math.sqrt(2.0))


def _kept_below_the_race(depth: float, waves: Array, deviation: float) -> Spall:
    half = EXTENDED_EXTENT / 2.0
    arc = np.linspace(-half, half, FINER * (waves.size - 1) + 1)
    flat = depth * window(_extended(depth), arc)
    fine = CubicSpline(np.linspace(-half, half, waves.size), waves, bc_type="natural")(arc)
    cut = np.clip(flat + fine, 0.0, DEEPEST - SWING) - flat
    cut[[0, -1]] = 0.0
    return _extended(depth, deviation, tuple(float(value) for value in np.round(cut, 12) + 0.0))


def _extended(depth: float, deviation: float = 0.0, values: tuple[float, ...] = ()) -> Spall:
    return Spall(
        "outer",
        1,
        BOTTOM,
        EXTENDED_EXTENT,
        depth,
        EXTENDED_TAPER,
        EXTENDED_TAPER,
        roughness=deviation,
        roughness_values=values,
    )
