"""How the scripts that change the recipe `transfer` make their corpora and reports."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

from datagen.cards.toml_text import toml_text
from datagen.recipes.recipe_files import find_recipe

NOISE = ("--noise-db", "-10", "--noise-draws", "1")


def transfer_recipe() -> dict[str, Any]:
    """The recipe `transfer` as it is written, to be changed."""
    return tomllib.loads(find_recipe("transfer").read_text(encoding="utf-8"))


def generated(out: Path, name: str, recipe: dict[str, Any], *options: object) -> Path:
    """The corpus of a recipe, beside its file in the folder of this name."""
    folder = out / "corpora" / name.replace(" ", "_")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "recipe.toml").write_text(toml_text(recipe), encoding="utf-8")
    spallgen("generate", folder / "recipe.toml", "--out", folder / "corpus", *options, "--workers", 1)
    return folder / "corpus"


def report(out: Path, name: str, train: Path | str, tests: list[str], records: int, *options: str) -> None:
    """Scores of what is learned from a corpus."""
    asked = [part for test in tests for part in ("--test", test)]
    spallgen(
        "classify", "--train", train, *asked, "--first", records, "--workers", 1, *NOISE, *options, "--out", out / name
    )


def spallgen(*words: object) -> None:
    """Run a command of the package."""
    print("spallgen", *words, flush=True)
    subprocess.run([sys.executable, "-m", "datagen", *map(str, words)], check=True)
