"""Room for changes of contact: eightfold until it is more than there may be."""

import pytest

from physics.outcome import Outcome, SimulationFailed
from physics.response.change_log import FIRST_ROOM, GROWTH, LARGEST_ROOM, room_for_changes


def test_room_grows_until_it_is_more_than_is_ever_kept():
    rooms = [room_for_changes(0, 0.5)]
    while GROWTH * rooms[-1] <= LARGEST_ROOM:
        rooms.append(room_for_changes(rooms[-1], 0.5))
    assert rooms == [FIRST_ROOM * GROWTH**k for k in range(len(rooms))]
    with pytest.raises(SimulationFailed, match=rf"more than {rooms[-1]} changes of contact in 0\.5 s"):
        room_for_changes(rooms[-1], 0.5)


def test_a_short_record_is_given_up_when_it_has_more_changes_than_its_steps_can_make():
    most = GROWTH * FIRST_ROOM
    assert room_for_changes(FIRST_ROOM, 0.01, most) == most
    assert room_for_changes(FIRST_ROOM, 0.01, most - 1) == most - 1
    with pytest.raises(SimulationFailed, match=f"more than {most - 1} changes") as caught:
        room_for_changes(most - 1, 0.01, most - 1)
    assert caught.value.outcome is Outcome.TOO_MANY_CHANGES
