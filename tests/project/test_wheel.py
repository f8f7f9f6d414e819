"""The wheel works where the checkout is not."""

import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The built wheel; its build tree is a copy, so that nothing is left in the checkout."""
    copy, out = tmp_path_factory.mktemp("checkout"), tmp_path_factory.mktemp("dist")
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in tracked.splitlines():
        source, target = ROOT / name, copy / name
        if source.is_file():
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(source.read_bytes())
    done = subprocess.run(
        [sys.executable, "-m", "build", "--wheel", "--outdir", out, copy], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return next(out.glob("*.whl"))


def test_the_wheel_holds_the_packages_and_the_recipes_and_no_test(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    for wanted in (
        "physics/simulate.py",
        "labels/schema.py",
        "datagen/cli.py",
        "datagen/datasets/quickstart/recipe.toml",
        "datagen/datasets/quickstart/expected.json",
        "datagen/datasets/recordings/cwru.toml",
        "datagen/datasets/recordings/cwru_normal.csv",
        "datagen/datasets/recordings/mfpt.toml",
        "datagen/paper/published.toml",
        "datagen/benchmark/transfer_rows.npz",
        "datagen/sizing/calibration.npz",
    ):
        assert wanted in names
    assert not [name for name in names if name.startswith(("tests/", "docs/"))]


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """Function (program, *arguments) → output of a program of an environment into which the wheel was installed.

    The dependencies are those of this environment; only the package itself is installed anew.
    """
    home, away = tmp_path_factory.mktemp("environment"), tmp_path_factory.mktemp("away")
    # Where the path names a checkout, pip takes what was built there for the package.
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    venv.create(home, with_pip=True, system_site_packages=False)

    def run(program, *arguments):
        command = [home / "bin" / program, *arguments]
        done = subprocess.run(command, cwd=away, env=clean, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run("python", "-m", "pip", "install", "-q", "--no-deps", wheel)
    site = next(Path(path) for path in sys.path if path.endswith("site-packages"))
    (next((home / "lib").glob("python*")) / "site-packages" / "dependencies.pth").write_text(f"{site}\n")
    assert str(home) in run("python", "-c", "import physics; print(physics.__file__)")
    return run


EVERY_MODULE = """
import importlib, pkgutil, datagen, labels, physics

for package in (datagen, labels, physics):
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        if not module.name.endswith("__main__"):
            print(importlib.import_module(module.name).__name__)
"""


def test_every_module_of_the_installed_wheel_can_be_imported(installed):
    modules = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for package in ("datagen", "labels", "physics")
        for path in (ROOT / package).rglob("*.py")
        if path.stem not in ("__init__", "__main__")
    }
    assert modules <= set(installed("python", "-c", EVERY_MODULE).split())


def test_the_installed_wheel_imports_and_checks_a_recording(installed, tmp_path):
    np.save(tmp_path / "noise.npy", np.random.default_rng(0).standard_normal(4000))
    settings = 'name = "r"\nfiles = "noise.npy"\nunit = "g"\nrate_hz = 1000\ny = "data"\n'
    (tmp_path / "spec.toml").write_text(f'name = "s"\n[[recording]]\n{settings}')
    installed("spallgen", "import", tmp_path / "spec.toml", "--out", tmp_path / "corpus")
    assert "sound" in installed("spallgen", "check", tmp_path / "corpus")


@pytest.mark.slow
def test_the_installed_wheel_generates_and_checks_a_corpus_away_from_the_checkout(installed, tmp_path):
    corpus = tmp_path / "corpus"
    installed("spallgen", "generate", "quickstart", "--out", corpus, "--limit", "2", "--workers", "1")
    assert "sound" in installed("spallgen", "check", corpus)
