"""Impossible draws: drawn again from the next attempt's streams, counted with their reason, and not for ever."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from datagen.errors import BadInput

if TYPE_CHECKING:
    from datagen.recipes.recipe import Part, Recipe

MOST_ATTEMPTS = 200


@dataclass(frozen=True)
class Redraw:
    """A draw that no machine or record could have: `scope` "machine" or "record", its number of attempt and why.

    `field` names the parameter that was refused, a short key to count by; `reason` is a sentence with its numbers.
    """

    scope: str
    attempt: int
    field: str
    reason: str


def given_up(recipe: Recipe, part: Part, what: str, redraws: list[Redraw]) -> BadInput:
    """The error of a part that can hardly be drawn: says how often each parameter was refused and the last reason."""
    counts = Counter(redraw.field or "other" for redraw in redraws)
    refused = ", ".join(f"{field} {count} times" for field, count in counts.most_common())
    return BadInput(
        f'part "{part.name}", {what}: {len(redraws)} draws in a row were impossible (refused: {refused}); '
        f"the last: {redraws[-1].reason}",
        file=recipe.source,
        field=f"part[{recipe.part.index(part) + 1}]",
    )
