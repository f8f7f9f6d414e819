"""The kind of spall that a record or machine keeps when it is drawn again: condition, race and profile."""

from __future__ import annotations

from datagen.recipes.defect_settings import Combination


class IntendedKind:
    """The `kind` (condition, race, profile) that all attempts at one record or machine share; None until one is drawn.

    If every attempt drew its own, a kind that is often impossible would silently turn into others. So from the first
    refusal on that another kind of spall might have been spared, the kind is binding. An attempt that is refused
    whatever the kind leaves the next one free to draw another kind of spall: no shares move. It never becomes healthy.
    """

    def __init__(self, kind: Combination | None = None) -> None:
        self.kind = kind
        self._is_binding = self._was_binding = kind is not None

    def settle(self, drawn: Combination) -> Combination:
        """The kind of an attempt that drew this one; it is binding for the next ones, unless `release` follows."""
        if self.kind is None or not (self._is_binding or drawn[0] == "healthy"):
            self.kind = drawn
        self._was_binding, self._is_binding = self._is_binding, True
        return self.kind

    def release(self) -> None:
        """This attempt was refused whatever its kind: the kind is as binding as it was before."""
        self._is_binding = self._was_binding
