"""Kernels compiled beforehand: a worker that makes records has nothing left to compile."""

import contextlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

from physics import warming

MAKE_RECORDS = """
import gc
from numba.core.dispatcher import Dispatcher
from datagen.recipes.recipe import load_recipe
from datagen.records.record import make_record
from datagen.scenarios.sampling import draw_scenario
from physics.warming import warm_up

def compiled():
    kernels = [kernel for kernel in gc.get_objects() if isinstance(kernel, Dispatcher)]
    return {(kernel.__module__, kernel.__qualname__, len(kernel.signatures)) for kernel in kernels if kernel.signatures}

warm_up()
before = compiled()
for recipe in map(load_recipe, ("datasets/quickstart", "datasets/gearbox_rig", "datasets/corpus")):
    for record in range(6):
        make_record(draw_scenario(recipe, record), ("cage_angle", "profile_depth"))
for late in sorted(compiled() - before):
    print(*late)
"""


def test_no_kernel_is_compiled_after_the_warm_up() -> None:
    done = subprocess.run([sys.executable, "-c", MAKE_RECORDS], capture_output=True, text=True, check=True)
    assert done.stdout == ""
    assert warming.is_warm()  # the cache of that process is this one's too


DRAWN = """
from datagen.recipes.recipe import load_recipe
from datagen.scenarios.sampling import draw_scenario
from physics.warming import is_warm

for record in range(6):
    draw_scenario(load_recipe("datasets/quickstart"), record)
print(is_warm())
"""


@pytest.mark.slow
def test_what_drawing_scenarios_compiles_does_not_pass_for_a_warm_cache(tmp_path: Path) -> None:
    environment = {**os.environ, "SPALLGEN_CACHE": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", DRAWN], capture_output=True, text=True, check=True, env=environment)
    assert done.stdout == "False\n"
    assert any(tmp_path.rglob("*.nbi"))  # or nothing would have been tried


ONE_MARCH = """
from physics.integrators.modal.modal_march import march_modal
from physics.reference_scenes import reference_scene
from physics.simulate import simulate
from physics.trace import Kept
from physics.warming import compile_march

compile_march()
simulate(reference_scene("G1", 0.01), 65536.0, keep=Kept(state=True))
print(len(march_modal.signatures))
"""


def test_the_march_that_is_compiled_on_its_own_is_the_one_that_records_need() -> None:
    done = subprocess.run([sys.executable, "-c", ONE_MARCH], capture_output=True, text=True, check=True)
    assert done.stdout == "1\n"


@pytest.mark.parametrize("damaged", [True, False])
def test_only_a_damaged_cache_is_discarded(damaged, monkeypatch) -> None:
    done = []

    def use():
        done.append("used")
        if done == ["used"]:
            raise ValueError("anything")

    monkeypatch.setattr(warming, "is_warm", lambda: True)
    monkeypatch.setattr(warming, "raised_by_cache", lambda error: damaged and isinstance(error, ValueError))
    monkeypatch.setattr(warming, "_use_every_kernel", use)
    monkeypatch.setattr(warming, "discard_cache", lambda: done.append("discarded"))
    with contextlib.nullcontext() if damaged else pytest.raises(ValueError, match="anything"):
        warming.warm_up()
    assert done == (["used", "discarded", "used"] if damaged else ["used"])
