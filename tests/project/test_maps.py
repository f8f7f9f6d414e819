"""The docstring of each package is the map of its room: it names every module, and nothing that is not there."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = sorted(
    file.parent.relative_to(ROOT)
    for name in ("physics", "labels", "datagen")
    for file in (ROOT / name).rglob("__init__.py")
)
# A module, a package with a slash behind it, or a way from one to the other: `phi`, `modal/`, `columns.table`.
LIKE_A_MODULE = re.compile(r"\w+([./]\w+)*/?")


def named(folder):
    """The names between backticks in the docstring of a package, without the slash at the end of a folder."""
    text = ast.get_docstring(ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))) or ""
    return {name.rstrip("/") for name in re.findall(r"`([^`]+)`", text) if LIKE_A_MODULE.fullmatch(name)}


def there(folder):
    """The modules of a package and its subpackages."""
    modules = {path.stem for path in folder.glob("*.py")} - {"__init__"}
    return modules | {path.parent.name for path in folder.glob("*/__init__.py")}


@pytest.mark.parametrize("package", PACKAGES, ids=str)
def test_a_map_names_every_module_of_its_room(package):
    assert there(ROOT / package) - named(ROOT / package) == set()


@pytest.mark.parametrize("package", PACKAGES, ids=str)
def test_what_a_map_names_is_there(package):
    for name in named(ROOT / package):
        place = (ROOT / package).joinpath(*re.split("[./]", name))
        assert place.with_suffix(".py").is_file() or (place / "__init__.py").is_file(), name
