"""Import arrows point one way: datagen to labels and physics, labels to physics, physics to nobody of ours."""

import ast
import re
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MAY_IMPORT = {
    "physics": {"physics"},
    "labels": {"labels", "physics"},
    "datagen": {"datagen", "labels", "physics"},
}
ABOUT_FILES = {"xarray", "netCDF4", "pathlib", "io", "shutil", "tempfile", "pandas", "matplotlib"}
# Compiled kernels are cached in a folder; this is the one place of physics that knows of folders.
NUMBA_DOOR = ROOT / "physics" / "_jit"
CACHE_DOOR = NUMBA_DOOR / "cache.py"
# The rooms of physics and of labels: each may import from those before it, itself or by way of the package's own files,
# and from no other.
ROOMS = {
    "physics": (
        "_jit",
        "paths",
        "contact",
        "statics",
        "integrators",
        "integrators.modal",
        "integrators.reference",
        "integrators.rivals",
        "response",
        "sensor",
        "ladder",
        "catalog",
        "backgrounds",
    ),
    "labels": (
        "features",
        "classifier",
        "spall_size",
        "spall_size.signal",
        "spall_size.events",
        "spall_size.columns",
        "spall_size.estimation",
    ),
}
PLACES = [(package, room) for package, rooms in ROOMS.items() for room in rooms]
# The floors of datagen, packages and lone files: each may import from itself and from those before it.
FLOORS = (
    ("counts", "errors", "exits", "freed_memory", "garbage", "processes", "progress", "versions"),
    ("files",),
    ("distributions",),
    ("settings",),
    ("formats",),
    ("recipes",),
    ("scenarios",),
    ("records",),
    ("corpus_files",),
    ("corpus",),
    ("recordings",),
    ("runs",),
    ("inspection",),
    ("judging",),
    ("benchmark", "sizing"),
    ("charts",),
    ("drawing",),
    ("paper",),
    ("cards",),
    ("commands",),
    ("cli",),
    ("__main__",),
)
FLOOR_OF = {name: floor for floor, names in enumerate(FLOORS) for name in names}


def imported(path):
    """Top-level names of every module that a file imports, anywhere in it."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module.split(".")[0])
    return names


def files(package):
    return sorted((ROOT / package).rglob("*.py"))


@pytest.mark.parametrize("package", MAY_IMPORT)
def test_imports_follow_the_arrows(package):
    for path in files(package):
        assert imported(path) & set(MAY_IMPORT) <= MAY_IMPORT[package], path


@pytest.mark.parametrize("package", ["physics", "labels"])
def test_only_datagen_reads_and_writes_files(package):
    for path in files(package):
        if path != CACHE_DOOR:
            assert not imported(path) & ABOUT_FILES, path
            assert not re.search(r"\bopen\(", path.read_text(encoding="utf-8")), path


def test_numba_has_one_door():
    for package in MAY_IMPORT:
        for path in files(package):
            assert path.parent == NUMBA_DOOR or "numba" not in imported(path), path


@pytest.mark.parametrize("package", MAY_IMPORT)
def test_modules_with_a_private_name_are_imported_by_their_own_package_alone(package):
    for path in files(package):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module and not node.module.startswith(f"{package}."):
                names = (*node.module.split("."), *(alias.name for alias in node.names))
                ours = node.module.split(".")[0] in MAY_IMPORT
                assert not (ours and any(name.startswith("_") for name in names)), path


def run(tree):
    """Every node of a module but those that only a type checker reads."""
    ahead = [tree]
    while ahead:
        node = ahead.pop()
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            ahead += node.orelse
        else:
            yield node
            ahead += ast.iter_child_nodes(node)


def module_of(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def test_no_module_imports_itself_by_way_of_others():
    ours = {module_of(path): path for package in MAY_IMPORT for path in files(package)}
    arrows = {}
    for module, path in ours.items():
        found = [node for node in run(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.ImportFrom)]
        named = {(node.module, f"{node.module}.{alias.name}") for node in found for alias in node.names}
        arrows[module] = {inner if inner in ours else outer for outer, inner in named} & set(ours)
    TopologicalSorter(arrows).prepare()


def room_of(package, module):
    """The room that a module is or lies in, e.g. integrators.modal; empty for one of the package's own files."""
    folder = module if ROOT.joinpath(*module.split(".")).is_dir() else module.rpartition(".")[0]
    return folder.removeprefix(package).lstrip(".")


def modules_imported(package, module):
    """Modules of a package that one of them imports, anywhere in it."""
    path = ROOT.joinpath(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    tree = ast.parse(path.read_text(encoding="utf-8"))
    named = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module}
    return {name for name in named if name.startswith(f"{package}.")}


def rooms_reached(package, module):
    """Rooms from which a module imports, itself or by way of the package's own files."""
    rooms, ahead, seen = set(), modules_imported(package, module), set()
    while ahead:
        found = ahead.pop()
        if room_of(package, found):
            rooms.add(room_of(package, found))
        elif found not in seen:
            seen.add(found)
            ahead |= modules_imported(package, found)
    return rooms


def modules_in(folder):
    return [module_of(path) for path in sorted(folder.glob("*.py"))]


@pytest.mark.parametrize("package", ROOMS)
def test_every_room_has_its_place(package):
    folders = {".".join(path.parent.relative_to(ROOT / package).parts) for path in files(package)}
    assert folders - {""} == set(ROOMS[package])


@pytest.mark.parametrize(("package", "room"), PLACES)
def test_rooms_import_only_from_those_before_them(package, room):
    allowed = set(ROOMS[package][: ROOMS[package].index(room) + 1])
    for module in modules_in((ROOT / package).joinpath(*room.split("."))):
        assert rooms_reached(package, module) <= allowed, module


def test_own_files_of_labels_import_from_no_room():
    for module in modules_in(ROOT / "labels"):
        assert not rooms_reached("labels", module), module


def datagen_imported(path):
    """Packages and lone files of datagen that a file imports, anywhere in it."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            where = node.module.split(".")
            if where[0] == "datagen":
                yield from [where[1]] if len(where) > 1 else [alias.name for alias in node.names]


def test_packages_of_datagen_import_only_from_floors_below_them():
    for path in files("datagen"):
        own = path.relative_to(ROOT / "datagen").with_suffix("").parts[0]
        if own != "__init__":
            above = {name for name in datagen_imported(path) if FLOOR_OF[name] > FLOOR_OF[own]}
            assert not above, f"{path} imports from {above}"
