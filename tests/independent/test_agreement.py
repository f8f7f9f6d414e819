"""Records simulated again from their scenario text alone, by code that imports nothing of the packages."""

import dataclasses
import json
import math

import numpy as np
import pytest
from reference_scenes import FAN, GEARBOX, REFERENCE_SCENES, reference_scene_json
from replay import march, replay

from datagen.scenarios.scenario import Scenario, Seeds
from datagen.scenarios.scenario_text import scenario_json
from physics.cage import CagePath, draw_slip_knots
from physics.catalog import rig
from physics.imperfections import Imperfections, Waviness
from physics.operation import Operation
from physics.reference_scenes import reference_scene
from physics.request import LeadIn
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall
from physics.trace import Kept

RATE = 65536.0
DURATION = 0.12
SETTLED = 0.03
LEAD_IN = 0.05


def cage(machine, start, seed, lead_in=0.0):
    speed = machine.bearing.cage_speed(machine.rated_speed)
    passing = machine.bearing.spacing / speed
    step, first, values = draw_slip_knots(np.random.default_rng(seed), 0.01, passing, DURATION, lead_in)
    return CagePath(speed, DURATION, start, 0.005, step, first, values)


def spall(race="outer", row=1, angle=270.0, **changes):
    edges = {"extent": 0.045, "depth": 12e-6, "entry_taper": 0.02, "exit_taper": 0.005} | changes
    return Spall(race, row, math.radians(angle), **edges)


def scene(name, *spalls, load=None, **changes):
    machine = rig(name)
    operation = Operation(machine.rated_speed, machine.rated_load, **(load or {}))
    return Scene(machine, operation, cage(machine, 0.2, 3), spalls, **changes)


def imperfections(balls):
    waves = (Waviness("outer", 15, 0.3e-6, 0.4), Waviness("inner", 40, 0.1e-6, 2.0))
    deviation = np.random.default_rng(1).normal(0.0, 0.3e-6, (2, balls))
    return Imperfections(waves, tuple(tuple(float(d) for d in row) for row in deviation))


def inclined(name, *spalls, **bearing_changes):
    straight = scene(name, *spalls)
    bearing = dataclasses.replace(straight.rig.bearing, **bearing_changes)
    machine = dataclasses.replace(straight.rig, bearing=bearing)
    return dataclasses.replace(straight, rig=machine, cage=cage(machine, 0.2, 3))


def rough_gap():
    values = 2e-6 * np.sin(np.linspace(0.0, 9 * np.pi, 41)) * np.sin(np.linspace(0.0, np.pi, 41))
    return spall(profile="ball_path", depth=20e-6, roughness=1e-6, roughness_values=(0.0, *values[1:-1], 0.0))


def table():
    angle = np.linspace(-0.02, 0.02, 21)
    return spall(
        race="inner",
        profile="table",
        extent=0.04,
        entry_taper=0.0,
        exit_taper=0.0,
        table_angle=tuple(angle),
        table_depth=tuple(8e-6 * (1 - (angle / 0.02) ** 2) * (1 + 30 * angle)),
    )


SCENES = {
    "a line spall on the outer race": lambda: scene("gearbox", spall()),
    "an inner spall on row 2 and the no-tension law": lambda: scene(
        "fan", spall("inner", 2, 300.0), contact_law="no_tension"
    ),
    "two deep gaps on the inner race": lambda: scene(
        "fan",
        spall("inner", 1, 250.0, profile="ball_path", depth=3e-4, entry_taper=0.0, exit_taper=0.0),
        spall("inner", 2, 20.0, profile="ball_path", depth=2e-5, entry_taper=0.0, exit_taper=0.0),
    ),
    "a rough surface under a rolling ball": lambda: scene("fan", rough_gap()),
    "a lopsided measured profile on the inner race": lambda: scene("fan", table()),
    "a wavy bearing with unequal balls under turning loads": lambda: scene(
        "fan",
        spall(),
        imperfections=imperfections(14),
        load={"unbalance_force": 30.0, "unbalance_phase": 0.7, "load_fluctuation": 0.2, "fluctuation_phase": 1.1},
    ),
    "separate cages": lambda: scene(
        "gearbox", spall(), spall(row=2, angle=280.0), second_cage=cage(rig("gearbox"), 0.9, 4)
    ),
    "a contact angle of 10 degrees": lambda: inclined("gearbox", spall(), contact_angle=math.radians(10.0)),
    "rollers": lambda: inclined("fan", spall(), exponent=10.0 / 9.0, load_deflection=8e7),
}


def text_of(made, rate, **fields):
    return scenario_json(
        Scenario(
            scene=made,
            rate=rate,
            seeds=Seeds(recipe=1, record=0, record_attempt=0, machine=0, machine_attempt=0),
            part="reference",
            bearing_id="B0",
            split="train",
            envelope_band=(1e3, 2e3),
            **fields,
        )
    )


def distance(found, expected):
    return np.sqrt(np.mean((found - expected) ** 2) / np.mean(expected**2))


@pytest.mark.parametrize("name", SCENES)
def test_a_record_made_again_from_its_text_alone_agrees_within_one_percent(name):
    made = SCENES[name]()
    again = replay(json.loads(text_of(made, RATE)), substeps=16)["acceleration"]
    ours = simulate(made, RATE).acceleration
    settled = slice(round(SETTLED * RATE), None)
    assert again.shape == ours.shape
    assert distance(ours[settled], again[settled]) < 0.01  # asked for; the replay's own error is up to 4e-3


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if number % 2 else name for number, name in enumerate(SCENES)]
)
def test_a_record_of_a_machine_that_has_run_before_agrees_with_its_text_from_the_first_sample_on(name):
    made = SCENES[name]()
    cages = {"cage": cage(made.rig, 0.2, 5, LEAD_IN)}
    if made.second_cage:
        cages["second_cage"] = cage(made.rig, 0.9, 6, LEAD_IN)
    made = dataclasses.replace(made, **cages)
    settle = round(LEAD_IN * RATE) / RATE
    again = replay(json.loads(text_of(made, RATE, settle=settle)), substeps=16)
    ours = simulate(made, RATE, keep=Kept(force=True), lead_in=LeadIn(LEAD_IN))
    assert ours.time[0] == again["time"][0] == 0.0
    assert again["acceleration"].shape == ours.acceleration.shape
    assert distance(ours.acceleration, again["acceleration"]) < 0.01
    assert distance(ours.contact_force, again["contact_force"]) < 0.01
    assert distance(simulate(made, RATE).acceleration[:1], again["acceleration"][:1]) > 0.9  # which begins at rest


@pytest.mark.parametrize(("rate", "factor"), [(16384.0, 7), pytest.param(25600.0, 5, marks=pytest.mark.slow)])
def test_a_record_at_a_low_rate_agrees_to_its_ends_once_it_is_lowered_as_its_text_says(rate, factor):
    made = scene("gearbox", spall())
    text = json.loads(text_of(made, rate))
    again = replay(text, substeps=32 * factor)["acceleration"]
    ours = simulate(made, rate).acceleration
    assert text["sampling"]["oversampling"] == factor
    assert again.shape == ours.shape
    samples = march(text, factor, 32)["acceleration"][::factor][: ours.shape[0]]
    assert distance(ours, again) < 1e-3  # the replay's own error at 32 steps a raised sample
    assert distance(ours, samples) > 8e-3  # what replays that knew no filter were away


@pytest.mark.parametrize(("name", "typed"), [("gearbox", GEARBOX), ("fan", FAN)])
def test_the_catalogue_s_rigs_are_those_typed_from_the_paper(name, typed):
    machine = rig(name)
    b = machine.bearing
    found = {
        "Nb": b.balls, "rows": b.rows, "Dp": b.pitch_diameter, "Db": b.ball_diameter, "alpha": b.contact_angle,
        "K": b.load_deflection, "n": b.exponent, "c": b.clearance, "m_i": machine.inner_mass,
        "m_o": machine.outer_mass, "m_r": machine.resonator_mass, "k_ox": machine.support_stiffness_x,
        "k_oy": machine.support_stiffness_y, "c_ox": machine.support_damping_x, "c_oy": machine.support_damping_y,
        "k_r": machine.resonator_stiffness, "c_r": machine.resonator_damping, "c_d": machine.film_damping,
        "omega_s": machine.rated_speed, "W": machine.rated_load,
    }  # fmt: skip
    assert found == pytest.approx(typed, rel=1e-12)  # decimal numbers typed twice
    assert reference_scene_json(name[0].upper() + "0")["parameters"]["row_offset"] == pytest.approx(b.stagger)


@pytest.mark.parametrize("name", REFERENCE_SCENES)
def test_the_reference_scenes_are_those_typed_a_second_time(name):
    built, typed = reference_scene(name), reference_scene_json(name)
    fields = {"phi_f": "angle", "extent": "extent", "depth": "depth", "roughness": "roughness", "row": "row"} | {
        edge: edge for edge in ("entry_taper", "exit_taper")
    }
    assert len(built.spalls) == len(typed["defects"])
    for spall, defect in zip(built.spalls, typed["defects"], strict=True):
        found = {key: getattr(spall, field) for key, field in fields.items()}
        assert found == pytest.approx({key: defect[key] for key in fields}, rel=1e-12)  # degrees typed twice
        assert (spall.race, spall.profile) == (defect["race"], defect["profile"])
    assert built.cage.nominal_speed == pytest.approx(typed["slip"]["nominal_speed"], rel=1e-12)
    assert (built.operation.load, built.contact_law) == (typed["parameters"]["W"], typed["contact_law"])
