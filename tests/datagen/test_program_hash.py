"""A change of code is noticed where it may change what is stored or learned, and nowhere else."""

import ast
from pathlib import Path

import pytest

from datagen.benchmark.trained import CODE
from datagen.versions import CORPUS_CODE, program_hash

ROOT = Path(__file__).resolve().parents[2]
OURS = ("labels", "datagen")


def only_for_types(node):
    return isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"


def nodes(tree):
    """Every node but those that only a type checker sees."""
    for child in ast.iter_child_nodes(tree):
        if not only_for_types(child):
            yield child
            yield from nodes(child)


def imported(path):
    """Every module that a file names in an import, at its top or inside a function."""
    for node in nodes(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def file_of(module):
    """The file of a module of ours; None for what is none."""
    place = ROOT.joinpath(*module.split("."))
    files = (place.with_suffix(".py"), place / "__init__.py")
    return next((file for file in files if file.is_file()), None) if module.split(".")[0] in OURS else None


def packages_reached(*modules):
    """Packages, as folders, of everything that the modules import, directly or not."""
    files, waiting = set(), list(modules)
    while waiting:
        module = waiting.pop()
        file = file_of(module)
        if file is not None and file not in files:
            files.add(file)
            waiting += [*imported(file), module.rpartition(".")[0]]
    return {file.parent.relative_to(ROOT).as_posix() for file in files}


def test_all_that_draws_describes_and_stores_is_hashed_and_nothing_else():
    assert packages_reached("datagen.runs.generate", "datagen.recordings.importing") == set(CORPUS_CODE)


def test_all_of_ours_that_makes_rows_and_learns_from_them_is_hashed():
    hashed = {package for packages in CODE.values() for package in packages}
    reached = packages_reached("datagen.benchmark.classify")
    theirs = {"datagen/benchmark", "datagen/judging"}
    assert {package for package in reached if package.startswith("labels")} | theirs == hashed


@pytest.fixture
def hash_after(tmp_path, monkeypatch):
    """Function (file or None, *packages) → hash of a source tree of one line a file, that file changed."""

    def run(changed, *packages):
        for package in (*CORPUS_CODE, "labels/classifier", "datagen/benchmark", "datagen/judging", "datagen/paper"):
            (tmp_path / package).mkdir(parents=True, exist_ok=True)
            (tmp_path / package / "one.py").write_text("ONE = 1\n")
        if changed:
            (tmp_path / changed).write_text("ONE = 1  # as before\n")
        monkeypatch.setattr("datagen.versions.__file__", str(tmp_path / "datagen" / "versions.py"))
        program_hash.cache_clear()
        return program_hash(*packages)

    yield run
    program_hash.cache_clear()


@pytest.mark.parametrize("package", CORPUS_CODE)
def test_a_corpus_is_of_another_version_after_a_change_where_records_are_made(hash_after, package):
    assert hash_after(f"{package}/one.py") != hash_after(None)


@pytest.mark.parametrize("package", ["datagen/paper", "datagen/benchmark", "datagen/judging", "labels/classifier"])
def test_a_corpus_is_of_the_same_version_after_a_change_elsewhere(hash_after, package):
    assert hash_after(f"{package}/one.py") == hash_after(None)


def test_a_package_is_hashed_without_those_inside_it(hash_after):
    assert hash_after("labels/classifier/one.py", "labels") == hash_after(None, "labels")
    assert hash_after("labels/classifier/one.py", "labels/classifier") != hash_after(None, "labels/classifier")
