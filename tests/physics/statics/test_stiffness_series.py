"""Stiffness solved sparsely agrees with stiffness solved at every instant, wherever balls come, go, drop and roll."""

import dataclasses
import math

import numpy as np
import pytest
from at_rest import BOTTOM, EXTENDED, LINE

from physics.imperfections import Imperfections, Waviness
from physics.statics.load_distribution import require_equilibrium
from physics.statics.stiffness_series import coarsest_stride, stiffness_series

RATE = 65536.0
SAMPLES = 6001  # no multiple of any stride
ALLOWED = 1e-5  # RMS over kyy: a tenth of what the stored trace may miss
WORST = 2e-3  # over kyy, one instant beside a corner of the form √t
BUMPS = (0.0, *np.random.default_rng(3).normal(0.0, 3e-7, 60).tolist(), 0.0)
ACROSS = np.linspace(-0.5, 0.5, 201)
DIP = dataclasses.replace(
    EXTENDED,
    depth=0.0,
    entry_taper=0.0,
    exit_taper=0.0,
    profile="table",
    table_angle=tuple((EXTENDED.extent * ACROSS).tolist()),
    table_depth=(0.0, *(3e-6 * (1.0 + np.cos(2.0 * np.pi * ACROSS[1:-1]))).tolist(), 0.0),
)
SPALLS = {
    "healthy": (),
    "line": (LINE,),
    "two rows": (LINE, dataclasses.replace(LINE, row=2, angle=BOTTOM + 0.05)),
    "extended": (EXTENDED,),
    "inner": (dataclasses.replace(EXTENDED, race="inner"),),
    "sharp": (dataclasses.replace(LINE, entry_taper=0.0, exit_taper=0.0),),
    "ball path": (dataclasses.replace(LINE, profile="ball_path", entry_taper=0.0, exit_taper=0.0),),
    "rough line": (dataclasses.replace(LINE, extent=math.radians(6.0), roughness_values=BUMPS),),
    "measured dip": (DIP,),
    "short": (dataclasses.replace(LINE, extent=math.radians(0.1), entry_taper=0.0, exit_taper=0.0),),
}
SCENES = {
    "usual": {},
    "clearance": {"bearing": {"clearance": 20e-6}},
    "rollers": {"bearing": {"exponent": 10 / 9, "load_deflection": 4e8}},
    "waviness": {"imperfections": Imperfections(waviness=(Waviness("inner", 25, 5e-7), Waviness("outer", 9, 5e-7)))},
    "turning load": {"operation": {"load_fluctuation": 0.3, "unbalance_force": 100.0}},
    "unequal balls": {"imperfections": Imperfections(ball_deviation=((3e-7, *(0.0,) * 11), (0.0,) * 12))},
}


@pytest.mark.parametrize(
    ("spalls", "variant"), [*((spalls, "usual") for spalls in SPALLS), *(("line", variant) for variant in SCENES)]
)
def test_the_series_is_the_trace_solved_at_every_instant(gearbox, build_scene, spalls, variant):
    scene = build_scene(gearbox, *SPALLS[spalls], **SCENES[variant])
    exact = require_equilibrium(scene, np.arange(SAMPLES) / RATE).stiffness
    series, estimate, _ = stiffness_series(scene, 1.0 / RATE, SAMPLES)
    missed = (series - exact) / exact[:, 1].mean()
    error = np.sqrt(np.mean(missed**2, axis=0)).max()
    assert error <= ALLOWED
    assert np.abs(missed).max() <= WORST
    assert error <= estimate
    assert estimate <= 1e-4  # what the stored trace may miss


@pytest.mark.parametrize("spalls", ["healthy", "line", "extended", "measured dip"])
def test_most_instants_between_the_events_are_not_solved(gearbox, build_scene, spalls):
    assert stiffness_series(build_scene(gearbox, *SPALLS[spalls]), 1.0 / RATE, SAMPLES).solved < 0.25


def test_while_a_ball_is_on_a_rough_surface_every_instant_is_solved(gearbox, build_scene):
    rough = dataclasses.replace(EXTENDED, roughness_values=BUMPS)
    scene = build_scene(gearbox, rough)
    time = np.arange(SAMPLES) / RATE
    assert coarsest_stride(scene, 1.0 / RATE) == 1
    series, error, solved = stiffness_series(scene, 1.0 / RATE, SAMPLES)
    exact = require_equilibrium(scene, time).stiffness
    assert solved == 1.0
    assert np.sqrt(np.mean((series - exact) ** 2, axis=0)).max() <= error * exact[:, 1].mean() <= ALLOWED * exact.max()


def test_the_stride_shows_every_ball_pass_and_every_wave(gearbox, build_scene):
    assert (
        coarsest_stride(build_scene(gearbox), 1.0 / RATE) == 16
    )  # 48 passes of the inner race a second, 64 nodes each
    # 14.1 instants a node of the inner race, 20.5 of the outer one, whose balls pass more slowly
    assert coarsest_stride(build_scene(gearbox), 1.0 / 45_000.0) == 8
    waves = Imperfections(waviness=(Waviness("outer", 120, 1e-8),))
    assert coarsest_stride(build_scene(gearbox, imperfections=waves), 1.0 / RATE) == 4  # 840 waves a second, 16 nodes
    assert coarsest_stride(build_scene(gearbox), 1.0) == 1


def test_without_load_there_is_no_stiffness_and_no_error(fan, build_scene):
    series, error, _ = stiffness_series(build_scene(fan, operation={"load": 0.0}), 1.0 / RATE, 100)
    assert np.array_equal(series, np.zeros((100, 3)))
    assert error == 0.0
