"""The preview: one record of a recipe or of a corpus, drawn on one sheet."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.corpus_files.manifest import manifest_path, no_corpus, read_manifest
from datagen.corpus_files.shard import has_finished_shards
from datagen.errors import BadInput
from datagen.files.atomic import write_file
from datagen.files.places import OUT, require_file
from datagen.progress import Say, ignore
from datagen.recipes.recipe_files import FILE_NAME
from labels.truth import PassTable

if TYPE_CHECKING:
    from datagen.drawing.portrait import Portrait


def draw_preview(source: str | Path, record: int, out: str | Path, say: Say = ignore) -> dict[str, Any]:
    """Draw `record` of a recipe (it is simulated) or of a corpus (it is read) into the PNG `out`; gives what was drawn.

    `say` is told where something has to be compiled first, which takes a while. Raises BadInput if the source, the
    record or the picture's name cannot be used, SimulationFailed if the record cannot be simulated; nothing is written
    then.
    """
    picture = _writable(Path(out))
    content, facts = preview_png(source, record, say)
    write_file(picture, content, OUT)
    return facts


def first_record(source: str | Path) -> int:
    """The lowest record of the corpus in the folder `source`; 0 for one without records and for a recipe."""
    if not manifest_path(Path(source)).is_file():
        return 0
    from datagen.corpus import Corpus

    return int(min(Corpus(source).labels["record"], default=0))


def preview_png(source: str | Path, record: int, say: Say = ignore) -> tuple[bytes, dict[str, Any]]:
    """The sheet of `record` of a recipe or a corpus as the bytes of a PNG file, and what it shows.

    Raises BadInput, and SimulationFailed of a recipe's record.
    """
    from datagen.drawing.portrait_sources import corpus_portrait, recipe_portrait
    from datagen.drawing.sheet import sheet_png
    from datagen.inspection.recipe_check import is_recipe

    folder = Path(source)
    if is_recipe(folder):
        portrait = recipe_portrait(source, record, say)
    else:
        _require_manifest(folder)
        if read_manifest(folder).imported:
            return _measured_png(folder, record)
        portrait = corpus_portrait(folder, record)
    return sheet_png(portrait), _facts(portrait)


def _require_manifest(folder: Path) -> None:
    name = manifest_path(folder).name
    if not manifest_path(folder).exists():
        if has_finished_shards(folder):
            raise no_corpus(folder, name)
        raise BadInput(f"neither a corpus ({name}) nor a recipe ({FILE_NAME}) is in this folder", file=str(folder))


def _measured_png(folder: Path, record: int) -> tuple[bytes, dict[str, Any]]:
    from datagen.drawing.measured_sheet import measured_sheet_png
    from datagen.drawing.portrait_sources import measured_portrait

    portrait = measured_portrait(folder, record)
    return measured_sheet_png(portrait), {
        "labels": dict(portrait.labels),
        "frequencies_hz": portrait.frequencies,
        "close_up_s": list(portrait.window),
        "axis": portrait.axis,
    }


def _writable(picture: Path) -> Path:
    if picture.suffix.lower() != ".png":
        raise BadInput(field=OUT, value=str(picture), allowed="a file name that ends in .png")
    require_file(picture)
    return picture


def _facts(portrait: Portrait) -> dict[str, Any]:
    """What the sheet shows, in numbers: labels, frequencies (Hz), modes along y (Hz) and the close-up (s)."""
    from datagen.drawing.time_panels import vertical_modes

    table, shown = portrait.passes, portrait.shown_pass
    facts: dict[str, Any] = {
        "labels": {name: list(value) if isinstance(value, tuple) else value for name, value in portrait.labels.items()},
        "frequencies_hz": portrait.frequencies,
        "modes_along_y_hz": vertical_modes(portrait),
        "close_up_s": list(portrait.window),
        "passes": len(table),
        "released": int(np.isfinite(table.release_time).sum()),
    }
    if shown is not None:
        facts["shown_pass"] = {field.name: getattr(table, field.name)[shown].item() for field in fields(PassTable)}
    return facts
