"""What a record or machine is meant to be, whatever of it has to be drawn again: its condition, race and profile."""

from __future__ import annotations

from datagen.recipes.defect_settings import Combination


class Meant:
    """The `kind` (condition, race, profile) that the attempts at one record or machine have; None until one is drawn.

    A kind that is often impossible would otherwise turn silently into one that is not. It binds from the first refusal
    on that another kind might have been spared. What no kind of spall could have is refused alike for all of them, so
    the next attempt may draw another kind of spall, and no shares move; it never becomes healthy.
    """

    def __init__(self, kind: Combination | None = None) -> None:
        self.kind = kind
        self._binds = self._bound = kind is not None

    def settle(self, drawn: Combination) -> Combination:
        """The kind of an attempt that drew this one; it binds the next ones, unless `release` follows."""
        if self.kind is None or not (self._binds or drawn[0] == "healthy"):
            self.kind = drawn
        self._bound, self._binds = self._binds, True
        return self.kind

    def release(self) -> None:
        """What this attempt drew was impossible for every kind of spall: it binds no more than those before it did."""
        self._binds = self._bound
