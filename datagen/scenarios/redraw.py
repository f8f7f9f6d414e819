"""Impossible draws: repeated from the next attempt's streams, and given up in the end."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from datagen.errors import BadInput, setting_text
from datagen.scenarios.deciders import deciders
from datagen.scenarios.refused import Redraw
from datagen.settings.problems import dotted
from datagen.settings.toml_lines import Location, place_in_file
from labels.schema import HEALTHY

if TYPE_CHECKING:
    from datagen.recipes.defect_settings import Combination
    from datagen.recipes.recipe import Recipe

MOST_ATTEMPTS = 200


def given_up(recipe: Recipe, part: int, what: str, redraws: list[Redraw], kind: Combination | None) -> BadInput:
    """The error for the part with this index, which can hardly be drawn: it names the settings behind the last
    refusal, and the reason.

    `what` is the record or machine, and `kind` what it was meant to be (condition, race and profile), if that was
    drawn. If the refusals had different reasons, it also says how often each parameter was refused.
    """
    place: Location = ("part", part)
    last = redraws[-1]
    decided_by = deciders(recipe, part, last.field, kind)
    location, value = decided_by[0] if decided_by else (place, None)
    others = ", ".join(setting_text(dotted(where), said) for where, said in decided_by[1:])
    return BadInput(
        f'{what} of part "{recipe.part[part].name}"{_as_meant(kind)}: {_tally(redraws)}'
        + (f" (this also follows from {others})" if others else ""),
        file=place_in_file(recipe.source, location),
        field=dotted(location),
        value=value,
    )


def _as_meant(kind: Combination | None) -> str:
    """What the record or machine was to be, in words."""
    if kind is None:
        return ""
    condition, race, profile = kind
    return ", meant to be " + (condition if condition == HEALTHY else f"{condition} ({race} race, profile {profile})")


def _tally(redraws: list[Redraw]) -> str:
    """How many draws were impossible, and why."""
    last = redraws[-1].reason
    if all(redraw.reason == last for redraw in redraws):
        return f"all {len(redraws)} draws were impossible for the same reason: {last}"
    counts = Counter(redraw.field or "other" for redraw in redraws)
    refused = ", ".join(f"{field} {count} times" for field, count in counts.most_common())
    return f"{len(redraws)} draws in a row were impossible (refused: {refused}); the last: {last}"
