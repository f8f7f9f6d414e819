"""What was refused while drawing is named by the key of the recipe that it was drawn for."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from datagen.recipes.defect_settings import Combination
from datagen.recipes.recipe import load_recipe
from datagen.recipes.recipe_schema import recipe_schema
from datagen.scenarios.deciders import DECIDERS
from datagen.scenarios.redraw import MOST_ATTEMPTS, given_up
from datagen.scenarios.refused import Redraw
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
    words = str(given_up(recipe, 0, "machine 0", redraws, None))
    lines = path.read_text(encoding="utf-8").splitlines()
    line = 1 + next(k for k, text in enumerate(lines) if text.startswith(f"{key} ="))
    assert re.search(rf"try\.toml, line {line}: part\[1\]\.\S*\b{key} = ", words)
    assert str(refused.value) in words


def words(tmp_path: Path, text: str, *refused: tuple[str, str], kind: Combination | None = None) -> str:
    """The message after draws of one part, meant to be of that kind, were refused for these parameters and reasons."""
    path = tmp_path / "try.toml"
    path.write_text('name = "try"\nseed = 1\n[signal]\nrate_hz = 65536\nduration_s = 0.1\n' + text, encoding="utf-8")
    recipe = load_recipe(str(path))
    redraws = [Redraw("record", attempt, field, reason) for attempt, (field, reason) in enumerate(refused)]
    return str(given_up(recipe, 0, "record 3", redraws, kind))


SPALLS = """[[part]]
name = "one"
records = 1
machine.rig = "gearbox"
[part.defect]
condition = {choice = ["line", "extended"]}
depth_um = 9
[part.defect.line]
extent_spacing = 0.5
[part.defect.extended]
extent_spacing = {uniform = [1, 20]}
"""


def test_draws_refused_for_one_reason_are_told_with_every_setting_that_it_follows_from(tmp_path: Path) -> None:
    reason = "60 balls of 7.120 mm do not fit"
    message = words(tmp_path, PART + "\n[part.machine.factors]\nball_diameter = 2\n", *[("ball_diameter", reason)] * 3)
    assert message.endswith(
        'try.toml, line 12: part[1].machine.ball_diameter_mm = 7.12: record 3 of part "one": all 3 draws were '
        "impossible for the same reason: 60 balls of 7.120 mm do not fit (this also follows from "
        "part[1].machine.factors.ball_diameter = 2.0)"
    )


def test_draws_refused_for_several_reasons_are_counted_and_the_last_is_told(tmp_path: Path) -> None:
    message = words(tmp_path, PART, ("load", "too much"), ("clearance", "too loose"), ("load", "too little"))
    assert "line 16: part[1].operation.load_n = 346.0: " in message
    assert (
        "3 draws in a row were impossible (refused: load 2 times, clearance 1 times); the last: too little" in message
    )


WAVES = """
[part.operation]
load_n = 0
[[part.imperfections.waviness]]
race = "outer"
orders = [2, 3]
amplitude_um = 1
"""


def test_a_load_follows_from_waviness_only_where_the_shaft_cannot_rest(tmp_path: Path) -> None:
    text = '[[part]]\nname = "one"\nrecords = 1\nmachine.rig = "gearbox"\n' + WAVES
    assert "waviness" not in words(tmp_path, text, ("load", "it gives the contact no width"))
    message = words(tmp_path, text, ("equilibrium", "no position of the shaft carries the load of 0 N"))
    assert message.endswith("(this also follows from part[1].imperfections.waviness[1].amplitude_um = 1.0)")


def test_a_wave_too_high_follows_from_the_decay_of_waves_and_not_of_tones(tmp_path: Path) -> None:
    tones = "[background]\nmains_hum = {amplitude_m_s2 = 1, decay = 3}\n"
    text = tones + '[[part]]\nname = "one"\nrecords = 1\nmachine.rig = "gearbox"\n' + WAVES + "decay = -4\n"
    message = words(tmp_path, text, ("amplitude", "amplitude of order 3 = 1.0 m"))
    assert "waviness[1].amplitude_um = 1.0: " in message
    assert message.endswith("(this also follows from part[1].imperfections.waviness[1].decay = -4.0)")


def test_only_settings_that_hold_for_the_kind_of_spall_that_was_refused_are_told(tmp_path: Path) -> None:
    for condition, other, line in ("line", "extended", 14), ("extended", "line", 16):
        message = words(tmp_path, SPALLS, ("extent", "it is not"), kind=(condition, "outer", "tukey"))
        assert f"line {line}: part[1].defect.{condition}.extent_spacing = " in message
        assert f'record 3 of part "one", meant to be {condition} (outer race, profile tukey): all 1 draws' in message
        assert message.endswith(
            '(this also follows from part[1].defect.condition = {choice = ["line", "extended"]}, '
            'part[1].machine.rig = "gearbox")'
        )
        assert f"defect.{other}" not in message


def test_what_a_table_of_the_kind_replaces_is_not_told(tmp_path: Path) -> None:
    text = SPALLS.replace("depth_um = 9\n", "depth_um = 9\nextent_mm = 40\n")
    for condition in ("line", "extended"):
        assert "extent_mm" not in words(tmp_path, text, ("extent", "no"), kind=(condition, "outer", "tukey"))
    assert "extent_mm" in words(tmp_path, text, ("extent", "no"))


def test_of_a_record_that_was_to_be_healthy_no_spall_is_told(tmp_path: Path) -> None:
    message = words(tmp_path, SPALLS, ("depth", "no"), kind=("healthy", "outer", "tukey"))
    assert 'try.toml, line 6: part[1]: record 3 of part "one", meant to be healthy: all 1 draws' in message


def test_a_parameter_that_the_recipe_says_nothing_of_is_told_by_its_part(tmp_path: Path) -> None:
    assert "try.toml, line 6: part[1]: record 3 of part" in words(tmp_path, SPALLS, ("cage", "too fast"))
    assert "try.toml, line 6: part[1]: record 3 of part" in words(tmp_path, SPALLS, ("", "no field"))


def test_settings_of_the_whole_recipe_that_hold_for_the_part_are_told(tmp_path: Path) -> None:
    chain = "[chain]\nmounting_cutoff_hz = 9000\n"
    assert "line 7: chain.mounting_cutoff_hz = 9000.0: " in words(tmp_path, chain + SPALLS, ("cutoff", "too high"))
    own = PART.replace("mounting_cutoff_hz = 9000\n", "")
    assert "part[1]: record 3" in words(tmp_path, chain + own, ("cutoff", "too high"))


def test_every_setting_that_a_parameter_is_said_to_follow_from_is_a_key_of_recipes() -> None:
    properties = [definition.get("properties", {}) for definition in recipe_schema()["$defs"].values()]
    keys = {key for table in properties for key in table}
    assert {key for names in DECIDERS.values() for name in names for key in name.split(".")} <= keys
