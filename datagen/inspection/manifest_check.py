"""Checking a manifest: against the recipe or SPEC in it, and against what the sidecars of the shards say."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from datagen.corpus_files.format import data_hash
from datagen.corpus_files.manifest import Manifest, manifest_path, stated_records
from datagen.corpus_files.shard import Sidecar
from datagen.errors import BadInput

if TYPE_CHECKING:
    from datagen.recipes.recipe import Recipe

# What a manifest says that follows from the sidecars of the shards.
SUMMED = ("failed", "bytes", "seconds", "refused")


def recipe_of(manifest: Manifest, folder: Path) -> tuple[Recipe | None, list[str]]:
    """The recipe of the corpus `folder`, if it can be read and is the one that made it, and what is wrong with it; None
    for imported recordings."""
    from datagen.recipes.recipe import parse_recipe

    if manifest.imported:
        same = data_hash(manifest.recipe) == manifest.identity.recipe_hash
        return None, [] if same else ["manifest.json: its SPEC and files do not have the hash that it states"]
    try:
        recipe = parse_recipe(manifest.recipe, manifest_path(folder))
    except BadInput as problem:
        return None, [f"manifest.json: its recipe cannot be read: {problem}"]
    if recipe.short_hash != manifest.identity.recipe_hash:
        return None, ["manifest.json: its recipe does not have the hash that it states"]
    if recipe.name != manifest.name or recipe.count != manifest.recipe_records:
        return recipe, ["manifest.json: name or recipe_records disagree with its recipe"]
    return recipe, []


def differences(manifest: Manifest, folder: Path, sidecars: Sequence[Sidecar], compare_sums: bool) -> Iterator[str]:
    """In what a manifest differs from what the `sidecars` of all shards of the corpus `folder` add up to; without
    `compare_sums` only whether it knows all records, as where it is known to lack shards."""
    made = {record for sidecar in sidecars for record in sidecar.records}
    if not made <= manifest.every_asked:
        yield "manifest.json: the corpus holds records that it does not list as asked for"
    if not compare_sums:
        return
    summed = manifest.with_shards(sidecars)
    differing = [name for name in SUMMED if getattr(summed, name) != getattr(manifest, name)]
    if stated_records(folder) != summed.records:
        differing.append("records")
    for name in differing:
        yield f"manifest.json: {name} disagrees with the sum over the shards' sidecars"
