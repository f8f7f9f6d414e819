"""The split that a command is asked for."""

from __future__ import annotations

from pathlib import Path

import pytest

from datagen.errors import BadInput
from datagen.judging.splits import require_split

PRESENT = ["test", "train", "test"]


@pytest.mark.parametrize("asked", ["all", "train", "test"])
def test_all_or_a_split_that_is_there_may_be_asked_for(asked: str) -> None:
    require_split(Path("corpus"), PRESENT, asked)


@pytest.mark.parametrize(
    ("present", "asked", "allowed"),
    [
        (PRESENT, "validation", "all, train, test"),
        (["test", "validation", "train"], "tset", "all, train, validation, test"),
    ],
)
def test_another_split_is_refused_with_those_that_are_there_in_their_order(
    present: list[str], asked: str, allowed: str
) -> None:
    with pytest.raises(BadInput) as refused:
        require_split(Path("corpus"), present, asked)
    assert str(refused.value) == f'corpus: --split = "{asked}": no records of this split; allowed: {allowed}'
