"""Every kernel that records need, compiled before the first record waits for it."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from physics._jit import discard_cache, is_cached, raised_by_cache
from physics.assembly import assemble
from physics.backgrounds.tones import tones
from physics.cage import CagePath
from physics.catalog import rig
from physics.contact.forces import Contacts
from physics.contact_events import contact_events
from physics.integrators.modal.flow import AMPLITUDES, LinearFlow, linear_flow
from physics.integrators.modal.memory import STRIDES, Memory, ModalGrid, memory_for
from physics.integrators.modal.modal_march import begin, march_modal
from physics.integrators.modal.tables import empty_tables, tables_for
from physics.integrators.output import Output
from physics.motion import motion_model
from physics.operation import Operation
from physics.paths.profile import race_depth
from physics.recursive_filter import filtered
from physics.response.kinks import known_kinks
from physics.response.march_output import empty_output
from physics.response.resampling import decimate, read_at, read_repeated
from physics.rms import stretches_apart
from physics.scene import Scene
from physics.sensor.mode import SensorMode, mode_accelerations
from physics.simulate import simulate
from physics.spall import Spall
from physics.statics.ball_load import ball_load
from physics.statics.load_distribution import require_equilibrium
from physics.statics.stiffness_series import stiffness_series
from physics.trace import ACCELERATION_ALONE, ContactChanges, OuterMotion

RATE, SAMPLES = 65536.0, 128
# Looking for garbage, of which compiling makes next to none, would take this process a twelfth longer.
MARCHING = "import gc; gc.disable(); from physics.warming import compile_march; compile_march()"


def warm_up() -> None:
    """Compile every kernel that records need, or load it from the cache; a cache damaged by a crash is made again.

    Where the march is not compiled and there are two processors, a second process compiles it beside all else.
    """
    if not is_warm() and (os.cpu_count() or 1) > 1:
        with _march_compiled_beside():
            _use_kernels_beside_the_march(_scene())
    try:
        _use_every_kernel()
    except Exception as error:
        if not raised_by_cache(error):
            raise
        discard_cache()
        _use_every_kernel()


def is_warm() -> bool:
    """Whether the march is compiled, which takes longest. Other kernels say nothing of it: to draw a scenario, or to
    read features, compiles a few."""
    return is_cached(march_modal)


def compile_march() -> None:
    """Compile the modal march, and nothing that is only called before or after it."""
    scene = replace(_scene(), spalls=())
    contacts, flow, grid, memory, output = _before_a_march(scene)
    march_modal(contacts, flow, grid, known_kinks(scene, contacts), memory, output)


def _before_a_march(scene: Scene) -> tuple[Contacts, LinearFlow, ModalGrid, Memory, Output]:
    """What a march of a single sample is given, made without a kernel that the march does not need."""
    contacts, flow = assemble(scene), linear_flow(motion_model(scene), (1e8, 1e8), (1.0, 1.0))
    grid = ModalGrid(
        samples=1,
        interval=1.0 / RATE,
        levels=len(STRIDES),
        share=1.0,
        least=1.0,
        seen=1.0,
        seen_samples=1.0,
        spending=1.0,
    )
    memory = memory_for(flow, np.zeros(AMPLITUDES), empty_tables(), contacts.balls.shape)
    return contacts, flow, grid, memory, empty_output(contacts, 1, 1, ACCELERATION_ALONE)


@contextmanager
def _march_compiled_beside() -> Iterator[None]:
    """Another process compiles the march while the block runs; should it fail, the march is compiled on first use."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    with subprocess.Popen([sys.executable, "-c", MARCHING], env=environment, stderr=subprocess.DEVNULL):
        yield


def _scene() -> Scene:
    machine = rig("gearbox")
    cage = CagePath(machine.bearing.cage_speed(machine.rated_speed), SAMPLES / RATE)
    spall = Spall("outer", 1, math.radians(270.0), 0.02, 1e-5, 0.005, 0.005, profile="ball_path")
    return Scene(machine, Operation(machine.rated_speed, machine.rated_load), cage, (spall,))


def _use_every_kernel() -> None:
    scene = _scene()
    simulate(scene, RATE)
    _use_kernels_beside_the_march(scene)


def _use_kernels_beside_the_march(scene: Scene) -> None:
    still, time = np.zeros((SAMPLES, 2)), np.zeros(1)
    contacts, flow, grid, memory, output = _before_a_march(scene)
    begin(contacts, flow, grid, memory, output)
    tables_for(flow, 1.0 / RATE)
    require_equilibrium(scene, time)
    read_at(still, time)
    read_repeated(still, 6, 1.0, 1)
    stretches_apart(still, 0, 0, 1)
    decimate(mode_accelerations([SensorMode(RATE / 8.0, 0.1)], OuterMotion(RATE, still, still, still)), 2)
    stiffness_series(scene, 1.0 / RATE, SAMPLES)
    ball_load(scene, time, 1, np.ones(1, np.int16))
    race_depth(scene, 1, time)
    contact_events(_no_changes(scene), 1, np.ones(1, np.int16), time, time)
    filtered(still, [((1.0, 0.0, 0.0), (0.0, 0.0))])
    tones(np.ones(1), np.ones(1), np.zeros((1, 2)), 1, RATE)


def _no_changes(scene: Scene) -> ContactChanges:
    none, initial = np.zeros(0, np.int16), np.zeros((scene.rig.bearing.rows, scene.rig.bearing.balls), np.bool_)
    return ContactChanges(np.zeros(0), none, none, np.zeros(0, np.bool_), initial)
