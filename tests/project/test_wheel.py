"""The wheel works where the checkout is not."""

import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

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


def test_the_installed_wheel_generates_and_checks_a_corpus_away_from_the_checkout(wheel, tmp_path):
    # Where the path names a checkout, pip takes what was built there for the package.
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    home = tmp_path / "environment"
    venv.create(home, with_pip=True, system_site_packages=False)
    python = home / "bin" / "python"
    # The dependencies are those of this environment; only the package itself is installed anew.
    site = next(Path(path) for path in sys.path if path.endswith("site-packages"))
    subprocess.run([python, "-m", "pip", "install", "-q", "--no-deps", wheel], cwd=tmp_path, env=clean, check=True)
    (next((home / "lib").glob("python*")) / "site-packages" / "dependencies.pth").write_text(f"{site}\n")
    corpus = tmp_path / "corpus"
    for arguments in (["generate", "quickstart", "--out", corpus, "--limit", "2", "--workers", "1"], ["check", corpus]):
        done = subprocess.run(
            [home / "bin" / "spallgen", *arguments],
            cwd=tmp_path,
            env=clean,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
    where = "import physics, pathlib; print(pathlib.Path(physics.__file__).parent)"
    found = subprocess.run([python, "-c", where], cwd=tmp_path, env=clean, capture_output=True, text=True, check=True)
    assert str(home) in found.stdout
