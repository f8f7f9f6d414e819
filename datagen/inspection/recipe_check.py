"""Whether a recipe can be made, and what it would make: nothing is simulated or written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from datagen.corpus_files.manifest import manifest_path
from datagen.corpus_files.shard import has_finished_shards
from datagen.progress import Say, ignore
from datagen.recipes.recipe import load_recipe
from datagen.recipes.recipe_files import FILE_NAME
from datagen.runs.plan import needed_bytes, plan_shards, selection
from datagen.runs.requirements import require_memory, require_possible_rates, require_shard_memory
from datagen.scenarios.sampling import draw_scenario


@dataclass(frozen=True)
class RecipeFacts:
    """What a recipe would make: `records` by part, of so many virtual `machines`, in so many `shards`.

    `recipe` is its file and `hash` what its corpora carry. `signal_seconds` is the summed length of the records,
    `rates_hz` and `durations_s` are all that occur, rising, and `bytes` is about what the corpus takes on the disk.
    """

    recipe: str
    name: str
    title: str
    hash: str
    records: int
    parts: dict[str, int]
    machines: int
    shards: int
    signal_seconds: float
    rates_hz: tuple[float, ...]
    durations_s: tuple[float, ...]
    bytes: int


def is_recipe(source: Path) -> bool:
    """Whether `source` names a recipe and no corpus: a file, a name, or a folder with a recipe and nothing of a
    corpus."""
    try:
        if not source.is_dir():
            return True
    except OSError:  # such as a name too long for the system, which is told where the recipe is looked for
        return True
    return (source / FILE_NAME).is_file() and not manifest_path(source).exists() and not has_finished_shards(source)


def check_recipe(source: str | Path, say: Say = ignore) -> RecipeFacts:
    """What the recipe at `source`, its file, folder or name, would make; raises BadInput as `generate` does.

    All records are drawn for that. `say` is called with what `generate` says of them: ranges that hold impossible
    values, rates that are too low, and ball passes that records do not show.
    """
    recipe = load_recipe(source)
    asked = selection(recipe, None, None)
    require_memory(recipe)
    require_possible_rates(recipe, asked)
    planned = plan_shards(recipe, recipe.count, say)
    require_shard_memory(recipe, planned)
    return RecipeFacts(
        recipe=recipe.source,
        name=recipe.name,
        title=recipe.title,
        hash=recipe.short_hash,
        records=recipe.count,
        parts={part.name: part.records for part in recipe.part},
        machines=sum(part.machines for part in recipe.part),
        shards=len(planned),
        signal_seconds=sum(len(shard.records) * shard.record_seconds for shard in planned),
        # The records of a shard are of one rate.
        rates_hz=tuple(sorted({draw_scenario(recipe, shard.records[0]).rate for shard in planned})),
        durations_s=tuple(sorted({shard.record_seconds for shard in planned})),
        bytes=round(needed_bytes(planned)),
    )
