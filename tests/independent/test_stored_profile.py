"""The stored `profile_depth` is fine enough: a replay that reads balls' paths from its grid gives the same response."""

import dataclasses

import numpy as np
import pytest
import replay as script
from reference_scenes import reference_scene_json
from replay import replay, tabulate_spall

from datagen.records.profile_grid import PROFILE_POINTS, profile_grid
from physics.paths.profile import race_depths
from physics.reference_scenes import reference_scene

DURATION = 0.1
BEYOND = 5e-3  # rad of sound race on either side of a spall: more than a bump in it can lift the ball


def rms(signal):
    return float(np.sqrt(np.mean(np.square(signal))))


def stored_path(name, race):
    """A reference scene's text with its spall on a race, and the depth (points,) of row 1 as a record stores it."""
    text, scene = reference_scene_json(name, DURATION), reference_scene(name, DURATION)
    [defect], [spall] = text["defects"], scene.spalls
    defect["race"] = race
    rough = tuple(defect["roughness_values"])
    scene = dataclasses.replace(scene, spalls=(dataclasses.replace(spall, race=race, roughness_values=rough),))
    return text, race_depths(scene, PROFILE_POINTS).astype(np.float32).astype(float)[0]


def table_from(depth):
    """What replaces the replay's own reading of a spall: the stored points around it, in the direction of travel."""
    angle = profile_grid(PROFILE_POINTS)

    def from_grid(defect, _):
        sign = 1.0 if defect["race"] == "outer" else -1.0
        u = sign * ((angle - defect["phi_f"] + np.pi) % (2 * np.pi) - np.pi)
        near = np.flatnonzero(np.abs(u) < defect["extent"] / 2 + BEYOND)
        near = near[np.argsort(u[near])]
        step = angle[1] - angle[0]
        path = depth[near]
        return [defect["row"] - 1, defect["phi_f"], sign, u[near[0]], step], path, np.gradient(path, step)

    return from_grid


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "race"),
    [*((name, "outer") for name in ("G1", "G1p", "G2r", "F1", "F1p", "F2r")), ("G1", "inner"), ("F1p", "inner")],
)
def test_the_stored_path_moves_the_acceleration_by_less_than_a_thousandth(name, race, monkeypatch):
    text, depth = stored_path(name, race)
    expected = replay(text)["acceleration"]
    [place, path, _] = tabulate_spall(text["defects"][0], text["parameters"])
    monkeypatch.setattr(script, "tabulate_spall", table_from(depth))
    [stored_place, stored, _] = script.tabulate_spall(text["defects"][0], text["parameters"])
    assert stored_place[:3] == place[:3]
    at = stored_place[3] + stored_place[4] * np.arange(stored.size)
    own = np.interp(at, place[3] + place[4] * np.arange(path.size), path, left=0.0, right=0.0)
    np.testing.assert_allclose(stored, own, atol=1e-5 * path.max())  # single precision, and half a step of the grid
    found = replay(text)["acceleration"]
    assert rms(found - expected) < 1e-3 * rms(expected)
