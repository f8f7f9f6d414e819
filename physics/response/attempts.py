"""Responses made again: until they are exact enough, until a finer one confirms them, or until it is clear that none
will."""

from __future__ import annotations

import math
from typing import NamedTuple

from physics.integrators.modal.memory import ModalGrid
from physics.integrators.output import STEPS, Output
from physics.outcome import SimulationFailed
from physics.response.goal import (
    AIM,
    ROUND_OFF,
    Goal,
    fewest_touching,
    finer,
    observed_sensitivity,
    rms_distance,
    safety_factor,
)
from physics.response.modal_case import March
from physics.rms import rms

# A beginning made with more than this many times the tolerance that the scene turns out to need is made again.
CALM = 1.5
# No further attempt is made after one that has left more than this share of the error.
MOST_ATTEMPTS, WORTHWHILE = 4, 0.5
# The next one aims at this share of what would just do, and at no more than that share of what the last one aimed at.
NEXT_SHARE, MOST_NEXT = 0.7, 0.5
# A response of more than this sensitivity may be chaotic, and is to be confirmed.
CHAOTIC = 50.0
# To make a response again it is made with this share of the tolerance at most; to confirm one, at first with SURE.
FINER, SURE = 0.25, 1.0 / 16.0
# Of a response that is farther than this share of its size from a coarser one no point is known.
LOST = 0.1
# Distances between responses shrink with this power of the tolerance, or with a higher one if the responses show it:
# errors of impacts begin to shrink late.
LATE = 0.5
# The finer of two responses may be this many times as wrong as their distance leaves to hope for.
CONFIRMED = 6.0
# How many more are made to confirm one; none after one that took MUCH_WORK times the steps of the one to be confirmed.
MOST_CONFIRMATIONS, MUCH_WORK = 4, 7
# For a finer response to be worth a first or a second attempt, two that are LOST must not be so within this share of
# the samples; a third is not made of them. That share grew at most 2.6 times when the tolerance became MUCH_FINER (in
# 100 such scenes of 2780 of the wide corpus, from 0.1 to 1 s long).
SOON = (0.15, 0.4)
# The next one has at least this share of the tolerance of the one before, and at most SURE.
MUCH_FINER = 1.0 / 256.0


def to_accuracy(goal: Goal, march: March, seen: float, sensitivity: float) -> tuple[Output, ModalGrid]:
    """The response of a scene of this `sensitivity` with an estimated error within the goal, and the grid that gave it.

    The first attempt goes on with the `march` that may have begun, unless steps are to be more exact; more begin anew.
    `seen` (m²/s⁴) is what to take for the mean square of the signal.
    """
    aim, error = AIM / safety_factor(sensitivity), math.inf
    if safety_factor(sensitivity) > CALM:
        march = goal.begin()
    for _ in range(MOST_ATTEMPTS):
        grid = goal.aimed(seen, aim, sensitivity)
        output = goal.go_on(march, grid)
        size = rms(output.acceleration)
        before, error = error, goal.error(output, sensitivity)
        if error <= goal.allowed(size) or error > WORTHWHILE * before or goal.allowed(size) == 0.0:
            break
        aim *= min(MOST_NEXT, NEXT_SHARE * goal.allowed(size) / error)
        seen = size**2
        march = goal.begin()
    return output, grid


def confirm_doubtful(goal: Goal, output: Output, grid: ModalGrid, sensitivity: float) -> tuple[Output, float, float]:
    """The response made again with a smaller tolerance than that of the `output`'s grid; its estimated error (m/s²,
    RMS), infinite if no trajectory is known, and the sensitivity that follows from both.

    Where that is CHAOTIC or the rings part, until another one confirms it; else once more, to that sensitivity, if that
    is not within the goal.
    """
    sure = sensitivity > CHAOTIC or fewest_touching(output) == 0
    share = SURE if sure else min(FINER, 1.0 / safety_factor(sensitivity))
    grid = finer(grid, share)
    again = goal.anew(grid)
    sensitivity = max(sensitivity, observed_sensitivity(goal.case, output, again))
    if sensitivity > CHAOTIC or fewest_touching(again) == 0:
        return *_confirmed(goal, _pair(output, again, share), grid, sensitivity), sensitivity
    size = rms(again.acceleration)
    if goal.error(again, sensitivity) > goal.allowed(size):
        again, _ = to_accuracy(goal, goal.begin(), size**2, sensitivity)
    return again, goal.error(again, sensitivity), sensitivity


class Pair(NamedTuple):
    """A `coarse` response and a `fine` one with this `share` of its tolerance, their `distance` and the `size` of the
    fine one (m/s², RMS)."""

    coarse: Output
    fine: Output
    share: float
    distance: float
    size: float

    @property
    def lost(self) -> bool:
        """Whether they are so far apart that no point of the response is known."""
        return self.distance > LOST * self.size

    @property
    def error(self) -> float:
        """Error of the fine one (m/s², RMS), estimated from how far apart both are."""
        return CONFIRMED * self.distance * self.share**LATE

    def lost_within(self, share: float) -> bool:
        """Whether they are LOST already in this share of the samples."""
        return rms_distance(self.coarse, self.fine, share) > LOST * self.size


def _pair(coarse: Output, fine: Output, share: float) -> Pair:
    return Pair(coarse, fine, share, rms_distance(coarse, fine), rms(fine.acceleration))


def _confirmed(goal: Goal, pair: Pair, grid: ModalGrid, sensitivity: float) -> tuple[Output, float]:
    """The fine response of the `pair`, which is on `grid`, or the first finer one, that is well within the goal of the
    one before; and the error (m/s², RMS) that follows from this.

    Two that erred alike are near to each other all the same: what a scene of this `sensitivity` makes of the errors of
    the fine one's steps counts too. Where they are LOST too SOON for the attempts that are left, the error is infinite.
    """
    most, power = MUCH_WORK * int(pair.coarse.tally[STEPS]), LATE
    for attempt in range(MOST_CONFIRMATIONS):
        allowed = goal.allowed(pair.size)
        error = max(pair.error, goal.error(pair.fine, sensitivity))
        if error <= allowed:
            return pair.fine, error
        if pair.lost and (attempt >= len(SOON) or pair.lost_within(SOON[attempt])):
            break
        if int(pair.fine.tally[STEPS]) > most:
            break
        share = _next_share(pair, allowed, power)
        grid = finer(grid, share)
        try:
            following = _pair(pair.fine, goal.anew(grid), share)
        except SimulationFailed:
            break  # no finer one can be made
        power, pair = _observed_power(pair, following), following
    return pair.fine, math.inf if pair.lost else max(pair.error, goal.error(pair.fine, sensitivity))


def _next_share(pair: Pair, allowed: float, power: float) -> float:
    """The share of the tolerance that should bring the error within what is `allowed` (m/s², RMS), if distances shrink
    with tolerances to this `power`."""
    if pair.lost:
        return MUCH_FINER
    expected = CONFIRMED * pair.distance * pair.share**power
    return min(max((allowed / expected) ** (1.0 / power), MUCH_FINER), SURE) if expected > 0.0 else SURE


def _observed_power(pair: Pair, following: Pair) -> float:
    """The power of the tolerance with which the distance has shrunk from one pair to the following, LATE to 1."""
    distance = max(following.distance, ROUND_OFF * following.size)
    if distance == 0.0 or pair.distance == 0.0:
        return 1.0
    return min(max(math.log(distance / pair.distance) / math.log(pair.share), LATE), 1.0)
