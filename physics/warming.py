"""Every kernel that records need, compiled before the first record waits for it."""

from __future__ import annotations

import math

import numpy as np

from physics._jit import discard_cache
from physics.backgrounds.tones import tones
from physics.cage import CagePath
from physics.catalog import rig
from physics.operation import Operation
from physics.paths.profile import race_depth
from physics.response.resampling import decimate, read_at
from physics.scene import Scene
from physics.sensor.mode import SensorMode, mode_accelerations
from physics.simulate import simulate
from physics.spall import Spall
from physics.statics.ball_load import ball_load
from physics.statics.stiffness import stiffness_trace
from physics.statics.stiffness_series import stiffness_series


def warm_up() -> None:
    """Compile every kernel that records need, or load it from the cache; a cache damaged by a crash is made again."""
    try:
        _use_every_kernel()
    except Exception:
        discard_cache()
        _use_every_kernel()


def _use_every_kernel() -> None:
    machine, rate, samples = rig("gearbox"), 65536.0, 128
    cage = CagePath(machine.bearing.cage_speed(machine.rated_speed), samples / rate)
    spall = Spall("outer", 1, math.radians(270.0), 0.02, 1e-5, 0.005, 0.005, profile="ball_path")
    scene = Scene(machine, Operation(machine.rated_speed, machine.rated_load), cage, (spall,))
    trace = simulate(scene, rate)
    read_at(trace.acceleration, trace.time)
    still = np.zeros((2, 2))
    decimate(mode_accelerations([SensorMode(rate / 8.0, 0.1)], still, still, still, rate), 2)
    stiffness_series(scene, 1.0 / rate, samples)
    stiffness_trace(scene, trace.time[:1])
    ball_load(scene, trace.time[:1], 1, np.ones(1, np.int16))
    race_depth(scene, 1, np.zeros(1))
    tones(np.ones(1), np.ones(1), np.zeros((1, 2)), 1, rate)
