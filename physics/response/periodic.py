"""The response of a machine without slip: marched until it repeats itself from ball to ball, and then read again.

Where nothing but the balls moves past the load, every ball does after a pass what the one before it did. The march goes
on at a rate of which the period of this is a whole number of samples, until one period tells all later ones.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from physics.arrays import Array
from physics.integrators.modal.flow import slowest_decay
from physics.integrators.modal.memory import ModalGrid
from physics.integrators.output import Output
from physics.integrators.propagator import fast_periods
from physics.motion import motion_model
from physics.paths.profile import is_rough
from physics.response.adaptive import PILOT_SAMPLES, respond_accurately
from physics.response.asked import Asked
from physics.response.modal_case import March
from physics.response.resampling import read_at, read_repeated
from physics.rms import rms, stretches_apart
from physics.scene import Scene
from physics.trace import ContactChanges, Trace

REPEATED = "modal, repeated"
# The response is read between samples of the march: so many a period of the fastest mode, and at least so many for each
# one asked for.
SAMPLES_READ_AGAIN, LEAST_DENSITY = 16.0, 3
# A record must hold this many periods, or repeating spares too little; fewer where a spall is rough and steps short.
FEWEST_PERIODS, FEWEST_ROUGH_PERIODS = 20, 12
# So many periods show how a slow part of the transient falls.
FEWEST_MARCHED = 3
# Of the accuracy asked for: what the march may be wrong by, and how far its last period may be from all later ones.
MARCHED_SHARE, REPEATED_SHARE = 0.85, 0.4
# A spall that a ball passes in fewer samples than this leaves spikes that lie between the samples that are read.
FEWEST_SAMPLES_A_PASS = 2.0
# Corners of the acceleration, where contacts change, are not read to a finer accuracy than this.
FINEST_ACCURACY = 3e-4


def balls_a_period(scene: Scene) -> int:
    """How many balls have to pass until `scene` is as it was, but for their numbers; 0 if it never is."""
    even = len({cage.mean_speed for cage in scene.cages}) == 1 and not any(cage.knot_values for cage in scene.cages)
    if not even or scene.turns_with_the_shaft:
        return 0
    return 1 if scene.balls_are_alike else scene.rig.bearing.balls


def period_of(scene: Scene) -> float:
    """Time (s) after which the response of `scene` repeats itself once it has settled; infinite if it never does."""
    balls = balls_a_period(scene)
    return balls * scene.rig.bearing.spacing / scene.cage.mean_speed if balls else math.inf


def worth_repeating(scene: Scene, duration: float, accuracy: float) -> bool:
    """Whether `duration` (s) holds enough periods of the response, and they can be read to the relative `accuracy`."""
    rough = any(is_rough(spall, scene.rig.bearing) for spall in scene.spalls)
    fewest = FEWEST_ROUGH_PERIODS if rough else FEWEST_PERIODS
    return fewest * period_of(scene) <= duration and accuracy >= FINEST_ACCURACY


def respond_until_repeated(asked: Asked) -> Trace:
    """As `respond_accurately`, of a scene that has a period; what comes after the march repeats its last period.

    Step and share of tension are those of the march. Where repeating would not keep the accuracy, it is marched to the
    end.
    """
    scene, rate, samples = asked.scene, asked.rate, asked.samples
    if any(spall.extent * rate < FEWEST_SAMPLES_A_PASS * scene.cage.mean_speed for spall in scene.spalls):
        return respond_accurately(asked)
    period, density, duration = period_of(scene), _density(scene, rate), samples / rate
    cells = math.ceil(density * rate * period)
    marching = _Repeating(cells, REPEATED_SHARE * asked.accuracy, REPEATED_SHARE * asked.least_error)
    finer = replace(
        asked,
        rate=cells / period,
        samples=cells * math.ceil(duration / period),
        accuracy=MARCHED_SHARE * asked.accuracy,
        least_error=MARCHED_SHARE * asked.least_error,
    )
    marched = respond_accurately(finer, go_on=marching.go_on, pilot=density * PILOT_SAMPLES)
    trace = _read_again(scene, marched, marching, rate, samples)
    if trace.error_estimate > asked.accuracy and trace.error_estimate * rms(trace.acceleration) > asked.least_error:
        return respond_accurately(asked)
    return trace


def _density(scene: Scene, rate: float) -> int:
    """How many times as dense as asked for, at `rate` (Hz), the samples of the march are."""
    return max(LEAST_DENSITY, math.ceil(fast_periods(motion_model(scene), 1.0 / rate) * SAMPLES_READ_AGAIN))


def _read_again(scene: Scene, marched: Trace, marching: _Repeating, rate: float, samples: int) -> Trace:
    """The trace of `samples` at `rate` (Hz) that was `marched` at another rate, its last period again and again."""
    period, duration = period_of(scene), samples / rate
    time, end = np.arange(samples) / rate, marched.time.size / marching.cells * period
    last = marched.acceleration[-marching.cells :]
    left = marching.away(marched.acceleration) / rms(last) if end < duration and last.any() else 0.0
    return replace(
        marched,
        rate=rate,
        time=time,
        method=REPEATED if end < duration else marched.method,
        acceleration=read_repeated(marched.acceleration, marching.cells, marching.cells / (period * rate), samples),
        changes=_repeated_changes(scene, marched.changes, end, duration),
        error_estimate=math.hypot(marched.error_estimate, left, _reading_error(last)),
    )


def _reading_error(signal: Array) -> float:
    """Estimated RMS error of reading between the samples of `signal` (T, 2), relative to its RMS.

    Of every other sample, read between the rest: at a corner of the signal twice what it is with all of them, and more
    where the signal is smooth.
    """
    half = np.arange(signal.shape[0] // 2 - 1)
    size = rms(signal)
    return 0.5 * rms(read_at(signal[0::2], half + 0.5) - signal[1::2][half]) / size if size > 0.0 else 0.0


class _Repeating:
    """Goes on with a march of `cells` samples a period until its periods are alike: to the `share` of their RMS, or to
    `least_error` (m/s², RMS)."""

    def __init__(self, cells: int, share: float, least_error: float) -> None:
        self.cells, self.share, self.least_error, self._decay = cells, share, least_error, 0.0

    def go_on(self, march: March, grid: ModalGrid) -> Output:
        """The output, up to the last period that was needed."""
        self._decay = slowest_decay(march.case.flow) * self.cells / march.case.rate
        for count in range(FEWEST_MARCHED, grid.samples // self.cells + 1):
            marched = count * self.cells
            output = march.go_on(grid._replace(samples=marched))
            output = output._replace(acceleration=output.acceleration[:marched])
            size = rms(output.acceleration[-self.cells :])
            if self.away(output.acceleration) <= max(self.share * size, self.least_error):
                break
        return output

    def away(self, acceleration: Array) -> float:
        """How far (m/s², RMS) the last of the periods so far is estimated to be from all later ones.

        What is left of the transient, were it to fall from now on as it did in the last half of the `acceleration`
        (T, 2), or no faster than the slowest mode decays; or what is left of a slow part of it, if that is more. The
        last period is held against all others of that half: a response that repeats itself only after two or more
        periods differs from its neighbour.
        """
        periods = acceleration.shape[0] // self.cells
        half = periods // 2
        # The last period of all, of the first half, and of the first quarter.
        last, middle, early = periods - 1, periods - half - 1, (periods - half) // 2 - 1
        apart = max(self._apart(acceleration, last, other) for other in range(middle, last))
        before = self._apart(acceleration, middle, early) if middle > 0 else math.inf
        if apart == 0.0 or apart >= before:
            return math.inf if apart > 0.0 else 0.0
        fallen = max(apart / before, math.exp(-self._decay * half))
        left = apart * fallen / (1.0 - fallen) if fallen < 1.0 else math.inf
        return max(left, self._slowly_left(acceleration, last, max(1, half // 2)))

    def _slowly_left(self, acceleration: Array, last: int, span: int) -> float:
        """How far (m/s², RMS) the `last` period is from all later ones by what goes on in one direction, or to and fro.

        Contacts can feed a part of the transient, which then falls more slowly than any mode decays, and at first is
        hidden behind the rest. Its fall is that of the way over the last `span` periods, as far as it goes along the
        way over those before; errors of the steps go in other directions.
        """
        now = self._apart(acceleration, last, last - span)
        before = self._apart(acceleration, last - span, last - 2 * span)
        along = 0.5 * (self._apart(acceleration, last, last - 2 * span) ** 2 - now**2 - before**2)
        fallen = along / before**2 if before > 0.0 else 0.0
        return now * abs(fallen) / (1.0 - fallen) if fallen < 1.0 else math.inf

    def _apart(self, acceleration: Array, one: int, other: int) -> float:
        """How far (m/s², RMS) two periods of the `acceleration` (T, 2) are apart."""
        return stretches_apart(acceleration, one * self.cells, other * self.cells, self.cells)


def _repeated_changes(scene: Scene, changes: ContactChanges, end: float, duration: float) -> ContactChanges:
    """The `changes` up to `end` (s), and those of the last period before it again and again up to `duration` (s)."""
    period, balls = period_of(scene), scene.rig.bearing.balls
    last = np.flatnonzero((changes.time >= end - period) & (changes.time < end))
    turn = np.arange(1, max(0, math.ceil((duration - end) / period)) + 1)
    time = (changes.time[last] + turn[:, None] * period).ravel()
    # A period later the next ball behind is where this one was.
    ball = ((changes.ball[last] - 1 - balls_a_period(scene) * turn[:, None]) % balls + 1).ravel()
    within = time < duration
    first = changes.time < min(end, duration)
    return replace(
        changes,
        time=np.concatenate([changes.time[first], time[within]]),
        row=np.concatenate([changes.row[first], np.tile(changes.row[last], turn.size)[within]]),
        ball=np.concatenate([changes.ball[first], ball[within].astype(np.int16)]),
        made=np.concatenate([changes.made[first], np.tile(changes.made[last], turn.size)[within]]),
    )
