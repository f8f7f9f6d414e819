"""One attempt at drawing one machine or one record: where each of its numbers comes from."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from datagen.recipes.recipe import Recipe
from datagen.scenarios.design import Design, dimension_of
from datagen.scenarios.intended_kind import IntendedKind
from datagen.scenarios.picker import Picker
from datagen.scenarios.streams import stream
from datagen.scenarios.turns import Turn, Turns

BALANCES = {"machine": "balance_machines", "record": "balance_records"}


@dataclass(frozen=True)
class Draw:
    """The streams of machine or record (`scope`) `number` of a recipe, in its part with index `part`.

    `place` is its place among the machines or records of the part. `turn` says which balanced settings were met before,
    `intended`, which its attempts share, of what kind its spalls are to be.
    """

    recipe: Recipe
    part: int
    scope: str
    number: int
    place: int
    attempt: int = 0
    turn: Turn | None = None
    intended: IntendedKind = field(default_factory=IntendedKind)

    def stream(self, purpose: str, item: int = 0) -> np.random.Generator:
        """A fresh generator at the start of one of its streams."""
        return stream(self.recipe.seed, self.scope, self.number, purpose, self.attempt, item)

    def picker(self, purpose: str, item: int = 0) -> Picker:
        """A picker of values for one table, in a designed part from the point of the design."""

        def refine(position: int, number: float) -> float:
            dimension = dimension_of(purpose, item, position)
            if dimension is None or self.attempt > 0:
                return number
            return self._design.refine(dimension, self.place, self._points, number)

        return Picker(lambda: self.stream(purpose, item), refine, self.turns)

    @cached_property
    def turns(self) -> Turns:
        """What gives its balanced settings their values; the same in every attempt."""
        recipe, purpose = self.recipe, BALANCES[self.scope]

        def open_block(block: int, path: int) -> np.random.Generator:
            return stream(recipe.seed, "part", self.part, purpose, block, path)

        return Turns(self.turn or Turn(self.place), open_block)

    @property
    def _design(self) -> Design:
        return Design(self.recipe.part[self.part].design, self.recipe.seed, self.part)

    @property
    def _points(self) -> int:
        part = self.recipe.part[self.part]
        return part.machines if self.scope == "machine" else part.records
