"""Maps of where a method holds."""

import dataclasses
import json
import math

import numpy as np
import pytest
from command_line import run

from datagen.charts import stability
from physics.outcome import Outcome, SimulationFailed
from physics.reference_scenes import reference_scene
from physics.request import FixedSteps
from physics.simulate import simulate

RATE = 65536.0
RIG = reference_scene("G1", 0.04).rig
PNG = b"\x89PNG\r\n"


def test_maps_tell_accurate_from_wrong_refused_and_unanswerable(monkeypatch, tmp_path):
    small = dataclasses.replace(stability.SWEEPS[0], values=(1.0, 1e5))
    monkeypatch.setattr(stability, "SWEEPS", (small,))
    monkeypatch.setattr(stability, "MARCHES", {"exponential_rk4": None})
    monkeypatch.setattr(stability, "DURATION", 0.02)
    code, shown, _ = run("chart", "--stability", "--out", tmp_path)
    assert code == 0
    assert "stability_maps.png" in shown
    maps = json.loads((tmp_path / "stability_maps.json").read_text())["maps"]
    chosen, fixed = maps
    assert chosen["method"] == "modal"
    asked = stability.ACCURACIES.index(1e-3)
    assert all(error < 1e-3 for error in (row[asked] for row in chosen["error"]))
    soft, stiff = fixed["error"]
    one_step = stability.STEPS.index(1.0)
    assert soft[one_step] < 1e-3  # the goal of the reference scenes
    assert soft[one_step - 1] < 0.1  # two samples a step, held against every other sample
    assert fixed["limit"][0] > 1.0 > fixed["limit"][1]
    assert stiff[one_step] is None or stiff[one_step] > 0.1
    for one in maps:
        words, errors = np.array(one["outcomes"]), np.array(one["error"], dtype=object)
        assert np.array_equal(words == "value", errors != None)  # noqa: E711
        ends = {each.name.lower().replace("_", " ") for each in Outcome}
        assert set(words.ravel()) <= {"value", "not converged", *ends}
    assert [row[one_step] for row in fixed["refused"]] == [False, True]
    assert not np.any(chosen["refused"])
    assert (tmp_path / "stability_maps.png").read_bytes().startswith(PNG)


def test_a_step_is_refused_on_the_map_where_simulate_refuses_it():
    soft = stability.SWEEPS[0].apply(reference_scene("G1", 0.01), 1e3)
    limit = stability.longest_step(soft, "exponential_rk4")
    assert 1.0 / 16.0 < limit < 1.0
    for steps in stability.STEPS_A_SAMPLE:
        try:
            simulate(soft, stability.RATE, FixedSteps(steps))
            outcome = None
        except SimulationFailed as failure:
            outcome = failure.outcome
        assert (outcome is Outcome.UNSTABLE_STEP) == stability.is_refused(1.0 / steps, limit)


@pytest.mark.parametrize(
    ("name", "value", "found", "expected"),
    [
        ("contact stiffness K", 10.0, lambda s: s.rig.bearing.load_deflection, 10.0 * RIG.bearing.load_deflection),
        ("resonator stiffness", 4.0, lambda s: s.rig.resonator_stiffness, 4.0 * RIG.resonator_stiffness),
        ("film damping", 1e3, lambda s: s.rig.film_damping, 1e3),
        ("load", 10.0, lambda s: s.operation.load, 3460.0),
        ("clearance", -5.0, lambda s: s.rig.bearing.clearance, -5e-6),
        ("speed", 3.0, lambda s: s.operation.shaft_speed, 2.0 * math.pi * 21.0),
        ("spall length", 10.0, lambda s: s.spalls[0].extent, math.radians(10.0)),
        ("spall depth", 30.0, lambda s: s.spalls[0].depth, 30e-6),
    ],
)
def test_each_quantity_of_the_maps_is_varied_in_its_unit(name, value, found, expected):
    (sweep,) = (sweep for sweep in stability.SWEEPS if sweep.name == name)
    assert found(sweep.apply(reference_scene("G1", 0.04), value)) == pytest.approx(expected, rel=1e-9)
