"""What the physics tests share: numbers typed from publications, and the catalogue's rigs."""

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from physics.catalog import rig
from physics.rig import Rig

AUTHORITIES = Path(__file__).parents[1] / "authorities"


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
