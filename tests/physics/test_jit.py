"""The door to numba: one cache folder per content of the physics, kernels that agree, a cure for a damaged cache."""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numba
import numpy as np
import pytest
from numba.core.caching import NullCache

import physics
from physics._jit import (
    CACHE_FOLDER,
    cache,
    fingerprint,
    keep_arguments_apart,
    njit,
    njit_inline,
    njit_inner,
    njit_lean,
    njit_pasted,
    raised_by_cache,
    specialise,
)

PACKAGE = Path(physics.__file__).parent


@pytest.fixture
def copied(tmp_path, monkeypatch):
    """A copy of the physics package which `fingerprint` reads instead."""
    copy = tmp_path / "physics"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(cache, "__file__", str(copy / "_jit" / "cache.py"))
    return copy


def test_a_copy_of_the_physics_has_the_same_fingerprint(copied, monkeypatch):
    of_copy = fingerprint()
    monkeypatch.undo()
    assert of_copy == fingerprint()
    assert len(of_copy) == 16


@pytest.mark.parametrize("name", ["contact/forces.py", "integrators/fixed_step_march.py", "_jit/cache.py"])
def test_the_fingerprint_changes_with_the_text_of_any_file(copied, name):
    before = fingerprint()
    file = copied / name
    text = file.read_text(encoding="utf-8")
    file.write_text(text + "\n", encoding="utf-8")
    assert fingerprint() != before
    file.write_text(text, encoding="utf-8")
    assert fingerprint() == before


def test_the_fingerprint_changes_when_a_file_comes_goes_or_is_renamed(copied):
    before = fingerprint()
    (copied / "new.py").write_text("", encoding="utf-8")
    with_new = fingerprint()
    (copied / "new.py").rename(copied / "newer.py")
    assert len({before, with_new, fingerprint()}) == 3
    (copied / "newer.py").unlink()
    assert fingerprint() == before


def test_the_fingerprint_does_not_depend_on_anything_but_python_files(copied):
    before = fingerprint()
    (copied / "notes.txt").write_text("not physics", encoding="utf-8")
    (copied / "__pycache__").mkdir()
    (copied / "__pycache__" / "contact.pyc").write_bytes(b"compiled")
    assert fingerprint() == before


def test_the_cache_folder_is_named_by_a_fingerprint_and_the_version_of_numba():
    name, version = CACHE_FOLDER.name.split("-", 1)
    assert len(name) == 16
    assert version == f"numba{numba.__version__}"
    assert Path(numba.config.CACHE_DIR) == CACHE_FOLDER


def polynomial(values):
    total = 0.0
    for k in range(values.size):
        total += values[k] * values[k] / (1.0 + values[k])
    return total


called = njit(polynomial)
parts = {decorator.__name__: decorator(polynomial) for decorator in (njit_inner, njit_inline, njit_pasted)}


@njit
def calling(values):
    return 3.0 * called(values) - values[0]


@pytest.mark.parametrize("name", parts)
def test_a_part_of_a_kernel_gives_the_same_bits_as_a_called_one_and_as_plain_python(name):
    part, values = parts[name], np.random.default_rng(0).uniform(0.0, 2.0, 1001)

    @njit
    def calling_part(values):
        return 3.0 * part(values) - values[0]

    assert calling(values) == calling_part(values) == 3.0 * polynomial(values) - values[0]


@pytest.mark.parametrize("name", ["njit_inner", "njit_inline"])
def test_a_part_without_a_door_to_python_says_so_compiled_or_not(name):
    part = {"njit_inner": njit_inner, "njit_inline": njit_inline}[name](polynomial)
    with pytest.raises(TypeError, match="polynomial is a part of compiled kernels"):
        part(np.ones(3))
    njit(lambda values: part(values))(np.ones(3))
    with pytest.raises(TypeError, match="call its py_func"):
        part(np.ones(3))
    assert part.py_func(np.ones(3)) == 1.5


def test_a_kernel_divides_by_zero_as_numpy_does():
    assert called(np.array([-1.0])) == np.inf


slope = 1.0  # replaced by each binding


def line(x):
    """A straight line."""
    return slope * x


def test_a_specialised_kernel_has_its_bindings_built_in():
    steep, flat = specialise(line, "steep", slope=3.0), specialise(line, "flat", slope=0.5)
    assert (steep(2.0), flat(2.0)) == (6.0, 1.0)
    assert steep.__name__ == "steep"
    assert flat.__doc__ == line.__doc__


KERNEL = """
import sys
from physics._jit import CACHE_FOLDER, discard_cache, njit, raised_by_cache

@njit
def square(x):
    return x * x

try:
    answer = square(3.0)
except Exception as damage:
    discard_cache()
    answer = square(3.0)
    print("damaged", type(damage).__name__, raised_by_cache(damage))
print(answer, sum(square.stats.cache_hits.values()))
print(CACHE_FOLDER)
"""


def run_kernel(folder, home):
    script = folder / "kernel.py"
    if not script.exists():
        script.write_text(KERNEL, encoding="utf-8")
    environment = {**os.environ, "SPALLGEN_CACHE": str(home), "PYTHONPATH": str(PACKAGE.parent)}
    done = subprocess.run(
        [sys.executable, str(script)], env=environment, capture_output=True, text=True, check=False, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


CACHED_OR_NOT = """
import sys
sys.path.insert(0, "")
from physics._jit import is_cached
from physics.statics.rest import solve_at
from physics.statics.successive_rest import expected
import numpy as np

before = is_cached(expected)
expected(np.zeros((4, 2)), 1, 1)
print(before, is_cached(expected), is_cached(solve_at))
"""


def test_a_kernel_is_cached_once_it_is_compiled_not_once_it_or_another_one_is_defined(tmp_path):
    environment = {**os.environ, "SPALLGEN_CACHE": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", CACHED_OR_NOT], capture_output=True, text=True, check=True, env=environment
    )
    assert done.stdout == "False True False\n"


OUTPUT = {"capture_output": True, "text": True, "check": True}
PARTS = """
from physics._jit import njit, njit_inline, njit_inner

@njit_inner
def square(x):
    return x * x

@njit_inline
def fourth(x):
    return square(square(x))

@njit
def fifth(x):
    return x * fourth(x)

print(fifth(2.0), sum(square.stats.cache_hits.values()), sum(fifth.stats.cache_hits.values()))
"""


def test_parts_are_kept_inside_the_kernels_that_call_them_and_nowhere_else(tmp_path):
    # A kernel built around a part that was read from the disk is other machine code, which may be slower.
    environment = {**os.environ, "SPALLGEN_CACHE": str(tmp_path / "cache"), "PYTHONPATH": str(PACKAGE.parent)}
    (script := tmp_path / "kernel.py").write_text(PARTS, encoding="utf-8")
    answers = [subprocess.run([sys.executable, str(script)], env=environment, **OUTPUT).stdout for _ in range(2)]
    assert answers == ["32.0 0 0\n", "32.0 0 1\n"]
    assert {file.name.split("-")[0] for file in tmp_path.rglob("*.nbc")} == {"kernel.fifth"}


CUT_INSIDE = """
from physics._jit import njit, njit_lean, raised_by_cache

@njit_lean
def square(x):
    return x * x

@njit
def fourth(x):
    return square(square(x))

try:
    print(fourth(2.0))
except Exception as damage:
    print("damaged", raised_by_cache(damage))
"""


@pytest.mark.parametrize("name", ["square", "fourth"])
def test_a_cut_file_is_recognised_also_of_a_kernel_that_another_one_calls(name, tmp_path):
    def run():
        environment = {**os.environ, "SPALLGEN_CACHE": str(tmp_path / "cache"), "PYTHONPATH": str(PACKAGE.parent)}
        done = subprocess.run([sys.executable, str(script)], env=environment, **OUTPUT)
        return done.stdout

    script = tmp_path / "kernel.py"
    script.write_text(CUT_INSIDE, encoding="utf-8")
    assert run() == "16.0\n"
    for file in tmp_path.rglob("*.nbi"):
        # Without its own file the caller is compiled anew, and reads what it calls from the cache.
        if name in file.name or name == "square":
            file.write_bytes(file.read_bytes()[:10]) if name in file.name else file.unlink()
    assert run() == "damaged True\n"


def test_an_error_of_a_kernel_or_of_the_disk_is_none_of_the_cache():
    with pytest.raises(ZeroDivisionError) as own:
        _ = 1 / 0
    assert not raised_by_cache(own.value)
    with pytest.raises(FileNotFoundError) as missing:
        numba.core.caching.IndexDataCacheFile("/nowhere", "index", None).save(1, 2)
    assert not raised_by_cache(missing.value)


def test_an_error_to_which_a_cut_file_led_is_one_of_the_cache(tmp_path):
    (tmp_path / "cut.nbi").write_bytes(b"\x80\x04")
    with pytest.raises(EOFError) as cut:
        numba.core.caching.IndexDataCacheFile(str(tmp_path), "cut", None).load(1)
    while_compiling = RuntimeError("while compiling")
    while_compiling.__cause__ = cut.value
    assert raised_by_cache(while_compiling)


def test_a_cut_cache_file_is_cured_by_discarding_the_cache(tmp_path):
    home = tmp_path / "cache"
    answer, folder = run_kernel(tmp_path, home)
    assert answer == "9.0 0"
    assert Path(folder).parent == home / "spallgen"
    assert run_kernel(tmp_path, home)[0] == "9.0 1"
    cut = sorted(Path(folder).rglob("*.nb[ci]"))
    assert len(cut) == 2
    for file in cut:
        file.write_bytes(file.read_bytes()[:10])
    damaged, answer, _ = run_kernel(tmp_path, home)
    assert damaged.startswith("damaged")
    assert damaged.endswith("True")
    assert answer.startswith("9.0")
    assert run_kernel(tmp_path, home)[0] == "9.0 1"


def test_without_a_writable_place_the_cache_goes_to_a_temporary_folder_for_as_long_as_it_is_used(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("not a folder", encoding="utf-8")
    answer, folder = run_kernel(tmp_path, blocked)
    assert answer == "9.0 0"
    assert "spallgen-cache-" in folder
    assert not Path(folder).exists()


def test_a_user_without_a_home_gets_a_cache_of_his_own(monkeypatch):
    def nowhere():
        raise RuntimeError("Could not determine home directory.")

    for name in ("SPALLGEN_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(cache.Path, "home", nowhere)
    folder = cache._cache_folder()
    assert folder.is_dir()
    assert Path(tempfile.gettempdir()) in folder.parents
    monkeypatch.delenv("SPALLGEN_CACHE")


def test_a_kernel_that_keeps_its_arguments_apart_aligns_its_own_stack_and_computes_the_same():
    @njit_lean
    def plain(values):
        return 3.0 * called(values)

    @njit_lean
    def apart(values):
        keep_arguments_apart()
        return 3.0 * called(values)

    for kernel in (plain, apart):
        kernel._cache = NullCache()  # one that an earlier run of the tests left there would not show its code
    values = np.linspace(0.0, 1.0, 7)
    assert apart(values) == plain(values) == apart.py_func(values)
    # What the processor is told differs by machine; what the compiler is told does not.
    [(signature, code)] = apart.inspect_llvm().items()
    assert "alignstack=64" in code
    assert "alignstack" not in plain.inspect_llvm(signature)
