"""What is done before the first test, and in which order files of tests are run."""

import os
import shutil
import subprocess
import sys
import tempfile

# What compiles most comes first: every method, which all others find compiled. Beside it what takes one process longest
# without a kernel, so that none is left with it while the other has nothing more to do.
FIRST = ("test_where_methods_fail.py", "test_style.py", "test_wheel.py")

# Processes run side by side: threads of linear algebra and of learners would only wait for each other.
for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(threads, "1")


def pytest_configure(config):
    """Let processes share their bytecode: hundreds begin, and without it each compiles all sources for itself.

    Where none is to be written beside the sources, it goes to a folder that is removed in the end.
    """
    if hasattr(config, "workerinput") or not sys.dont_write_bytecode:
        return
    folder = tempfile.mkdtemp(prefix="spallgen-bytecode-")
    config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    os.environ["PYTHONPYCACHEPREFIX"] = folder


def pytest_sessionstart(session):
    """Compile what records need once, before processes begin that would each compile it; and the tests beside it."""
    if hasattr(session.config, "workerinput") or session.config.option.collectonly:
        return
    from physics.warming import is_warm, warm_up

    if is_warm():
        warm_up()
        return
    collecting = [sys.executable, "-m", "pytest", "--collect-only", "-q"]
    with subprocess.Popen(collecting, cwd=session.config.rootpath, stdout=subprocess.DEVNULL):
        warm_up()


def pytest_collection_modifyitems(items):
    """Files named above first; all others in the order in which they were found."""
    items.sort(key=lambda item: FIRST.index(item.path.name) if item.path.name in FIRST else len(FIRST))
