"""A scene made ready for the modal method, and a march through it that can be gone on with."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from physics.arrays import Array
from physics.assembly import assemble
from physics.contact.forces import Contacts
from physics.integrators.modal.error_growth import memory_of_errors, ringing
from physics.integrators.modal.flow import LinearFlow, amplitudes_of, linear_flow
from physics.integrators.modal.memory import RETUNE, SHORTEST, STRIDES, UNITS, Memory, ModalGrid, memory_for
from physics.integrators.modal.modal_march import MOST_STEPS_PER_SAMPLE, begin, march_modal
from physics.integrators.modal.tables import tables_for
from physics.integrators.output import LOG_FULL, Output
from physics.integrators.stops import Stops
from physics.motion import MotionModel, motion_model, starting_state
from physics.response.change_log import room_for_changes
from physics.response.kinks import known_kinks
from physics.response.march_output import empty_output, require_done
from physics.scene import Scene
from physics.statics.load_distribution import Equilibrium
from physics.trace import ACCELERATION_ALONE, Kept

# Steps and contact changes a sample that share the error: their pushes add up like noise.
USUAL_PUSHES = 0.3
# Share of the shortest wave of a race that a ball covers in a step at most. Over more of it the rates at both ends
# (count_dips) say nothing of a crest between. A far smaller share would bind on common races too: their coarse and fine
# responses would take the same steps, which hides how errors grow.
WAVE_SHARE = 0.5
# N/m; the modes need a spring between the rings even where no ball is pressed: one so soft that a kilogram on it swings
# at 5 Hz.
SMALLEST_STIFFNESS = 1e3


@dataclass(frozen=True)
class Case:
    """What every march of a scene from the state `start` (12,) on a grid of `rate` (Hz) has in common; `error_memory`
    (s): how long its contacts may make errors grow; `fine`: whether floors far below the usual accuracy matter."""

    scene: Scene
    flow: LinearFlow
    error_memory: float
    contacts: Contacts
    stops: Stops
    start: Array
    rate: float
    fine: bool = False

    @cached_property
    def ringing(self) -> float:
        """What a push of 1 N s leaves in the resonator's acceleration, m²/s³ per (N s)²."""
        return ringing(self.flow, self.scene.duration)

    def amplitudes(self, push: float) -> Array:
        """Amplitudes (12,) of the modes at t = 0, after a `push` (N s) between the rings, halfway between x and y."""
        state, momentum = self.start.copy(), math.sqrt(0.5) * push
        state[6:8] -= momentum / self.scene.rig.inner_mass
        state[8:10] += momentum / self.scene.rig.outer_mass
        return amplitudes_of(self.flow, state)

    @cached_property
    def tables(self) -> tuple[Array, Array]:
        """Weights of the steps of whole units."""
        return tables_for(self.flow, 1.0 / self.rate)

    @cached_property
    def longest(self) -> float:
        """Longest step (s): a free ball that meets a crest of a wavy race is seen by its motion at both ends."""
        scene, fastest = self.scene, 0.0  # rad/s, of the waves under the balls
        for wave in scene.imperfections.waviness:
            for cage in scene.cages:
                fastest = max(fastest, wave.order * abs(cage.mean_speed - scene.race_speed(wave.race)))
        return WAVE_SHARE * 2.0 * math.pi / fastest if fastest > 0.0 else math.inf

    @property
    def push(self) -> float:
        """Momentum (N s) a step may be wrong by for an error of 1 m/s² (RMS), at the usual number of pushes."""
        return 1.0 / math.sqrt(self.ringing * USUAL_PUSHES * self.rate)

    def pushed(self, output: Output) -> float:
        """What the errors of the steps of `output` add up to in the resonator's acceleration (m/s², RMS of both
        axes)."""
        return math.sqrt(0.5 * self.ringing * float(output.spent[0]) * self.rate / output.acceleration.shape[0])


def case_of(scene: Scene, rest: Equilibrium, rate: float, fineness: int = 1) -> Case:
    """`scene` made ready for marches at `rate` (Hz) from the first of the positions at which it is `resting`, over
    paths with a `fineness` times as many cells as usual."""
    motion, contacts = motion_model(scene), assemble(scene, fineness)
    flow, start = mean_flow(motion, rest), starting_state(motion, rest.displacement[0])
    memory = memory_of_errors(flow, rest.stiffness[:, :2].std(axis=0))
    stops = known_kinks(scene, contacts, STRIDES[-1] / rate)
    return Case(scene, flow, memory, contacts, stops, start, rate, fine=fineness > 1)


def mean_flow(motion: MotionModel, rest: Equilibrium) -> LinearFlow:
    """Modes of `motion` with the mean contact stiffness and damping of the positions `rest`."""
    stiffness, damping = rest.stiffness.mean(axis=0), rest.damping.mean(axis=0)
    kx, ky = (max(float(stiffness[axis]), SMALLEST_STIFFNESS) for axis in range(2))
    return linear_flow(motion, (kx, ky), (float(damping[0]), float(damping[1])))


@dataclass
class March:
    """A march of `case` over up to `samples`, begun with a `push` (N s) between the rings, with a contact set of its
    own: others of the case do not disturb it."""

    case: Case
    samples: int
    keep: Kept = ACCELERATION_ALONE
    push: float = 0.0
    output: Output = field(init=False)
    _contacts: Contacts = field(init=False)
    _memory: Memory | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        shared = self.case.contacts
        self._contacts = shared._replace(balls=shared.balls.copy(), frames=shared.frames.copy())
        capacity = room_for_changes(0, self.case.scene.duration)
        self.output = empty_output(shared, self.samples, capacity, self.keep)

    def go_on(self, grid: ModalGrid) -> Output:
        """The output, filled up to the samples of `grid`.

        Raises SimulationFailed if the response stops being finite, contact changes more often than can be logged, or
        steps become too many.
        """
        case, contacts = self.case, self._contacts
        if self._memory is None:
            start = case.amplitudes(self.push)
            self._memory = memory_for(case.flow, start, case.tables, contacts.balls.shape, case.longest, case.fine)
            begin(contacts, case.flow, grid, self._memory, self.output)
        self._memory.marks[RETUNE] = 0  # the grid may be another one than before
        status = LOG_FULL
        while status == LOG_FULL:
            status = march_modal(contacts, case.flow, grid, case.stops, self._memory, self.output)
            if status == LOG_FULL:
                self.output = _with_longer_log(self.output, case.scene)
        require_done(
            status,
            f"down to {SHORTEST * grid.interval / UNITS:.3g} s",
            f"more than {MOST_STEPS_PER_SAMPLE} steps a sample of {case.rate:.6g} Hz would be needed",
        )
        return self.output


def _with_longer_log(output: Output, scene: Scene) -> Output:
    full = output.change_time.size
    more = room_for_changes(full, scene.duration) - full
    return output._replace(
        change_time=np.concatenate([output.change_time, np.zeros(more)]),
        change_ball=np.concatenate([output.change_ball, np.zeros(more, dtype=np.int64)]),
        change_made=np.concatenate([output.change_made, np.zeros(more, dtype=np.bool_)]),
    )
