"""Portraits made by hand, for tests of drawing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from datagen.drawing.portrait import Portrait
from labels.description import label_values
from labels.envelope import band_envelope, default_band
from labels.truth import ball_passes
from physics import catalog
from physics.cage import CagePath
from physics.imperfections import Imperfections, Waviness
from physics.operation import Operation
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall
from physics.statics.load_distribution import require_equilibrium

RATE, DURATION = 32768.0, 0.25
BOTTOM = math.radians(270.0)

LINE = Spall("outer", 1, BOTTOM, math.radians(2.0), 12e-6, math.radians(0.3), math.radians(0.3))
SCENES = {
    "healthy": ("gearbox", [], ()),
    "line, outer": ("gearbox", [LINE], ()),
    "extended, outer": ("gearbox", [Spall("outer", 2, BOTTOM, math.radians(40.0), 4e-6)], ()),
    "line, inner, deep gap": ("fan", [Spall("inner", 1, 1.0, math.radians(3.0), 1e-3, profile="ball_path")], ()),
    "healthy but wavy": ("fan", [], (Waviness("outer", 9, 1e-6), Waviness("inner", 5, 2e-6))),
}


@pytest.fixture
def portrait():
    """Function (name of a scene, clean=True, noise=0.05, **changes) → its portrait: a quarter of a second."""
    return made_portrait


def made_portrait(name, clean=True, noise=0.05, **changes):
    rig_name, spalls, waves = SCENES[name]
    rig = catalog.rig(rig_name)
    cage = CagePath(rig.bearing.cage_speed(rig.rated_speed), DURATION, 0.2)
    scene = Scene(rig, Operation(rig.rated_speed, rig.rated_load), cage, tuple(spalls), Imperfections(waves))
    trace = simulate(scene, RATE)
    measured = trace.acceleration + noise * np.random.default_rng(1).standard_normal(trace.acceleration.shape)
    band = default_band(rig, RATE)
    time = np.linspace(0.0, DURATION, 2001)
    labels = label_values(scene) | {"record": 5, "snr_db": 12.0, "error_estimate": 2e-4, "envelope_band": band}
    made = dict(
        corpus="made by hand",
        scene=scene,
        labels=labels,
        rate=RATE,
        acceleration=measured,
        clean=trace.acceleration if clean else None,
        envelope=band_envelope(measured[:, 1], RATE, band),
        stiffness_time=time,
        stiffness=require_equilibrium(scene, time).stiffness.T,
        passes=ball_passes(scene, trace.changes, DURATION),
    )
    return Portrait(**made | changes)
