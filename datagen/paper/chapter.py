"""One figure of the paper with its table: what every chapter of the comparison gives back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from datagen.paper.published import Published, published

if TYPE_CHECKING:
    from matplotlib.figure import Figure


ROUNDING = 1e-12


@dataclass(frozen=True)
class Row:
    """One line of a table: the paper's number or words, ours, and whether they agree (None: nothing to compare)."""

    quantity: str
    ours: float
    unit: str
    paper: float | None = None
    claim: str = ""
    sense: str = "equal"
    agrees: bool | None = None
    comment: str = ""
    where: str = ""

    @property
    def difference(self) -> float | None:
        """Ours minus the paper's, rounding taken off, where the paper prints a number that ours should equal."""
        if self.paper is None or self.sense != "equal":
            return None
        difference = self.ours - self.paper
        return difference if abs(difference) > ROUNDING * abs(self.paper) else 0.0


@dataclass(frozen=True)
class Chapter:
    """One figure: its file name without ending, title, what was computed, table and how it is drawn."""

    name: str
    title: str
    text: str
    rows: tuple[Row, ...]
    draw: Callable[[], Figure]


def beside(
    chapter: str, key: str, quantity: str, ours: float, comment: str = "", *, agrees: bool | None = None, unit: str = ""
) -> Row:
    """A row with what the paper prints under `key`; `agrees` judges a claim in words, a number judges itself."""
    said: Published = published(chapter, key)
    verdict = said.holds(ours) if agrees is None else bool(agrees)
    return Row(
        quantity=quantity,
        ours=float(ours),
        unit=said.unit or unit,
        paper=said.value,
        claim=said.claim,
        sense=said.sense,
        agrees=verdict,
        comment=comment,
        where=said.where,
    )


def only_ours(quantity: str, ours: float, unit: str, comment: str = "") -> Row:
    """A row for a number of ours beside which the paper prints nothing."""
    return Row(quantity, float(ours), unit, comment=comment)
