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
    """The random streams of one `attempt` at the machine or record (`scope`) `number` of a recipe.

    `part` is the index of its part, `place` its place among the machines or records of that part. `turn` says which
    balanced settings were met before; `intended`, which all attempts share, says what kind of spalls it is to have.
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
        """A picker of values for one table of settings; in a designed part it starts from the point of the design."""

        def refine(position: int, number: float) -> float:
            dimension = dimension_of(purpose, item, position)
            if dimension is None or self.attempt > 0:
                return number
            return self._design.refine(dimension, self.place, self._points, number)

        return Picker(lambda: self.stream(purpose, item), refine, self.turns)

    @cached_property
    def turns(self) -> Turns:
        """Gives the balanced settings their values, the same in every attempt."""
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
