"""Which scene a chart is of."""

import dataclasses

import numpy as np
import pytest

from datagen.charts.scenes import find_subject
from datagen.errors import BadInput
from physics.reference_scenes import REFERENCE_SCENES, reference_scene

RATE = 65536.0


@pytest.mark.parametrize("name", REFERENCE_SCENES)
def test_every_reference_scene_can_be_charted_by_name(name):
    subject = find_subject(name)
    assert subject.scene.duration == 0.5
    assert subject.rate == RATE
    assert subject.scene.rig.name == {"G": "gearbox", "F": "fan"}[name[0]]


def test_a_speed_is_given_after_an_at_sign():
    fast = find_subject("G1@3")
    assert fast.name == "G1_3x"
    assert fast.scene.operation.shaft_speed == pytest.approx(3.0 * fast.scene.rig.rated_speed, rel=1e-15)
    assert "1260 rpm" in fast.title


def test_slip_is_given_after_a_tilde_and_one_percent_is_that_of_the_reference_scenes():
    slipping = find_subject("G1@3~1")
    assert slipping.name == "G1_3x_slip1"
    assert "1 % slip" in slipping.title
    assert slipping.scene == reference_scene("G1", 0.5, slip_seed=1, speed_factor=3.0)
    knots = {percent: find_subject(f"F2~{percent}").scene.cage.knot_values for percent in (0, 1, 4)}
    assert knots[0] == ()
    np.testing.assert_allclose(knots[4], 4.0 * np.array(knots[1]), rtol=0.0, atol=5e-12)  # rounded to 1e-12 each


@pytest.mark.parametrize("scene", ["G1@1_0", "G1~1_0", "G1@", "G1@3~", "G1@~1", "G1~1@3"])
def test_what_is_no_number_behind_a_sign_is_refused(scene):
    with pytest.raises(BadInput, match=r"^SCENE = "):
        find_subject(scene)


@pytest.mark.parametrize(("alias", "name"), [("gearbox", "G1"), ("fan", "F1"), ("fan@3~1", "F1@3~1")])
def test_a_rig_by_its_name_is_its_line_spall(alias, name):
    assert find_subject(alias) == find_subject(name)


def test_a_dataset_is_charted_by_its_bare_name_as_other_commands_take_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert find_subject("quickstart", 3).name == "quickstart_3"


def test_a_record_of_a_recipe_can_be_charted(tiny_recipe):
    with pytest.raises(BadInput, match="lasts"):
        find_subject(str(tiny_recipe))
    subject = find_subject("datasets/quickstart", 3)
    assert subject.name == "quickstart_3"
    assert subject.scene.duration <= 0.5


def test_the_first_part_of_a_scene_ends_for_both_cages():
    subject = find_subject("G1")
    scene = dataclasses.replace(subject.scene, second_cage=subject.scene.cage)
    part = dataclasses.replace(subject, scene=scene).lasting(0.2)
    assert (part.cage.duration, part.second_cage.duration) == (0.2, 0.2)
