"""The slow, trustworthy method: SciPy's DOP853 (order 8, adaptive) on a right-hand side written ball by ball.

Shares no kernel with the fast methods. It is restarted at every known kink of a spall's path and at every change of the
contact set, located on the dense output; in between the right-hand side is smooth, but for the cells of a rolled
path, which the step control takes.
Not to be confused with DOP853 run through such changes, which is neither of order 8 nor within its tolerance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import DOP853

from physics.arrays import Array, Flags
from physics.integrators.reference.equations import contact_set, slopes, write_equations
from physics.outcome import Outcome, SimulationFailed
from physics.paths.passages import passages
from physics.paths.profile import build_path
from physics.scene import Scene

# Of the deviation from the start, and of displacements in m; velocities have this times the resonance, in m/s.
RELATIVE_TOLERANCE, DISPLACEMENT_TOLERANCE = 1e-9, 1e-18
# Periods of the resonance. Requested times are read off the dense output, of order 7, which no tolerance of a step
# bounds: with twice this G2 was off by 2e-6 at 1e-9 and at 1e-13 alike.
LONGEST_STEP = 0.1
# A change of contact is looked for at so many instants of a step, and located within so many seconds.
LOOKS_PER_STEP, LOCATED_WITHIN = 8, 1e-13
KINK_HALF_WIDTH = 1e-11  # s
# Steps allowed for each of the longest ones that a record has room for, and a fixed reserve.
MOST_STEPS_PER_LONGEST, SPARE_STEPS = 200, 20_000


class Change(NamedTuple):
    """A change of contact at `time` (s): `ball` of `row`, both from 1, begins to touch if `made`, or ceases to."""

    time: float
    row: int
    ball: int
    made: bool


@dataclass(frozen=True)
class ReferenceSolution:
    """State (T, 12) at the requested times, the located changes of contact in time order, and who touches (rows, balls)
    at t = 0."""

    state: Array
    changes: list[Change]
    initial: Flags


def integrate_reference(scene: Scene, start_state: Array, times: Array) -> ReferenceSolution:
    """Response of `scene` from `start_state` (12,) at t = 0, sampled at the rising `times` (T,), s.

    Raises SimulationFailed if the state stops being finite or changes of contact use up the allowed number of steps.
    """
    return _Run(scene, np.asarray(start_state, dtype=np.float64), np.asarray(times, dtype=np.float64)).result()


class _Run:
    """One integration under way: time, deviation from the start, contact set, and what has been noted so far."""

    def __init__(self, scene: Scene, start: Array, times: Array) -> None:
        self.scene, self.start, self.times = scene, start, times
        self.equations = write_equations(scene)
        fastest = scene.rig.free_resonance
        self.longest_step = LONGEST_STEP * 2.0 * math.pi / fastest
        # Deviations, since the resonator moves by some 1e-10 m around a deflection of some 1e-5 m.
        self.tolerance = np.repeat([DISPLACEMENT_TOLERANCE, DISPLACEMENT_TOLERANCE * fastest], 6)
        self.now, self.deviation = 0.0, np.zeros(12)
        self.touching = contact_set(self.equations, 0.0, start)
        self.state = np.empty((times.size, 12))
        self.noted = 0
        self.changes: list[Change] = []
        self.steps_left = MOST_STEPS_PER_LONGEST * math.ceil(times[-1] / self.longest_step) + SPARE_STEPS

    def result(self) -> ReferenceSolution:
        """Integrate from kink to kink up to the last requested time."""
        bearing = self.scene.rig.bearing
        initial = self.touching.reshape(bearing.rows, bearing.balls).copy()
        end = float(self.times[-1])
        for kink in _kink_times(self.scene, end):
            self._integrate_to(kink - KINK_HALF_WIDTH)
            self._step_over(kink + KINK_HALF_WIDTH)
        self._integrate_to(end)
        self._note(end, lambda times: np.repeat(self.deviation[:, None], times.size, axis=1))
        return ReferenceSolution(self.state, self.changes, initial)

    def _rates(self, time: float, deviation: Array) -> Array:
        return slopes(self.equations, self.touching, time, self.start + deviation)

    def _integrate_to(self, end: float) -> None:
        """Integrate to `end`, starting afresh after each change of the contact set."""
        while self.now < end:
            solver = DOP853(
                self._rates,
                self.now,
                self.deviation,
                end,
                max_step=self.longest_step,
                rtol=RELATIVE_TOLERANCE,
                atol=self.tolerance,
            )
            while solver.status == "running" and not self._advance(solver):
                pass

    def _advance(self, solver: DOP853) -> bool:
        """One step of the solver, cut short at the first change of the contact set; True if there was one."""
        self._count_step()
        message = solver.step()
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            raise SimulationFailed(
                Outcome.NOT_FINITE, f"the reference method stopped at t = {self.now:.6g} s: {message or 'not finite'}"
            )
        dense = solver.dense_output()
        change = self._first_change(dense, self.now, solver.t)
        self._note(solver.t if change is None else change, dense)
        self.now = solver.t if change is None else change
        self.deviation = solver.y.copy() if change is None else dense(change)
        if change is not None:
            self._update_contact()
        return change is not None

    def _first_change(self, dense: Any, start: float, stop: float) -> float | None:
        """Time in (start, stop] just after the first change of the contact set, or None."""
        before = start
        for after in np.linspace(start, stop, LOOKS_PER_STEP + 1)[1:]:
            if self._disagrees(after, dense(after)):
                while after - before > LOCATED_WITHIN:
                    middle = 0.5 * (before + after)
                    if self._disagrees(middle, dense(middle)):
                        after = middle
                    else:
                        before = middle
                return float(after)
            before = after
        return None

    def _closed(self, time: float, deviation: Array) -> Flags:
        return contact_set(self.equations, time, self.start + deviation)

    def _disagrees(self, time: float, deviation: Array) -> bool:
        return bool(np.any(self._closed(time, deviation) != self.touching))

    def _update_contact(self) -> None:
        """Take over the contact set of this instant and log what changed."""
        closed = self._closed(self.now, self.deviation)
        balls = self.scene.rig.bearing.balls
        for index in np.flatnonzero(closed != self.touching):
            row, ball = divmod(int(index), balls)
            self.changes.append(Change(self.now, row + 1, ball + 1, bool(closed[index])))
        self.touching = closed

    def _step_over(self, end: float) -> None:
        """Cross a kink by one tiny straight step, so that no stage reads the path on its wrong side."""
        straight = self._rates(self.now, self.deviation)
        start, deviation = self.now, self.deviation
        self._note(end, lambda times: deviation[:, None] + straight[:, None] * (times - start))
        self.now, self.deviation = end, deviation + straight * (end - start)
        self._update_contact()

    def _note(self, until: float, dense: Any) -> None:
        """Write down the states at the requested times not yet noted, up to `until`."""
        last = int(np.searchsorted(self.times, until, side="right"))
        if last > self.noted:
            self.state[self.noted : last] = self.start + dense(self.times[self.noted : last]).T
            self.noted = last

    def _count_step(self) -> None:
        self.steps_left -= 1
        if self.steps_left < 0:
            raise SimulationFailed(
                Outcome.TOO_MANY_CHANGES,
                f"the reference method used up its steps at t = {self.now:.6g} s after {len(self.changes)} changes",
            )


def _kink_times(scene: Scene, end: float) -> Array:
    """Times (K,) strictly inside (0, end), s, at which a ball meets a kink of a spall's path, each once."""
    met = [np.zeros(0)]
    for index, spall in enumerate(scene.spalls):
        met += [passages(scene, index, arc, 0.0, end).time for arc in build_path(spall, scene.rig.bearing).breaks]
    times = np.sort(np.concatenate(met))
    times = times[(times > 10.0 * KINK_HALF_WIDTH) & (times < end - 10.0 * KINK_HALF_WIDTH)]
    return times[np.diff(times, prepend=-1.0) > 4.0 * KINK_HALF_WIDTH]
