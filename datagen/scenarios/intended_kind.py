"""The kind of spall that a record or machine keeps when it is drawn again: condition, race and profile."""

from __future__ import annotations

from datagen.recipes.defect_settings import Combination
from labels.schema import HEALTHY


class IntendedKind:
    """The `kind` (condition, race, profile) that all attempts at one record or machine share; None until one is drawn.

    If every attempt drew its own kind, one that is often impossible would silently turn into others. So once an attempt
    is refused that might have succeeded with another kind of spall, its kind is binding for all later attempts. An
    attempt that would be refused whatever its kind leaves the next one free to draw another kind of spall, which shifts
    no shares; it never becomes healthy.
    """

    def __init__(self, kind: Combination | None = None) -> None:
        self.kind = kind
        self._is_binding = self._was_binding = kind is not None

    def settle(self, drawn: Combination) -> Combination:
        """The kind that an attempt is to have, given the one it has `drawn`; binding from now on, unless `release`
        follows."""
        if self.kind is None or not (self._is_binding or drawn[0] == HEALTHY):
            self.kind = drawn
        self._was_binding, self._is_binding = self._is_binding, True
        return self.kind

    def release(self) -> None:
        """Leave the kind as binding as it was before the last `settle`: that attempt would have been refused whatever
        its kind."""
        self._is_binding = self._was_binding
