"""What tests of pages about recipes share: the settings that a recipe draws, by name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from datagen.distributions.kinds import NAMES


def drawn_settings(node: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, dict[str, Any]]]:
    """Name and table of every drawn setting below `node`, of a recipe's file; parts leave no trace in the name."""
    if isinstance(node, list):
        for item in node:
            yield from drawn_settings(item, path)
    elif isinstance(node, dict) and any(name in node for name in NAMES):
        yield ".".join(path), node
    elif isinstance(node, dict):
        for key, value in node.items():
            yield from drawn_settings(value, path if key == "part" else (*path, key))


def stated_values(drawn: dict[str, Any]) -> list[Any]:
    """All ends, options, weights and limits of a drawn setting."""
    return [value for held in drawn.values() for value in (held if isinstance(held, list) else [held])]


def as_written(value: Any) -> str:
    """A value as the pages write it."""
    return f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)
