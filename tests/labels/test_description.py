import dataclasses
import math

import numpy as np
import pytest

from labels.description import condition, label_values
from labels.schema import LABELS
from physics.spall import Spall

TYPES = {"str": str, "float64": float, "int64": int, "bool": bool}


def outer(extent, **changes):
    fields = {"race": "outer", "row": 1, "angle": 4.7, "extent": extent, "depth": 12e-6} | changes
    return Spall(**fields)


def test_every_label_of_the_scene_is_computed_with_its_type_and_an_allowed_value(make_scene, line_spall):
    for scene in (make_scene(), make_scene(line_spall)):
        values = label_values(scene)
        assert set(values) == {label.name for label in LABELS if label.source == "scene"}
        for label in LABELS:
            if label.source == "scene":
                assert isinstance(values[label.name], TYPES[label.dtype])
                assert label.values is None or values[label.name] in label.values


def test_a_spall_becomes_extended_at_one_ball_spacing(make_scene):
    spacing = 2.0 * math.pi / 12.0
    assert condition(make_scene()) == "healthy"
    assert condition(make_scene(outer(0.999 * spacing))) == "line"
    assert condition(make_scene(outer(spacing))) == "extended"


def test_the_size_is_given_as_arc_length_and_share_of_the_spacing(make_scene):
    values = label_values(make_scene(outer(math.radians(2.0), entry_taper=0.01, exit_taper=0.02, roughness=1e-6)))
    # L = Δφ · Ro with Ro = (Dp + Db) / 2 of the Koyo 1205.
    assert values["extent_mm"] == pytest.approx(math.radians(2.0) * (38.75 + 7.12) / 2.0, rel=1e-12)
    assert values["extent_spacing"] == pytest.approx(2.0 / 30.0, rel=1e-12)
    assert (values["entry_taper"], values["exit_taper"], values["roughness"]) == (0.01, 0.02, 1e-6)
    assert (values["depth"], values["profile"], values["location"]) == (12e-6, "tukey", "outer")


def test_an_inner_spall_is_measured_along_the_inner_race(make_scene):
    values = label_values(make_scene(outer(0.1, race="inner")))
    assert values["extent_mm"] == pytest.approx(0.1 * (38.75 - 7.12) / 2.0, rel=1e-12)
    assert values["location"] == "inner"


def test_the_longest_of_several_spalls_is_described(make_scene):
    values = label_values(
        make_scene(outer(0.03, depth=9e-6), outer(0.05, angle=4.0, depth=5e-6), outer(0.02, angle=3.0))
    )
    assert (values["spalls"], values["extent"], values["depth"]) == (3, 0.05, 5e-6)


def test_a_healthy_scene_has_zero_sizes(make_scene):
    values = label_values(make_scene())
    sizes = ("spalls", "extent", "extent_mm", "extent_spacing", "depth", "path_depth", "entry_taper", "exit_taper")
    assert all(values[name] == 0 for name in sizes)
    assert (values["condition"], values["location"], values["profile"], values["bridged"]) == (
        "healthy", "none", "none", False,
    )  # fmt: skip


def test_a_ball_over_a_narrow_deep_gap_is_carried_by_both_edges(make_scene):
    deep = label_values(make_scene(outer(math.radians(2.0), depth=1e-3, profile="ball_path")))
    assert deep["bridged"] is True
    # Check value: 19.1 µm for a deep gap of 2° on the outer race of the gearbox rig.
    assert deep["path_depth"] == pytest.approx(19.1e-6, abs=0.05e-6)
    shallow = label_values(make_scene(outer(math.radians(2.0), depth=10e-6, profile="ball_path")))
    assert shallow["bridged"] is False
    assert shallow["path_depth"] == pytest.approx(10e-6, rel=1e-6)  # the floor itself


def test_the_depth_of_a_measured_spall_is_the_largest_of_its_table(make_scene):
    table = {"profile": "table", "table_angle": (-0.05, 0.0, 0.05), "table_depth": (0.0, 7e-6, 0.0)}
    assert label_values(make_scene(outer(0.1, depth=0.0, **table)))["depth"] == 7e-6


def test_the_machine_and_how_it_runs_are_described(make_scene):
    values = label_values(make_scene())
    assert values["speed_rpm"] == pytest.approx(420.0, rel=1e-12)
    assert (values["load_n"], values["balls"], values["rows"]) == (346.0, 12, 2)
    assert values["bpfo"] * 7.0 == pytest.approx(34.283, abs=5e-4)  # last printed digit
    assert values["bpfo"] + values["bpfi"] == pytest.approx(12.0, rel=1e-12)


@pytest.mark.parametrize("duration", [0.13, 20.0])
def test_mean_and_deviation_of_the_slip_are_those_of_the_record_and_not_of_what_it_was_drawn_from(make_scene, duration):
    cage = dataclasses.replace(make_scene(slip=True, duration=duration).cage, mean_slip=0.01)
    time = np.linspace(0.0, duration, 2_000_001)
    slip = 1.0 - cage.speed(time) / cage.nominal_speed
    mean = np.trapezoid(slip, time) / duration
    deviation = math.sqrt(np.trapezoid((slip - mean) ** 2, time) / duration)
    values = label_values(dataclasses.replace(make_scene(duration=duration), cage=cage))
    assert values["mean_slip"] == pytest.approx(mean, abs=1e-9)  # trapezoids
    assert values["slip_deviation"] == pytest.approx(deviation, rel=1e-6)
    if duration == 20.0:
        assert values["slip_deviation"] == pytest.approx(0.01, rel=0.1)  # drawn with; some 690 correlation times


def test_a_cage_without_random_slip_slips_by_what_it_is_told(make_scene):
    scene = make_scene()
    values = label_values(dataclasses.replace(scene, cage=dataclasses.replace(scene.cage, mean_slip=0.01)))
    assert (values["mean_slip"], values["slip_deviation"]) == (0.01, 0.0)


def test_the_four_orders_of_the_bearing_are_told_each_by_its_own_label(make_scene):
    values, ratio = label_values(make_scene()), 7.12 / 38.75  # ball and pitch diameter of the Koyo 1205
    assert values["ftf"] == pytest.approx(0.5 * (1.0 - ratio), rel=1e-12)
    assert values["bpfo"] == pytest.approx(12.0 * 0.5 * (1.0 - ratio), rel=1e-12)
    assert values["bpfi"] == pytest.approx(12.0 * 0.5 * (1.0 + ratio), rel=1e-12)
    assert values["bsf"] == pytest.approx(0.5 / ratio * (1.0 - ratio**2), rel=1e-12)
