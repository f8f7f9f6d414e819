"""Every record has one place, whichever order the parts come in, and interleaved parts are spread evenly."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import pytest

from datagen.recipes.record_order import Place, Size, machines, place_by_part, place_interleaved

SIZES = ((10, 4), (30, 3), (5, 1))
COUNT = 45


@pytest.mark.parametrize("place", [place_by_part, place_interleaved])
def test_each_record_of_each_part_comes_exactly_once_and_machines_stay_together(
    place: Callable[[tuple[Size, ...], int], Place],
) -> None:
    places: list[Place] = [place(SIZES, record) for record in range(COUNT)]
    assert sorted((one.part, one.record_in_part) for one in places) == [
        (part, record) for part, (records, _) in enumerate(SIZES) for record in range(records)
    ]
    order = [one.machine for one in places]
    assert len(list(dict.fromkeys(order))) == sum(1 for k in range(COUNT) if k == 0 or order[k] != order[k - 1])
    for one in places:
        assert one.record_in_part == one.machine_in_part * SIZES[one.part][1] + one.record_in_machine
        assert one.machine == sum(machines(size) for size in SIZES[: one.part]) + one.machine_in_part


def test_by_part_the_parts_follow_one_another() -> None:
    assert [place_by_part(SIZES, record).part for record in range(COUNT)] == [0] * 10 + [1] * 30 + [2] * 5


def test_interleaved_any_beginning_holds_machines_of_all_parts_in_their_shares() -> None:
    sizes = ((200, 1), (100, 1), (100, 1))
    for length in (8, 40, 200):
        counts = Counter(place_interleaved(sizes, record).part for record in range(length))
        assert counts == {0: length / 2, 1: length / 4, 2: length / 4}


def test_interleaved_the_only_machine_of_a_part_comes_in_the_middle() -> None:
    assert [place_interleaved(((10, 1), (1, 1)), record).part for record in range(11)] == [0] * 5 + [1] + [0] * 5
