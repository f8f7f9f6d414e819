"""The linter and the type checker are part of the tests."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("physics", "labels", "datagen", "docs", "tests")
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
# What is left in a docstring where a string of several parts was wrapped: a quote ends a line and begins the next.
WRAPPED = re.compile(r'"[ ]*\n[ ]*"')


@pytest.mark.parametrize("tool", [["ruff", "check", "--no-cache", "."], ["mypy"]], ids=["ruff", "mypy"])
def test_the_code_passes(tool):
    done = subprocess.run([sys.executable, "-m", *tool], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def docstrings(text):
    """Line and text of every docstring of a module's source."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, DOCUMENTED) and (found := ast.get_docstring(node, clean=False)) is not None:
            yield node.body[0].lineno, found


def test_no_docstring_holds_the_quotes_of_a_wrapped_string():
    assert [WRAPPED.search(found) is not None for _, found in docstrings('"""One "\n    "two."""')] == [True]
    paths = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py"))]
    broken = [
        f"{path.relative_to(ROOT)}:{line}"
        for path in paths
        for line, found in docstrings(path.read_text(encoding="utf-8"))
        if WRAPPED.search(found)
    ]
    assert not broken, broken
