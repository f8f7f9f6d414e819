"""`spallgen schema`: what a recipe may say, for editors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from datagen.commands.program import JsonFile, command, write_json
from datagen.files.places import OUT, require_file


@command("spallgen schema --out recipe.schema.json")
def schema(
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="File to write; printed if not given.")
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Write the JSON Schema of recipes: an editor completes, explains and checks keys with it."""
    from datagen.files.atomic import write_file
    from datagen.recipes.recipe_schema import recipe_schema, schema_text

    if out is not None:
        require_file(out)
    write_json(json_file, recipe_schema())
    if out is None:
        print(schema_text(), end="")
        return
    write_file(out, schema_text().encode(), OUT)
    print(f"the schema of recipes is in {out}")
