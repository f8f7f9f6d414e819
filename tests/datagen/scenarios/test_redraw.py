"""What was refused while drawing is told by the key of the recipe that it was drawn for."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.redraw import MOST_ATTEMPTS, Redraw, given_up
from physics.backgrounds.gear_mesh import GearMesh
from physics.backgrounds.impulses import Impulses, Resonance
from physics.backgrounds.pink import PinkNoise
from physics.bearing import Bearing
from physics.checks import InvalidParameter
from physics.operation import Operation
from physics.sensor.chain import SensorChain
from physics.sensor.mode import SensorMode
from physics.sensor.mounting import Mounting
from physics.sensor.recorder import Recorder

PART = """[[part]]
name = "one"
records = 1

[part.machine]
rig = "gearbox"
ball_diameter_mm = 7.12

[part.operation]
speed_rpm = 420
load_n = 346

[part.chain]
resonator_gain = 1
mounting_cutoff_hz = 9000
recorder_range_m_s2 = 100
recorder_bits = 16

[part.background.pink]
rms_m_s2 = 1
lowest_hz = 2
slope = 1

[part.background.gear_mesh]
teeth = 32
other_teeth = 49
amplitude_m_s2 = 1
modulation = 0.1
other_modulation = 0.2

[part.background.impulses]
per_second = 3
amplitude_m_s2 = 1
spread = 0.5
frequency_hz = 900
damping = 0.1
"""
RING = (Resonance(900.0, 0.1),)
REFUSED: dict[str, Callable[[], Any]] = {
    "ball_diameter_mm": lambda: Bearing("b", 12, 2, 0.03875, 0.0, 7e9),
    "speed_rpm": lambda: Operation(0.0, 1.0),
    "load_n": lambda: Operation(1.0, 1e9),
    "resonator_gain": lambda: SensorChain(resonator_gain=-1.0),
    "mounting_cutoff_hz": lambda: Mounting(0.0),
    "recorder_range_m_s2": lambda: Recorder(0.0),
    "recorder_bits": lambda: Recorder(1.0, 1),
    "rms_m_s2": lambda: PinkNoise(-1.0),
    "lowest_hz": lambda: PinkNoise(1.0, 0.0),
    "slope": lambda: PinkNoise(1.0, 1.0, 9.0),
    "teeth": lambda: GearMesh(0, ()),
    "other_teeth": lambda: GearMesh(32, (), -1),
    "amplitude_m_s2": lambda: GearMesh(32, (-1.0,)),
    "modulation": lambda: GearMesh(32, (), modulation=2.0),
    "other_modulation": lambda: GearMesh(32, (), other_modulation=2.0),
    "per_second": lambda: Impulses(-1.0, 1.0, 0.5, RING),
    "spread": lambda: Impulses(1.0, 1.0, 9.0, RING),
    "frequency_hz": lambda: SensorMode(0.0, 0.1),
    "damping": lambda: Resonance(900.0, 0.9),
}


@pytest.mark.parametrize("key", REFUSED)
def test_the_line_of_the_key_is_told_that_gave_the_last_impossible_value(tmp_path: Path, key: str) -> None:
    path = tmp_path / "try.toml"
    path.write_text('name = "try"\nseed = 1\n[signal]\nrate_hz = 32768\nduration_s = 0.1\n' + PART, encoding="utf-8")
    recipe = load_recipe(str(path))
    with pytest.raises(InvalidParameter) as refused:
        REFUSED[key]()
    redraws = [Redraw("machine", k, refused.value.field, str(refused.value)) for k in range(MOST_ATTEMPTS)]
    told = str(given_up(recipe, recipe.part[0], "machine 0", redraws))
    lines = path.read_text(encoding="utf-8").splitlines()
    line = 1 + next(k for k, text in enumerate(lines) if text.startswith(f"{key} ="))
    assert f"try.toml, line {line}: part[1]" in told
    assert str(refused.value) in told
