"""Where recipes are found, and what the wheel must ship for that."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from datagen.errors import BadInput
from datagen.recipes import recipe_files
from datagen.recipes.recipe_files import find_recipe, shipped_recipes
from datagen.recordings.spec_files import find_spec, shipped_specs

ROOT = Path(__file__).parents[3]


def test_a_dataset_is_found_by_name_with_or_without_its_folder_from_anywhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("quickstart", "datasets/quickstart", "datasets/quickstart/recipe.toml"):
        assert find_recipe(name).samefile(ROOT / "datasets" / "quickstart" / "recipe.toml")


def test_a_file_or_folder_of_that_name_comes_before_the_dataset(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tmp_path / "quickstart" / "recipe.toml"
    own.parent.mkdir()
    own.touch()
    monkeypatch.chdir(tmp_path)
    assert find_recipe("quickstart").samefile(own)
    assert find_recipe(own) == own


def test_the_folder_of_a_corpus_does_not_hide_the_dataset_of_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "quickstart" / "shards").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    assert find_recipe("quickstart").samefile(ROOT / "datasets" / "quickstart" / "recipe.toml")


def test_the_copy_inside_the_wheel_comes_before_a_folder_beside_the_packages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    inside, beside = tmp_path / "datagen" / "datasets", tmp_path / "datasets"
    for folder in (inside, beside):
        (folder / "quickstart").mkdir(parents=True)
        (folder / "quickstart" / "recipe.toml").touch()
    monkeypatch.setattr(recipe_files, "dataset_folders", lambda: [inside, beside])
    assert find_recipe("quickstart") == inside / "quickstart" / "recipe.toml"


def test_a_name_that_is_nothing_is_refused_with_the_nearest_and_all_there_are() -> None:
    with pytest.raises(BadInput, match=r'gearbox_rig.*quickstart.*did you mean "quickstart"\?'):
        find_recipe("quikstart")


@pytest.mark.parametrize("find", [find_recipe, find_spec])
def test_a_pipe_is_not_called_missing(find: Callable[[Path], Path], tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(BadInput, match="pipe: this is a pipe or a device; a file is needed"):
        find(tmp_path / "pipe")


@pytest.mark.parametrize("find", [find_recipe, find_spec])
def test_a_name_too_long_for_a_file_is_refused(find: Callable[[str], Path]) -> None:
    with pytest.raises(BadInput, match=r"no such file|File name too long"):
        find("a" * 300)


def test_a_folder_is_not_taken_for_a_spec(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="this is a folder"):
        find_spec(tmp_path)


def test_a_folder_without_a_recipe_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"has no recipe\.toml"):
        find_recipe(tmp_path)


def test_the_wheel_lists_every_package_and_every_dataset() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]
    packages = {
        ".".join(file.parent.relative_to(ROOT).parts)
        for name in ("physics", "labels", "datagen")
        for file in (ROOT / name).rglob("__init__.py")
    }
    datasets = {f"datagen.datasets.{name}" for name in shipped_recipes()}
    specs = {f"datagen.datasets.{path.parent.name}" for path in shipped_specs().values()}
    assert set(settings["packages"]) == packages | datasets | specs | {"datagen.datasets"}
    assert settings["package-dir"] == {"datagen.datasets": "datasets"}
