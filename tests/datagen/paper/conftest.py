from functools import cache
from importlib import import_module

import pytest

from datagen.paper.book import CHAPTERS
from datagen.paper.chapter import Chapter

FEW = 2
WITH_SEEDS = ("8", "9", "10")


@cache
def _chapter(key: str) -> Chapter:
    module = import_module(f"datagen.paper.{CHAPTERS[key]}")
    return module.chapter(FEW) if key in WITH_SEEDS else module.chapter()


@pytest.fixture(scope="session")
def chapter():
    """A chapter by its key, computed once; those over seeds with two of them."""
    return _chapter


@pytest.fixture(scope="session")
def ours():
    """Our number of a row by chapter and its quantity, or how that begins; several such rows must agree."""

    def number(key: str, quantity: str) -> float:
        rows = _chapter(key).rows
        named = [row for row in rows if row.quantity == quantity]
        found = {row.ours for row in named or [row for row in rows if row.quantity.startswith(quantity)]}
        assert len(found) == 1, (quantity, found)
        return found.pop()

    return number


@pytest.fixture(scope="session")
def refused():
    """Quantities of a chapter's rows that do not agree with the paper."""
    return lambda key: {row.quantity for row in _chapter(key).rows if row.agrees is False}
