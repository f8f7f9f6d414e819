"""Scenes that random searches have found wrong once, kept as they were found: small changes make most of them right."""

import json
from pathlib import Path

import pytest

from physics.bearing import Bearing
from physics.cage import CagePath
from physics.imperfections import Imperfections, Waviness
from physics.operation import Operation
from physics.request import FixedSteps
from physics.rig import Rig
from physics.rms import rms
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall

FOLDER = Path(__file__).with_name("found_scenes")


def tuples(value):
    """JSON's lists as tuples, within one another."""
    return tuple(map(tuples, value)) if isinstance(value, list) else value


def plain(kind, values):
    return kind(**{name: tuples(value) for name, value in values.items()})


def found_scene(name):
    held = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    imperfections = held["imperfections"]
    return Scene(
        rig=Rig(**held["rig"] | {"bearing": Bearing(**held["rig"]["bearing"])}),
        operation=Operation(**held["operation"]),
        cage=plain(CagePath, held["cage"]),
        spalls=tuple(plain(Spall, spall) for spall in held["spalls"]),
        imperfections=Imperfections(
            waviness=tuple(Waviness(**wave) for wave in imperfections["waviness"]),
            ball_deviation=tuples(imperfections["ball_deviation"]),
        ),
        contact_law=held["contact_law"],
    )


@pytest.mark.parametrize(
    ("name", "rate", "once"),
    [
        # A free ball grazes a lip between the instants that are looked at; seen, it was not confirmed and dropped.
        ("lip_grazed_within_a_step", 51200.0, 6.56e-2),
        # The pilot sees a quiet beginning; nearly all of the signal, and of its error, comes a tenth of a second later.
        ("loud_behind_the_pilot", 65536.0, 1.48e-3),
        # Errors grow a hundredfold within two ball passes and fade again; a coarse response was twice the error apart.
        ("errors_that_grow_for_a_while", 32768.0, 1.95e-3),
        # One ball carries the load in much clearance; the rings swing beside it long after the pilot has looked.
        ("one_ball_in_much_clearance", 65536.0, 7.79e-2),
    ],
)
def test_what_was_wrong_once_keeps_its_accuracy_now(name, rate, once):
    """`once`: the error that was made when 1e-3 was asked for and about half of that or less was said."""
    scene = found_scene(name)
    exact = simulate(scene, rate, FixedSteps(64))
    trace = simulate(scene, rate)
    error = rms(trace.acceleration - exact.acceleration) / rms(exact.acceleration)
    assert error <= trace.error_estimate <= 1e-3 < once
