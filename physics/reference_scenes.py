"""The named reference scenes: both rigs at their rated point, healthy and with line and extended spalls.

G is the gearbox rig, F the fan rig; 0 healthy, 1 a line spall, 1s with a gradual entry and a sharp exit, 1p the same
arc as a deep gap, 2 an extended spall, 2r a rough one. All spalls lie on row 1 of the outer race at 270 degrees. Their
spalls, and slip like theirs, can be had alone.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from physics.cage import CagePath, draw_slip_knots
from physics.catalog import rig
from physics.checks import require_one_of
from physics.hertz import contact_width
from physics.operation import Operation
from physics.paths.roughness import draw_roughness
from physics.rig import Rig
from physics.scene import Scene
from physics.spall import Spall

BOTTOM = math.radians(270.0)
LINE_EXTENT = {"gearbox": math.radians(2.0), "fan": math.radians(2.6)}
LINE_DEPTH, LINE_TAPER, DEEP_GAP = 12e-6, math.radians(0.3), 0.3e-3
EXTENDED_EXTENT, EXTENDED_DEPTH, EXTENDED_TAPER = math.radians(40.0), 4e-6, math.radians(1.0)
ROUGH_DEPTH, ROUGHNESS = 6e-6, 2e-6
SLIP = 0.01
KINDS = ("0", "1", "1s", "1p", "2", "2r")
RIGS = {"G": "gearbox", "F": "fan"}
REFERENCE_SCENES = tuple(letter + kind for letter in RIGS for kind in KINDS)


def reference_scene(
    name: str,
    duration: float = 0.5,
    *,
    slip_seed: int | None = None,
    roughness_seed: int = 0,
    speed_factor: float = 1.0,
) -> Scene:
    """The scene of that name over `duration` (s); InvalidParameter for an unknown one.

    With a `slip_seed` the cage slips by 1 %, with one ball pass of correlation time. `roughness_seed` draws the floor
    of the rough scenes; shaft and cage turn at `speed_factor` times the rated speed, under the rated load.
    """
    require_one_of("name", name, REFERENCE_SCENES)
    machine = rig(RIGS[name[:1]])
    spalls = _spalls(machine, name[1:], roughness_seed)
    speed = machine.rated_speed * speed_factor
    scene = Scene(
        rig=machine,
        operation=Operation(speed, machine.rated_load),
        cage=CagePath(machine.bearing.cage_speed(speed), duration),
        spalls=spalls,
    )
    return scene if slip_seed is None else slipping(scene, SLIP, slip_seed)


def slipping(scene: Scene, deviation: float, seed: int) -> Scene:
    """The steady `scene` with random slip of this standard deviation and one ball pass of correlation time."""
    cage = scene.cage
    one_pass = scene.rig.bearing.spacing / cage.nominal_speed
    knots = draw_slip_knots(np.random.default_rng(seed), deviation, one_pass, cage.duration)
    return replace(scene, cage=replace(cage, knot_step=knots.step, knot_start=knots.start, knot_values=knots.values))


def line_spall(rig_name: str) -> Spall:
    """The line spall of G1 or F1: 12 µm deep at the ball's centre, equal tapers of 0.3°."""
    return Spall("outer", 1, BOTTOM, LINE_EXTENT[rig_name], LINE_DEPTH, LINE_TAPER, LINE_TAPER)


def gradual_line_spall(rig_name: str) -> Spall:
    """The line spall of G1s or F1s: entry taper 0.9 and exit taper 0.1 of the length."""
    extent = LINE_EXTENT[rig_name]
    return Spall("outer", 1, BOTTOM, extent, LINE_DEPTH, 0.9 * extent, 0.1 * extent)


def gap_line_spall(rig_name: str) -> Spall:
    """The line spall of G1p or F1p: a deep gap crossed on the path of the ball's centre."""
    return Spall("outer", 1, BOTTOM, LINE_EXTENT[rig_name], DEEP_GAP, profile="ball_path")


def extended_spall(
    depth: float = EXTENDED_DEPTH,
    taper: float = EXTENDED_TAPER,
    roughness: float = 0.0,
    roughness_values: tuple[float, ...] = (),
) -> Spall:
    """An extended spall of 40° with equal tapers, m and rad; by default that of G2 and F2."""
    return Spall(
        "outer",
        1,
        BOTTOM,
        EXTENDED_EXTENT,
        depth,
        taper,
        taper,
        roughness=roughness,
        roughness_values=roughness_values,
    )


def rough_extended_spall(machine: Rig, seed: int) -> Spall:
    """The extended spall of G2r or F2r: 6 µm deep, 2 µm of roughness low-passed at the contact width."""
    bearing = machine.bearing
    width = contact_width(bearing, "outer", bearing.stribeck_peak_load(machine.rated_load))
    values = draw_roughness(np.random.default_rng(seed), bearing, "outer", EXTENDED_EXTENT, ROUGHNESS, width)
    return extended_spall(ROUGH_DEPTH, EXTENDED_TAPER, ROUGHNESS, values)


def _spalls(machine: Rig, kind: str, roughness_seed: int) -> tuple[Spall, ...]:
    if kind == "2r":
        return (rough_extended_spall(machine, roughness_seed),)
    smooth: dict[str, tuple[Spall, ...]] = {
        "0": (),
        "1": (line_spall(machine.name),),
        "1s": (gradual_line_spall(machine.name),),
        "1p": (gap_line_spall(machine.name),),
        "2": (extended_spall(),),
    }
    return smooth[kind]
