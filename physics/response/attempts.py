"""Responses made again: until they are exact enough, until a finer one confirms them, or until it is clear that none
will."""

from __future__ import annotations

import math

from physics.integrators.modal.memory import Stride
from physics.integrators.output import STEPS, Output
from physics.outcome import SimulationFailed
from physics.response.goal import AIM, ROUND_OFF, Goal, apart, fewest_touching, finer, rms, shown, tame
from physics.response.modal_case import March

# A response of more than this sensitivity may be chaotic, and is to be confirmed.
CHAOTIC = 50.0
# Of a response that is farther than LOST of its size from a coarser one no point is known. To confirm one, up to so
# many are made, with between MUCH_FINER and SURE of the tolerance of the one before.
LOST, MOST_CONFIRMATIONS = 0.1, 4
# None is made after one that took this many times the steps of the response to be confirmed.
MUCH_WORK = 7
MUCH_FINER, SURE = 1.0 / 256.0, 1.0 / 16.0
# What the share of the samples before they are LOST must exceed, with two attempts left and with one: it grew at most
# 2.6 times when the tolerance became MUCH_FINER (in 100 such scenes of 2780 of the wide corpus, from 0.1 to 1 s long).
SOON = (0.15, 0.4)
# Distances shrink with tolerances to this power, or to a higher one if the responses show it: impacts' errors shrink
# late.
LATE = 0.5
# The finer of two responses may be this many times as wrong as their distance leaves to hope for.
CONFIRMED = 6.0
# To say a response again it is made with this share of the tolerance at most.
FINER = 0.25
# A beginning made with more than this many times the tolerance that the scene turns out to need is made again.
CALM = 1.5
# No further attempt is made after one that has left more than this share of the error.
MOST_ATTEMPTS, WORTHWHILE = 4, 0.5


def to_accuracy(goal: Goal, march: March, seen: float, sensitivity: float) -> tuple[Output, Stride]:
    """The response of a scene of this `sensitivity` with an estimated error within the goal, and the grid that gave it.

    The first attempt goes on with the `march` that may have begun, unless steps are to be more exact; more begin anew.
    `seen` (m²/s⁴) is what to take for the mean square of the signal.
    """
    aim, error = AIM / tame(sensitivity), math.inf
    if tame(sensitivity) > CALM:
        march = goal.begin()
    for _ in range(MOST_ATTEMPTS):
        grid = goal.aimed(seen, aim, sensitivity)
        output = goal.go_on(march, grid)
        size = rms(output.acceleration)
        before, error = error, goal.error(output, sensitivity)
        if error <= goal.allowed(size) or error > WORTHWHILE * before:
            break
        aim *= min(0.5, 0.7 * goal.allowed(size) / error)
        seen = size**2
        march = goal.begin()
    return output, grid


def made_sure(goal: Goal, output: Output, grid: Stride, sensitivity: float) -> tuple[Output, float, float]:
    """The response made again with a smaller tolerance than that of the `output`'s grid; its estimated error (m/s²,
    RMS), infinite if no trajectory is known, and the sensitivity that both tell.

    Where that is CHAOTIC or the rings part, until another one confirms it; else once more, to that sensitivity, if that
    is not within the goal.
    """
    sure = sensitivity > CHAOTIC or fewest_touching(output) == 0
    share = SURE if sure else min(FINER, 1.0 / tame(sensitivity))
    grid = finer(grid, share)
    again = goal.anew(grid)
    sensitivity = max(sensitivity, shown(goal.case, output, again))
    if sensitivity > CHAOTIC or fewest_touching(again) == 0:
        return *_confirmed(goal, output, again, grid, share), sensitivity
    size = rms(again.acceleration)
    if goal.error(again, sensitivity) > goal.allowed(size):
        again, _ = to_accuracy(goal, goal.begin(), size**2, sensitivity)
    return again, goal.error(again, sensitivity), sensitivity


def _confirmed(goal: Goal, coarse: Output, fine: Output, grid: Stride, share: float) -> tuple[Output, float]:
    """The `fine` response on `grid`, or the first finer one, that is well within the goal of the one before, at first
    the `coarse` one with a `share` less tolerance; and the error (m/s², RMS) that this tells.

    Where they are LOST too SOON for the attempts that are left, the error is infinite.
    """
    most = MUCH_WORK * int(coarse.tally[STEPS])
    power, distance, size = LATE, apart(coarse, fine), rms(fine.acceleration)
    for attempt in range(MOST_CONFIRMATIONS):
        lost, allowed = distance > LOST * size, goal.allowed(size)
        if CONFIRMED * distance * share**LATE <= allowed:
            return fine, CONFIRMED * distance * share**LATE
        if lost and (attempt >= len(SOON) or apart(coarse, fine, SOON[attempt]) > LOST * size):
            break
        if int(fine.tally[STEPS]) > most:
            break
        wanted = allowed / (CONFIRMED * distance * share**power)
        smaller = MUCH_FINER if lost else min(max(wanted ** (1.0 / power), MUCH_FINER), SURE)
        grid = finer(grid, smaller)
        try:
            coarse, fine = fine, goal.anew(grid)
        except SimulationFailed:
            break  # no finer one can be made
        before, distance, size = distance, apart(coarse, fine), rms(fine.acceleration)
        power = min(max(math.log(max(distance, ROUND_OFF * size) / before) / math.log(share), LATE), 1.0)
        share = smaller
    return fine, math.inf if distance > LOST * size else CONFIRMED * distance * share**LATE
