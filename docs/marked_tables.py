"""Tables in the project's pages that a script writes: what stands between two marks, which name table and script."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def write_marked(page: Path, name: str, script: str, text: str) -> None:
    """Put `text` between the marks of the table `name` of `page`, which say that `script` wrote it.

    Raises ValueError where the page does not have both marks exactly once, and leaves it as it is.
    """
    begin, end = f"<!-- {name}: begin (written by {_shown(script)}) -->", f"<!-- {name}: end -->"
    page_text = page.read_text(encoding="utf-8")
    if page_text.count(begin) != 1 or page_text.count(end) != 1 or page_text.index(begin) > page_text.index(end):
        raise ValueError(f"{page} needs {begin} and, behind it, {end}, each once")
    head, rest = page_text.split(begin)
    page.write_text(f"{head}{begin}\n{text}\n{end}{rest.split(end)[1]}", encoding="utf-8")


def _shown(script: str) -> str:
    """The script's `__file__` as the pages name it: from the project's folder, with slashes."""
    return Path(script).resolve().relative_to(ROOT).as_posix()
