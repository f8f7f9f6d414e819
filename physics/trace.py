"""What a simulation gives back: the response, what touched when, and how it was made."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Array, Flags
from physics.checks import require, require_not_negative


@dataclass(frozen=True)
class ContactChanges:
    """Every located change of the contact set, in time order, shapes (E,).

    `time` s; `row` and `ball` count from 1; `made` is True where contact begins and False where it is lost.
    `initial` (rows, balls) says which balls touch at the trace's first instant.
    """

    time: Array
    row: NDArray[np.int16]
    ball: NDArray[np.int16]
    made: Flags
    initial: Flags

    def before(self, end: float) -> ContactChanges:
        """Those before an `end` (s)."""
        early = self.time < end
        return ContactChanges(self.time[early], self.row[early], self.ball[early], self.made[early], self.initial)


@dataclass(frozen=True)
class Kept:
    """What else a trace keeps besides acceleration and contact changes.

    `state`: displacements and velocities; `force`: the normal force of every ball; `outer`: the outer ring's motion, at
    a multiple of the rate. `fastest_path` (Hz; 0: none): the frequency of the fastest resonance on the sensor's path
    that this motion is to drive, for which the multiple has to be large enough.

    Raises InvalidParameter if `fastest_path` is no frequency, or is given without `outer`.
    """

    state: bool = False
    force: bool = False
    outer: bool = False
    fastest_path: float = 0.0

    def __post_init__(self) -> None:
        require_not_negative("fastest_path", self.fastest_path, "Hz")
        problem = f"fastest_path = {self.fastest_path} Hz; without the outer ring's motion nothing follows it"
        require(self.outer or self.fastest_path == 0.0, problem, "fastest_path")


ACCELERATION_ALONE = Kept()
# Fields of Kept that a way to respond may be unable to fill.
KEEPABLE = ("state", "force", "outer")


@dataclass(frozen=True)
class OuterMotion:
    """The outer ring's `displacement` (m), `velocity` (m/s) and `acceleration` (m/s²) along x and y, (R, 2) each, at
    `rate` (Hz)."""

    rate: float
    displacement: Array
    velocity: Array
    acceleration: Array

    def from_sample(self, first: int) -> OuterMotion:
        """The motion without the samples before the `first`."""
        return OuterMotion(self.rate, self.displacement[first:], self.velocity[first:], self.acceleration[first:])


@dataclass(frozen=True)
class Trace:
    """The response of a Scene sampled at `rate` (Hz).

    `model` is "nonlinear 6-DOF" or the name of a simpler one (`ladder.model_table`). `method` is what solved it: one of
    `integrators.method_table.METHODS`, "modal, repeated" where the last period of a modal march stands for all later
    ones, or a simpler model's own.
    `step` (s): of the modal method the mean over the march, of methods with fixed steps each step's length away from
    contact changes and kinks, of dormand_prince the longest it may take; NaN of the reference method, which does not
    count its steps, and of simpler models that solve nothing in steps.

    `time` (T,) s from 0, or from before it where a lead-in is kept;
    `acceleration` (T, 2) of the resonator's mass along x and y, m/s²;
    `state` (T, 12): displacements (xi, yi, xo, yo, xr, yr) in m, then velocities in m/s, or None if not asked for;
    `contact_force` (T, rows, balls) normal force of each ball in N, or None if not asked for;
    `outer`: the outer ring's motion at a whole multiple of `rate`, or None if not asked for. Where the multiple is
    above 1 it goes on behind the last sample, for as long as the low-pass to `rate` looks ahead, 24 samples of it.
    `error_estimate` is the estimated RMS error of the acceleration relative to its RMS, of fixed steps by how far a
    response at half the step, or an even finer one, is apart, over the whole march and before its rate is lowered; NaN
    if it was not estimated.
    `sensitivity` says how many times the errors of its steps a short pilot was wrong by; NaN if that was not measured.
    `chaotic`: errors grow faster than shorter steps could reduce them, so compare spectra, not samples.
    `silent`: the response is so small (physics/response/silence.py) that it may be rounding alone.
    `tension_share` is the share of contact time (summed over balls) in which the contact force pulls; NaN where the
    forces of single balls were not followed, as by the reference method, the impulse train and the linear model.
    `unlocated_changes` counts changes of contact that many tries did not locate; they were taken at the ends of steps.
    Both, and `step`, are of the whole march: with a lead-in of all of it, also where it is not kept, and of a response
    that repeats itself of what was marched.
    """

    rate: float
    time: Array
    acceleration: Array
    changes: ContactChanges
    model: str
    method: str
    step: float
    error_estimate: float
    tension_share: float
    unlocated_changes: int = 0
    state: Array | None = None
    contact_force: Array | None = None
    outer: OuterMotion | None = None
    sensitivity: float = math.nan
    chaotic: bool = False
    silent: bool = False
