"""A record of a response no larger than rounding says so, and nothing else of it."""

from dataclasses import replace

from datagen.recipes.recipe import load_recipe
from datagen.records.record import make_record
from datagen.scenarios.sampling import draw_scenario
from labels.description import label_values


def test_a_healthy_preloaded_record_is_to_be_taken_for_silence():
    drawn = draw_scenario(load_recipe("gearbox_rig"), 0)
    scene = drawn.scene
    tight = replace(scene.rig.bearing, clearance=-5e-6)
    scene = replace(
        scene, rig=replace(scene.rig, bearing=tight), operation=replace(scene.operation, load=0.0), spalls=()
    )
    record = make_record(replace(drawn, scene=scene))
    own = record.labels["validity"].removeprefix(label_values(scene)["validity"])
    assert "take it for silence" in own
    assert "chaotic" not in own
    assert "not reached" not in own
    assert "multiply errors" not in own
