"""Scenes that differ from a given one in some fields, and cages that slip at random."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from physics.cage import CagePath, draw_slip_knots
from physics.scene import Scene

Fields = Mapping[str, Any]


def changed(
    scene: Scene,
    *,
    bearing: Fields | None = None,
    rig: Fields | None = None,
    operation: Fields | None = None,
    spall: Fields | None = None,
    **fields: Any,
) -> Scene:
    """`scene` with fields of its bearing, rig, operation and spalls changed, then its own."""
    machine = dataclasses.replace(scene.rig, bearing=dataclasses.replace(scene.rig.bearing, **(bearing or {})))
    machine = dataclasses.replace(machine, **(rig or {}))
    run = dataclasses.replace(scene.operation, **(operation or {}))
    spalls = tuple(dataclasses.replace(one, **(spall or {})) for one in scene.spalls)
    return dataclasses.replace(scene, **{"rig": machine, "operation": run, "spalls": spalls, **fields})


def with_rollers(scene: Scene) -> Scene:
    """`scene` with rollers for balls, whose line contacts (exponent 10/9) take the same load at 5 µm of compression."""
    bearing, exponent = scene.rig.bearing, 10.0 / 9.0
    stiffness = bearing.load_deflection * 5e-6 ** (bearing.exponent - exponent)
    return changed(scene, bearing={"exponent": exponent, "load_deflection": stiffness})


def slipping_cage(scene: Scene, seed: int, start_angle: float = 0.2, correlation_time: float = 0.03) -> CagePath:
    """The cage of `scene` for half a second with 2 % of slip that scatters by 5 %, from `start_angle` (rad) on."""
    knots = draw_slip_knots(np.random.default_rng(seed), 0.05, correlation_time, 0.5)
    return CagePath(scene.cage.nominal_speed, 0.5, start_angle, 0.02, *knots)
