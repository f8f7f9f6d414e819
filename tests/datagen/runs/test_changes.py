"""What is said of a recipe that has changed."""

from datagen.runs.changes import differing_settings


def test_the_same_recipe_differs_in_nothing():
    recipe = {"seed": 1, "part": [{"rig": "fan", "machine": {"balls": 9}}], "chain": None}
    assert differing_settings(recipe, {**recipe}) == ()


def test_changed_new_and_lost_settings_are_named_by_their_place_and_as_they_were():
    before = {"seed": 7, "part": [{"rig": "fan"}, {"rig": "gearbox", "load": {"uniform": [1, 2]}}], "title": "x"}
    now = {"seed": 8, "part": [{"rig": "fan"}, {"rig": "cwru", "load": {"uniform": [1, 3]}}], "licence": "MIT"}
    assert differing_settings(before, now) == (
        "seed = 7",
        'part[2].rig = "gearbox"',
        "part[2].load.uniform[2] = 2",
        'title = "x"',
        "licence = not set",
    )


def test_a_part_more_and_a_long_value_are_short_to_read():
    assert differing_settings({"part": [1]}, {"part": [1, {"rig": "fan"}]}) == ("part[2] = not set",)
    (said,) = differing_settings({"summary": "word " * 100}, {"summary": ""})
    assert said.endswith("...")
    assert len(said) < 60
