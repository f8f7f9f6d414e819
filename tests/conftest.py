"""What is done before the first test, and in which order files of tests are run."""

import os

# What compiles most comes first: every method, which all others find compiled.
FIRST = ("test_where_methods_fail.py", "test_wheel.py")

# Processes run side by side: threads of linear algebra and of learners would only wait for each other.
for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(threads, "1")


def pytest_sessionstart(session):
    """Compile what records need once, before processes begin that would each compile it."""
    if hasattr(session.config, "workerinput") or session.config.option.collectonly:
        return
    from physics.warming import warm_up

    warm_up()


def pytest_collection_modifyitems(items):
    """Files named above first; all others in the order in which they were found."""
    items.sort(key=lambda item: FIRST.index(item.path.name) if item.path.name in FIRST else len(FIRST))
