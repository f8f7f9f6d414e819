"""In which order files of tests are run."""

# What compiles most comes first: the wheel its own copy, and beside it every method, which all others find compiled.
FIRST = ("test_wheel.py", "test_where_methods_fail.py")


def pytest_collection_modifyitems(items):
    """Files named above first; all others in the order in which they were found."""
    items.sort(key=lambda item: FIRST.index(item.path.name) if item.path.name in FIRST else len(FIRST))
