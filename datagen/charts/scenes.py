"""Which scene a chart is of: a named reference scene, at a multiple of its speed if wanted, or a recipe's record."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from datagen.errors import BadInput
from physics.reference_scenes import REFERENCE_SCENES, reference_scene
from physics.scene import Scene

RATE = 65536.0
LONGEST = 0.5
SHORTEST = 0.2


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


def find_subject(source: str, record: int) -> Subject:
    """The scene `source` names: G0 … F2r, the same with @3 for three times the speed, or a recipe's `record`.

    Raises BadInput for an unknown name or recipe, and for a record too short to be scored.
    """
    name, _, factor = source.partition("@")
    if name in REFERENCE_SCENES:
        return _named(name, factor)
    from datagen.recipes.recipe import load_recipe
    from datagen.scenarios.sampling import draw_scenario

    if not Path(source).exists() and "/" not in source and not source.endswith(".toml"):
        raise BadInput(field="SCENE", value=source, allowed=f"{', '.join(REFERENCE_SCENES)}, or a recipe")
    recipe = load_recipe(Path(source))
    recipe.place(record)
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


def _named(name: str, factor: str) -> Subject:
    try:
        times = float(factor or 1.0)
    except ValueError:
        times = 0.0
    if not 0.01 <= times <= 100.0:
        raise BadInput(field="SCENE", value=f"{name}@{factor}", allowed=f"{name}@0.01 to {name}@100")
    scene = reference_scene(name, LONGEST, speed_factor=times)
    title = f"{name}, {scene.rig.name} rig at {scene.operation.shaft_speed * 9.549296585513721:.4g} rpm"
    return Subject(name if times == 1.0 else f"{name}_{times:g}x", title, scene, RATE)
