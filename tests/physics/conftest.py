"""What the physics tests share: numbers typed from publications, the catalogue's rigs and the reference scenes."""

import sys
import tomllib
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from physics.cage import CagePath
from physics.catalog import rig
from physics.operation import Operation
from physics.reference_scenes import reference_scene as build_reference_scene
from physics.request import FixedSteps
from physics.rig import Rig
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall
from physics.trace import Trace

sys.path.insert(0, str(Path(__file__).parent))  # so that tests can import kernels

AUTHORITIES = Path(__file__).parents[1] / "authorities"
RATE = 65536.0


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
    return cache(build_reference_scene)


@pytest.fixture(scope="session")
def reference_trace(reference_scene: Callable[..., Scene]) -> Callable[..., Trace]:
    """Simulates a reference scene once: `reference_trace(name, duration, substeps, **choices of the scene)`."""

    @cache
    def run(name: str, duration: float = 0.5, substeps: int = 1, **scene: Any) -> Trace:
        return simulate(reference_scene(name, duration, **scene), RATE, FixedSteps(substeps))

    return run


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
