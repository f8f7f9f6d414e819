"""Kernels that only kernels can call, made callable from Python."""

from collections.abc import Callable
from typing import Any

import numba

from physics.contact import contact_set, forces, track
from physics.integrators import events, stops
from physics.integrators.modal import bumps, carried, flow, grazing
from physics.integrators.modal import reading as reading_of_weights
from physics.statics import rest


def from_python(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """A compiled function that hands its arguments on to the `kernel` and returns what that returns."""

    @numba.njit(error_model="numpy")
    def handed_on(*values):
        return kernel(*values)

    return handed_on


earliest_change = from_python(events.earliest_change)
count_changes = from_python(contact_set.count_changes)
compression_of = from_python(forces.compression_of)
direction = from_python(forces.direction)
of_ball = from_python(forces.of_ball)
passage = from_python(track.passage)
place_of = from_python(track.place_of)
press = from_python(forces.press)
reset_contact = from_python(contact_set.reset_contact)
set_time = from_python(forces.set_time)
touches = from_python(contact_set.touches)
elastic = from_python(rest.elastic)
passed_over = from_python(bumps.passed_over)
foretell = from_python(carried.foretell)
through_middle = from_python(carried.through_middle)
through_end = from_python(carried.through_end)
reading = from_python(flow.reading)
has_relief = from_python(grazing.has_relief)
has_ridges = from_python(stops.has_ridges)
mark_grazing = from_python(grazing.mark_grazing)
note_motion = from_python(contact_set.note_motion)
turn = from_python(reading_of_weights.turn)
