"""How often a plan had to draw again, and the sentence that says so if it was often."""

from __future__ import annotations

from datagen.recipes.recipe import Recipe
from datagen.scenarios.refused import Redraw, Refused, add_refused, count_refused
from datagen.scenarios.scenario import Scenario

# Share of the planned records. If fewer were drawn again, the sizes and places are still nearly those of the recipe.
OFTEN = 0.1


def counted_redraws(recipe: Recipe, scenario: Scenario) -> list[Redraw]:
    """The redraws that count with this record: its own, and its machine's if it is the machine's first record."""
    first = recipe.place(scenario.record).record_in_machine == 0
    return [redraw for redraw in scenario.redraws if first or redraw.scope == "record"]


class RedrawCount:
    """Counts the redraws of the scenarios of one recipe."""

    def __init__(self, recipe: Recipe) -> None:
        self._recipe = recipe
        self._records = self._redrawn = 0
        self._refused: dict[str, Refused] = {}

    def add(self, scenario: Scenario) -> None:
        """Count those of one more scenario."""
        self._records += 1
        redraws = counted_redraws(self._recipe, scenario)
        if redraws:
            self._redrawn += 1
            self._refused = add_refused([self._refused, count_refused(redraws)])

    def sentence(self) -> str:
        """What was drawn again and what follows, if it happened to a tenth of the records or more; else empty."""
        if self._redrawn == 0 or self._redrawn < OFTEN * self._records:
            return ""
        parameters = ", ".join(f"{what} {refused.count}" for what, refused in self._refused.items())
        example = next(iter(self._refused.values())).example
        return (
            f"{sum(refused.count for refused in self._refused.values())} draws for {self._redrawn} of {self._records} "
            f"records were impossible and were drawn again ({parameters}; for example: {example}); of the ranges that "
            "the recipe states, what is impossible is missing; condition, race and profile keep their shares"
        )
