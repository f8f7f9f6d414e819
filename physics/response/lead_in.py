"""A response of a machine that has run for a while: it starts before t = 0, where the record begins."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from physics.cage import CagePath
from physics.response.part import Part, exact_in_part
from physics.rms import rms
from physics.scene import Scene
from physics.trace import ContactChanges, Trace


def respond_behind(respond: Callable[[float], Trace], before: int, accuracy: float, least_error: float) -> Trace:
    """The trace that `respond` gives when called with an accuracy, to a relative RMS `accuracy` of the part behind its
    first `before` samples, or to `least_error` (m/s², RMS).

    That part may be far quieter than the start. The error estimate is relative to it.
    """

    def behind(asked: float) -> Part:
        trace = respond(asked)
        return Part(trace, trace.error_estimate * rms(trace.acceleration), rms(trace.acceleration[before:]))

    trace, error, size = exact_in_part(behind, accuracy, least_error)
    return trace if trace.chaotic or size == 0.0 else replace(trace, error_estimate=error / size)


def started_earlier(scene: Scene, lead_in: float) -> Scene:
    """The same machine with its clock set back: what `scene` does at t it does at t + `lead_in` (s), and lasts longer.

    Raises InvalidParameter if the slip is not known from t = −`lead_in` on.
    """
    run, waves, turned = scene.operation, scene.imperfections.waviness, _turned(scene, "inner", lead_in)
    return replace(
        scene,
        operation=replace(
            run,
            unbalance_phase=run.unbalance_phase - turned,
            fluctuation_phase=run.fluctuation_phase - turned,
        ),
        cage=_cage_earlier(scene.cage, lead_in),
        second_cage=None if scene.second_cage is None else _cage_earlier(scene.second_cage, lead_in),
        spalls=tuple(replace(spall, angle=spall.angle - _turned(scene, spall.race, lead_in)) for spall in scene.spalls),
        imperfections=replace(
            scene.imperfections,
            waviness=tuple(
                replace(wave, phase=wave.phase + _turned(scene, wave.race, lead_in, wave.order)) for wave in waves
            ),
        ),
    )


def starting_at(trace: Trace, before: int) -> Trace:
    """The `trace` with its time, and that of its changes, counted from its sample number `before`."""
    time = (np.arange(trace.time.size) - before) / trace.rate
    return replace(trace, time=time, changes=replace(trace.changes, time=trace.changes.time - before / trace.rate))


def from_start(trace: Trace) -> Trace:
    """What a `trace` with a lead-in has from t = 0 on; its step, tension share and unlocated changes stay those of the
    whole march, start included."""
    first = int(np.searchsorted(trace.time, 0.0))
    outer = trace.outer
    return replace(
        trace,
        time=trace.time[first:],
        acceleration=trace.acceleration[first:],
        state=None if trace.state is None else trace.state[first:],
        contact_force=None if trace.contact_force is None else trace.contact_force[first:],
        outer=None if outer is None else outer.from_sample(first * round(outer.rate / trace.rate)),
        changes=_changes_from_start(trace.changes),
    )


def _turned(scene: Scene, race: str, lead_in: float, order: int = 1) -> float:
    """Phase (rad, −π to π) by which a wave of this `order` on a race turns during the lead-in."""
    return math.remainder(order * scene.race_speed(race) * lead_in, math.tau)


def _cage_earlier(cage: CagePath, lead_in: float) -> CagePath:
    return replace(
        cage,
        duration=cage.duration + lead_in,
        start_angle=float(cage.polynomial(-lead_in)),
        knot_start=cage.knot_start + lead_in if cage.knot_values else cage.knot_start,
    )


def _changes_from_start(changes: ContactChanges) -> ContactChanges:
    early = changes.time < 0.0
    initial = changes.initial.copy()
    # In time order: of several changes of a ball the last one counts.
    initial[changes.row[early] - 1, changes.ball[early] - 1] = changes.made[early]
    late = ~early
    return ContactChanges(changes.time[late], changes.row[late], changes.ball[late], changes.made[late], initial)
