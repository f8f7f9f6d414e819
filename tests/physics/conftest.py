"""What the physics tests share: numbers typed from publications, the catalogue's rigs and the reference scenes."""

import math
import sys
import tomllib
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from physics.cage import CagePath, draw_slip_knots
from physics.catalog import rig
from physics.hertz import contact_width
from physics.operation import Operation
from physics.rig import Rig
from physics.roughness import draw_roughness
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall
from physics.trace import Trace

sys.path.insert(0, str(Path(__file__).parent))  # so that tests can import kernels

AUTHORITIES = Path(__file__).parents[1] / "authorities"
RATE = 65536.0
BOTTOM = math.radians(270.0)
LINE_EXTENT = {"gearbox": math.radians(2.0), "fan": math.radians(2.6)}
EXTENDED_EXTENT, EXTENDED_TAPER = math.radians(40.0), math.radians(1.0)
LINE_TAPER = math.radians(0.3)
DEEP_GAP = 0.3e-3


@pytest.fixture(scope="session")
def authority() -> Callable[[str], dict[str, Any]]:
    """Reads tests/authorities/<name>.toml."""
    return lambda name: tomllib.loads((AUTHORITIES / f"{name}.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def gearbox() -> Rig:
    return rig("gearbox")


@pytest.fixture(scope="session")
def fan() -> Rig:
    return rig("fan")


@pytest.fixture(scope="session")
def reference_scene() -> Callable[..., Scene]:
    """Builds G0, G1, G1s, G1p, G2, G2r and the same with F: `reference_scene(name, duration, ...)`."""
    return _reference_scene


@pytest.fixture(scope="session")
def reference_trace() -> Callable[..., Trace]:
    """Simulates a reference scene once: `reference_trace(name, duration, substeps, **choices of the scene)`."""

    @cache
    def run(name: str, duration: float = 0.5, substeps: int | None = 1, **scene: Any) -> Trace:
        return simulate(_reference_scene(name, duration, **scene), RATE, substeps=substeps, estimate_error=False)

    return run


@cache
def _reference_scene(
    name: str,
    duration: float = 0.5,
    *,
    slip_seed: int | None = None,
    roughness_seed: int = 0,
    speed_factor: float = 1.0,
) -> Scene:
    """A reference scene; with a `slip_seed` the cage slips by 1 %, with one ball pass of correlation time."""
    machine = rig({"G": "gearbox", "F": "fan"}[name[0]])
    speed = machine.rated_speed * speed_factor
    return Scene(
        rig=machine,
        operation=Operation(speed, machine.rated_load),
        cage=_cage(machine, speed, duration, slip_seed),
        spalls=_spalls(name[1:], machine, roughness_seed),
    )


def _cage(machine: Rig, speed: float, duration: float, slip_seed: int | None) -> CagePath:
    nominal = machine.bearing.cage_speed(speed)
    if slip_seed is None:
        return CagePath(nominal, duration)
    one_pass = machine.bearing.spacing / nominal
    step, start, values = draw_slip_knots(np.random.default_rng(slip_seed), 0.01, one_pass, duration)
    return CagePath(nominal, duration, knot_step=step, knot_start=start, knot_values=values)


def _spalls(kind: str, machine: Rig, roughness_seed: int) -> tuple[Spall, ...]:
    line = LINE_EXTENT[machine.name]
    spalls = {
        "0": (),
        "1": (Spall("outer", 1, BOTTOM, line, 12e-6, LINE_TAPER, LINE_TAPER),),
        "1s": (Spall("outer", 1, BOTTOM, line, 12e-6, 0.9 * line, 0.1 * line),),
        "1p": (Spall("outer", 1, BOTTOM, line, DEEP_GAP, profile="ball_path"),),
        "2": (Spall("outer", 1, BOTTOM, EXTENDED_EXTENT, 4e-6, EXTENDED_TAPER, EXTENDED_TAPER),),
    }
    return spalls[kind] if kind in spalls else (_rough_spall(machine, roughness_seed),)


def _rough_spall(machine: Rig, seed: int) -> Spall:
    bearing = machine.bearing
    width = contact_width(bearing, "outer", bearing.stribeck_peak_load(machine.rated_load))
    values = draw_roughness(np.random.default_rng(seed), bearing, "outer", EXTENDED_EXTENT, 2e-6, width)
    return Spall(
        "outer", 1, BOTTOM, EXTENDED_EXTENT, 6e-6, EXTENDED_TAPER, EXTENDED_TAPER,
        roughness=2e-6, roughness_values=values,
    )  # fmt: skip


@pytest.fixture(scope="session")
def build_scene() -> Callable[..., Scene]:
    """A scene on a rig at its rated point; `bearing` and `operation` change fields of these, the rest fields of it."""

    def build(
        machine: Rig,
        *spalls: Spall,
        start_angle: float = 0.0,
        bearing: dict[str, Any] | None = None,
        operation: dict[str, Any] | None = None,
        **fields: Any,
    ) -> Scene:
        changed = replace(machine, bearing=replace(machine.bearing, **(bearing or {})))
        run = replace(Operation(shaft_speed=machine.rated_speed, load=machine.rated_load), **(operation or {}))
        speed = changed.bearing.cage_speed(run.shaft_speed)
        cage = CagePath(nominal_speed=speed, duration=0.5, start_angle=start_angle)
        return replace(Scene(rig=changed, operation=run, cage=cage, spalls=spalls), **fields)

    return build
