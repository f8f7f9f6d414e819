"""Balanced settings: exact counts in every block of machines or records, crossed with one another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from datagen.distributions.kinds import Balanced

CODES = 2**32
MOST_OPTIONS = 1024
OpenBlock = Callable[[int, int], np.random.Generator]


@dataclass(frozen=True)
class Turn:
    """How many machines or records (`place`) came before with the same values of the balanced settings met so far.

    `path` is a number that stands for those values, 1 if none has been met.
    """

    place: int
    path: int = 1


class Turns:
    """Gives the balanced settings of one machine or record their values, one after another.

    The first setting takes its value by the place in the part, each further one by the place among those with the same
    values so far. So the counts are exact in every block of the first, and in every block of the second within each
    value of the first. `open_block` gives the generator that shuffles a block of a path.
    """

    def __init__(self, start: Turn, open_block: OpenBlock) -> None:
        self.turn = start
        self._open_block = open_block

    def take(self, setting: Balanced) -> Any:
        """The value of the next balanced setting."""
        block, position = divmod(self.turn.place, setting.block)
        order = setting.shuffled(self._open_block(block, self.turn.path))
        option = order[position]
        before = block * setting.counts[option] + order[:position].count(option)
        self.turn = Turn(before, (self.turn.path * MOST_OPTIONS + option + 1) % CODES)
        return setting.options[option]
