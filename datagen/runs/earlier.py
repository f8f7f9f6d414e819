"""What earlier runs left in a folder: what its manifest says, or the sidecars of its shards if the manifest is lost."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from datagen.corpus_files.format import Identity
from datagen.corpus_files.manifest import DamagedManifest, Span, add_spans, manifest_path, read_manifest
from datagen.corpus_files.shard import Sidecar, finished_shards, shards_folder
from datagen.errors import BadInput
from datagen.files.atomic import is_temporary
from datagen.files.lock import LOCK
from datagen.files.places import OUT, SHARDS, require_folder
from datagen.recipes.recipe import Recipe
from datagen.runs.changes import differing_settings

BEGUN_WITH = {
    "recipe_hash": "another recipe or another version of this one",
    "model_hash": "another version of the physics",
    "format_hash": "another version of the file format",
    "program_hash": "another version of the program",
}
# What a run leaves that was interrupted before its first shard.
BEGINNING = (LOCK, SHARDS)
# So many changed settings are named.
MOST_CHANGES = 3


@dataclass(frozen=True)
class Earlier:
    """The spans [start, stop) of records that earlier runs were `asked` for; none in a new folder.

    `lost` is a sentence if the manifest was lost or damaged. Then the spans cover only the records that are settled in
    finished shards: what else was asked for is not known.
    """

    asked: tuple[Span, ...] = ()
    lost: str = ""


def earlier_runs(folder: Path, recipe: Recipe, identity: Identity) -> Earlier:
    """What earlier runs left in `folder`; raises BadInput unless it is empty or holds a corpus of the same `identity`,
    made of the same `recipe`.

    Also refused are a manifest that cannot be opened, and a damaged one if no shard is finished.
    """
    require_folder(folder)
    try:
        if manifest_path(folder).exists():
            manifest = read_manifest(folder)
            if manifest.imported:
                raise BadInput(
                    "this folder holds imported recordings: choose another folder", file=str(folder), field=OUT
                )
            changed = differing_settings(manifest.recipe, recipe.model_dump(mode="json"))
            _require_same(identity, manifest.identity, folder, f"the corpus {manifest.name}", changed)
            return Earlier(manifest.asked)
        damage = None
    except DamagedManifest as problem:
        damage = problem
    spans, count = _settled_spans(finished_shards(folder), identity, folder)
    if count:
        state = "cannot be read" if damage else "is lost"
        return Earlier(
            spans,
            f"manifest.json {state}; it is written anew from {count} finished shards, and of the records asked for "
            "earlier it lists only those in them",
        )
    if damage is not None:
        raise damage
    _refuse_strangers(folder)
    return Earlier()


def _settled_spans(sidecars: Iterable[Sidecar], identity: Identity, folder: Path) -> tuple[tuple[Span, ...], int]:
    """Spans of the records that `sidecars` settle, and the number of these; BadInput if any is of another identity."""
    settled: set[int] = set()
    count = 0
    for sidecar in sidecars:
        _require_same(identity, sidecar.identity, folder)
        settled |= sidecar.settled
        count += 1
    return add_spans((), ((record, record + 1) for record in settled)), count


def _require_same(
    identity: Identity,
    found: Identity,
    folder: Path,
    held: str = "the corpus",
    changed: Sequence[str] = (),
) -> None:
    """Raise BadInput unless the identity `found` is the wanted one; it names some of the settings that have `changed`,
    where these are known."""
    others = {part: other for part, other in BEGUN_WITH.items() if getattr(found, part) != getattr(identity, part)}
    if others:
        if changed and "recipe_hash" in others:
            more = f" and {len(changed) - MOST_CHANGES} more" if len(changed) > MOST_CHANGES else ""
            others["recipe_hash"] += f" (then {', '.join(changed[:MOST_CHANGES])}{more})"
        raise BadInput(
            f"{held} in this folder was begun with {', and with '.join(others.values())}; a corpus never mixes them: "
            "choose another folder, or delete this one",
            file=str(folder),
            field=OUT,
        )


def _refuse_strangers(folder: Path) -> None:
    """Raise BadInput if `folder` holds what an interrupted beginning of a run does not explain."""
    if not folder.exists():
        return
    names = [path.name for path in folder.iterdir() if path.name not in BEGINNING and not is_temporary(path)]
    strangers = sorted(names) or sorted(path.name for path in shards_folder(folder).glob("*.nc"))
    if strangers:
        raise BadInput(
            f"this folder holds no corpus but other things ({', '.join(strangers[:3])})", file=str(folder), field=OUT
        )
