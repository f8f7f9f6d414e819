"""The same bits whatever vector instructions the kernels are compiled for."""

import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import hashlib
from physics.reference_scenes import reference_scene
from physics.simulate import simulate
digest = hashlib.sha256()
for name in ("G1", "F1", "F2r"):
    trace = simulate(reference_scene(name, 0.03, slip_seed=1), 65536.0)
    digest.update(trace.acceleration.tobytes() + trace.changes.time.tobytes())
print(digest.hexdigest())
"""
# A processor's name for numba, and the instructions it needs: a machine without them could not run the code.
TARGETS = {"x86-64": "sse2", "haswell": "avx2", "skylake-avx512": "avx512f"}


def supported():
    """The targets that this machine can run."""
    if platform.machine() != "x86_64" or not Path("/proc/cpuinfo").exists():
        return []
    flags = set(Path("/proc/cpuinfo").read_text().split())
    return [name for name, needed in TARGETS.items() if needed in flags]


def digest(target, cache):
    """Hash of three responses from kernels compiled for `target` alone."""
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        cwd=Path(__file__).parents[2],
        env={**os.environ, "NUMBA_CPU_NAME": target, "NUMBA_CPU_FEATURES": "", "SPALLGEN_CACHE": str(cache)},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


@pytest.mark.slow
def test_kernels_for_old_and_new_processors_give_the_same_bits(tmp_path):
    targets = supported()
    if len(targets) < 2:
        pytest.skip("this machine runs code for one of these processors at most, so there is nothing to compare")
    digests = {target: digest(target, tmp_path / target) for target in targets}
    assert len(set(digests.values())) == 1, digests
    assert all(len(found) == 64 for found in digests.values())
