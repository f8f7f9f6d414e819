"""The named reference scenes: both rigs at their rated point, healthy and with line and extended spalls.

G is the gearbox rig, F the fan rig; 0 healthy, 1 a line spall, 1s with a gradual entry and a sharp exit, 1p the same
arc as a deep gap, 2 an extended spall, 2r a rough one. All spalls lie on row 1 of the outer race at 270 degrees.
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

    With a `slip_seed` the cage slips by 1 %, with one ball pass of correlation time.
    """
    require_one_of("name", name, REFERENCE_SCENES)
    machine = rig(RIGS[name[:1]])
    spalls = _spalls(machine, name[1:], roughness_seed)
    speed = machine.rated_speed * speed_factor
    cage = CagePath(machine.bearing.cage_speed(speed), duration)
    if slip_seed is not None:
        cage = _slipping(machine, cage, slip_seed)
    return Scene(rig=machine, operation=Operation(speed, machine.rated_load), cage=cage, spalls=spalls)


def _slipping(machine: Rig, cage: CagePath, seed: int) -> CagePath:
    one_pass = machine.bearing.spacing / cage.nominal_speed
    step, start, values = draw_slip_knots(np.random.default_rng(seed), 0.01, one_pass, cage.duration)
    return replace(cage, knot_step=step, knot_start=start, knot_values=values)


def _spalls(machine: Rig, kind: str, roughness_seed: int) -> tuple[Spall, ...]:
    arc = LINE_EXTENT[machine.name]
    smooth = {
        "0": (),
        "1": (Spall("outer", 1, BOTTOM, arc, LINE_DEPTH, LINE_TAPER, LINE_TAPER),),
        "1s": (Spall("outer", 1, BOTTOM, arc, LINE_DEPTH, 0.9 * arc, 0.1 * arc),),
        "1p": (Spall("outer", 1, BOTTOM, arc, DEEP_GAP, profile="ball_path"),),
        "2": (Spall("outer", 1, BOTTOM, EXTENDED_EXTENT, EXTENDED_DEPTH, EXTENDED_TAPER, EXTENDED_TAPER),),
    }
    return (_rough(machine, roughness_seed),) if kind == "2r" else smooth[kind]


def _rough(machine: Rig, seed: int) -> Spall:
    bearing = machine.bearing
    width = contact_width(bearing, "outer", bearing.stribeck_peak_load(machine.rated_load))
    values = draw_roughness(np.random.default_rng(seed), bearing, "outer", EXTENDED_EXTENT, ROUGHNESS, width)
    return Spall(
        "outer",
        1,
        BOTTOM,
        EXTENDED_EXTENT,
        ROUGH_DEPTH,
        EXTENDED_TAPER,
        EXTENDED_TAPER,
        roughness=ROUGHNESS,
        roughness_values=values,
    )
