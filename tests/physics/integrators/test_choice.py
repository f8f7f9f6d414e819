"""Where the next step ends: at its pace, on the grid, or at a kink of a path, however near to these that lies."""

import numpy as np
import pytest

from physics.assembly import assemble
from physics.contact.forces import ACTIVE, COMPRESSION
from physics.integrators.modal.choice import next_step
from physics.integrators.modal.flow import linear_flow
from physics.integrators.modal.judgement import LEAST_RATIO
from physics.integrators.modal.memory import (
    BALL,
    NO_BALL,
    ON_GRID,
    PACE,
    PASSED,
    STRIDES,
    TIME,
    UNITS,
    ModalGrid,
    memory_for,
)
from physics.integrators.modal.tables import tables_for
from physics.integrators.stops import KINK_NUDGE_SHARE, Stops
from physics.integrators.trial import SMALLEST_STEP_SHARE
from physics.motion import motion_model

INTERVAL = 1.0 / 65536.0
UNIT = INTERVAL / UNITS
NEAR = 1e-3 * SMALLEST_STEP_SHARE * INTERVAL  # as near as rounding brings it


@pytest.fixture
def choose(fan, build_scene):
    """The step from a `time` on, with steps up to `pace`, when ball 1 crosses a kink at `kink` (all s)."""
    scene = build_scene(fan)
    flow, balls = linear_flow(motion_model(scene), (6e7, 9e7), (300.0, 500.0)), assemble(scene).balls
    balls[0, ACTIVE], balls[0, COMPRESSION] = 1.0, 1e-6

    def step(time, pace, kink):
        memory = memory_for(flow, np.zeros(12), tables_for(flow, INTERVAL), balls.shape)
        memory.clock[TIME], memory.clock[PACE], memory.marks[BALL] = time, pace, NO_BALL
        memory.marks[PASSED] = int(time / UNIT + 1e-3)
        memory.marks[ON_GRID] = abs(time - memory.marks[PASSED] * UNIT) < NEAR
        stops = Stops(np.array([kink]), np.zeros(1, dtype=np.int64))
        grid = ModalGrid(1000, INTERVAL, len(STRIDES), 0.0, 1e-9, 0.0, 1.0, 1e9)
        return next_step(balls, grid, stops, memory)

    return step


@pytest.mark.parametrize("off", [-NEAR, 0.0, NEAR])
def test_a_step_that_would_end_at_a_kink_anyway_goes_on_beyond_it(choose, off):
    time, pace = 10.25 * UNIT, 0.125 * UNIT  # halves of a step to the kink add up to it but for rounding
    choice = choose(time, pace, time + pace + off)
    assert choice.units == 0
    assert choice.end < time + pace + off < choice.beyond
    assert choice.beyond - choice.end == pytest.approx(2.0 * KINK_NUDGE_SHARE * INTERVAL)


@pytest.mark.parametrize("off", [-NEAR, 0.0, NEAR])
def test_a_step_to_a_line_of_the_grid_ends_there_and_is_told_of_a_kink_at_it(choose, off):
    choice = choose(10.0 * UNIT, UNIT, 11.0 * UNIT + off)
    assert choice.units == 1
    assert choice.end == 11.0 * UNIT
    assert choice.beyond > max(choice.end, 11.0 * UNIT + off)


def test_a_kink_behind_the_end_of_a_step_is_left_to_the_next(choose):
    choice = choose(10.0 * UNIT, UNIT, 11.0 * UNIT + 2.0 * SMALLEST_STEP_SHARE * INTERVAL)
    assert choice.beyond == choice.end == 11.0 * UNIT


def test_a_stride_does_not_end_where_a_kink_is(choose):
    assert choose(0.0, 4.0 * INTERVAL, 4.0 * INTERVAL + NEAR).units < 4 * UNITS
    assert choose(0.0, 4.0 * INTERVAL, 5.0 * INTERVAL).units == 4 * UNITS


@pytest.mark.parametrize(
    ("begin", "pace", "lengths"),
    [
        (0, 14, [8, 8]),  # and not 14 and a rest of 2, too short a past for the next 14
        (0, 15.9, [8, 8]),
        (0, 12, [12, 4]),
        (0, 7.5, [7, 7, 2]),
        (0, 5, [5, 5, 3, 3]),
        (0, 3, [3, 3, 3, 3, 3, 1]),
        (0, 16, [16]),
        (0, 0.9, [1] * 16),
        (5, 10, [6, 5]),
        (9, 10, [7]),
    ],
)
def test_a_rest_of_a_sample_that_could_not_carry_the_next_step_is_shared_with_the_one_before(
    choose, begin, pace, lengths
):
    found, unit = [], begin
    while unit < UNITS:
        choice = choose(unit * UNIT, pace * UNIT, 40.0 * UNIT)
        assert choice.beyond == choice.end == pytest.approx((unit + choice.units) * UNIT, rel=1e-12)
        assert choice.row == choice.units
        found.append(choice.units)
        unit += choice.units
    assert found == lengths
    assert found[-1] >= LEAST_RATIO * min(UNITS, max(int(pace), 1))


def test_a_kink_that_the_pace_reaches_is_gone_to_in_one_step(choose):
    assert choose(0.0, 12.0 * UNIT, 11.5 * UNIT).end == pytest.approx(11.5 * UNIT, rel=1e-4)
    assert choose(0.0, 13.0 * UNIT, 12.5 * UNIT).end == pytest.approx(12.5 * UNIT, rel=1e-4)
    assert choose(0.0, 13.0 * UNIT, 13.5 * UNIT).units == 8
