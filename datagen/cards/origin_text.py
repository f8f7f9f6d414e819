"""What a corpus was made from, as TOML: the recipe without its defaults, or the SPEC of the imported recordings."""

from __future__ import annotations

from pathlib import Path

from datagen.cards.toml_text import toml_text
from datagen.corpus_files.manifest import Manifest
from datagen.errors import BadInput
from datagen.files.places import MANIFEST


def origin_text(manifest: Manifest) -> str:
    """The recipe or SPEC of a corpus as TOML, without what is as it is by default."""
    from datagen.recipes.recipe import parse_recipe
    from datagen.recordings.spec import parse_spec

    parse = parse_spec if manifest.imported else parse_recipe
    try:
        read = parse(manifest.written, Path(MANIFEST))
    except BadInput:
        return toml_text(manifest.written)  # made by a version with other settings: shown as it is stored
    return toml_text(read.model_dump(mode="json", exclude_defaults=True))
