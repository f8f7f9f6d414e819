"""Which scene a chart is of: a named reference scene, at a multiple of its speed or with slip, or a recipe's record."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

from datagen.errors import BadInput
from datagen.files.number_texts import number
from datagen.recipes.operation_settings import MOST_SLIP_DEVIATION
from datagen.recipes.recipe_files import shipped_recipes
from physics.angular_speed import in_rpm
from physics.reference_scenes import REFERENCE_SCENES, reference_scene, slipping
from physics.scene import Scene
from physics.spelling import suggestion

RATE = 65536.0
LONGEST = 0.5
SHORTEST = 0.2
RIG_NAMES = {"gearbox": "G1", "fan": "F1"}
NAMES = (*REFERENCE_SCENES, *RIG_NAMES)
SLOWEST, FASTEST = 0.01, 100.0
MOST_SLIP = 100.0 * MOST_SLIP_DEVIATION  # %
SLIP_SEED = 1
FORM = re.compile(r"(?P<name>[^@~]*)(?:@(?P<times>[^@~]+))?(?:~(?P<slip>[^@~]+))?")


@dataclass(frozen=True)
class Subject:
    """A scene to measure on, its sampling rate (Hz) and the names by which chart and files call it."""

    name: str
    title: str
    scene: Scene
    rate: float

    def lasting(self, duration: float) -> Scene:
        """The first `duration` (s) of the scene."""
        scene = self.scene
        second = None if scene.second_cage is None else replace(scene.second_cage, duration=duration)
        return replace(scene, cage=replace(scene.cage, duration=duration), second_cage=second)


def find_subject(source: str, record: int | None = None) -> Subject:
    """The scene that `source` names: a reference scene first, or else the `record` of a recipe, 0 by default.

    G0 to F2r, and gearbox and fan for G1 and F1; @3 behind the name turns it three times as fast, ~1 lets its cage slip
    at random by 1 %, and @3~1 does both. A recipe is a file, its folder or the name of a dataset. Raises BadInput for
    what is none of these, for a record of a reference scene, and for one too short to be scored.
    """
    if re.split("[@~]", source)[0] not in NAMES:
        return _record_of(source, record or 0)
    subject = _named(source)
    if record is not None:
        raise BadInput(
            f"{source} is one scene without records", field="--record", value=record, allowed="with a recipe only"
        )
    return subject


def _record_of(source: str, record: int) -> Subject:
    from datagen.recipes.recipe import load_recipe
    from datagen.scenarios.sampling import draw_scenario

    shipped = shipped_recipes()
    if not Path(source).exists() and "/" not in source and not source.endswith(".toml") and source not in shipped:
        allowed = f"{', '.join(NAMES)} (with @3, ~1 or @3~1), {', '.join(shipped)}, or a recipe"
        raise BadInput(field="SCENE", value=source, allowed=allowed + suggestion(source, (*NAMES, *shipped)))
    recipe = load_recipe(Path(source))
    recipe.require(record, "--record")
    scenario = draw_scenario(recipe, record)
    if scenario.duration < SHORTEST:
        raise BadInput(
            f"record {record} lasts {scenario.duration:g} s",
            file=source,
            field="--record",
            allowed=f"{SHORTEST} s or more",
        )
    whole = Subject(f"{recipe.name}_{record}", f"{recipe.name}, record {record}", scenario.scene, scenario.rate)
    return replace(whole, scene=whole.lasting(min(LONGEST, scenario.duration)))


def _named(source: str) -> Subject:
    form = FORM.fullmatch(source)
    times, slip = (number(form["times"] or "1"), number(form["slip"] or "0")) if form else (math.nan, math.nan)
    if form is None or not (SLOWEST <= times <= FASTEST and 0.0 <= slip <= MOST_SLIP):
        name = re.split("[@~]", source)[0]
        speeds, slips = f"{name}@{SLOWEST:g} to {name}@{FASTEST:g}", f"{name}~0 to {name}~{MOST_SLIP:g}"
        allowed = f"{speeds} (times its speed), {slips} (% slip), or both, as in {name}@3~1"
        raise BadInput(field="SCENE", value=source, allowed=allowed)
    name = RIG_NAMES.get(form["name"], form["name"])
    scene = reference_scene(name, LONGEST, speed_factor=times)
    title = f"{name}, {scene.rig.name} rig at {in_rpm(scene.operation.shaft_speed):.5g} rpm"
    if times != 1.0:
        name += f"_{times:g}x"
    if slip > 0.0:
        name, title = f"{name}_slip{slip:g}", f"{title}, {slip:g} % slip"
        scene = slipping(scene, 0.01 * slip, SLIP_SEED)
    return Subject(name, title, scene, RATE)
