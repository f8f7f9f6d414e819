"""How many records of each condition a recipe asks for, to be set beside those that were made."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from datagen.corpus_files.manifest import Manifest, Span
from datagen.inspection.manifest_check import recipe_of
from datagen.recipes.recipe import Recipe
from datagen.settings.table import shares_of_words
from labels.schema import HEALTHY


def asked_of(manifest: Manifest, folder: Path) -> dict[str, float]:
    """Records by condition, as the weights of the recipe give them, of those that the corpus `folder` was asked for.

    Empty for recordings, and where the recipe can no longer be read.
    """
    recipe, _ = recipe_of(manifest, folder)
    return {} if recipe is None else asked_by_condition(recipe, manifest.asked)


def asked_by_condition(recipe: Recipe, asked: Iterable[Span]) -> dict[str, float]:
    """Records by condition that the weights of the recipe give on average, of the spans [start, stop) `asked` for."""
    shares = [{HEALTHY: 1.0} if part.defect is None else shares_of_words(part.defect.condition) for part in recipe.part]
    counts: dict[str, float] = {}
    for start, stop in asked:
        for record in range(start, stop):
            place = recipe.place(record)
            defect = recipe.part[place.part].defect
            before_damage = defect is not None and place.record_in_machine < defect.healthy_records
            for condition, share in ({HEALTHY: 1.0} if before_damage else shares[place.part]).items():
                counts[condition] = counts.get(condition, 0.0) + share
    return counts
