"""Numbers with their origin: what a source prints, what we assumed, and where a source contradicts itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from decimal import Decimal
from typing import Any, NamedTuple

from physics.rig import Rig


@dataclass(frozen=True)
class Sourced:
    """A number in SI, who says so, and whether it is our assumption because no source does."""

    value: float
    unit: str
    source: str
    assumed: bool = False
    note: str = ""


@dataclass(frozen=True)
class Claim:
    """A number that a source prints beside the numbers from which it follows; `computed` makes ours from those.

    `printed` is its text, so that the digits given are known.
    """

    quantity: str
    printed: str
    unit: str
    source: str
    computed: Callable[[Rig], float]
    comment: str = ""

    def row(self, name: str, rig: Rig) -> CatalogRow:
        """The printed number as a line of the catalogue, with what the numbers of its `rig` give."""
        ours = self.computed(rig)
        verdict = " (agrees)" if self.agrees(ours) else ""
        note = f"source prints {self.printed}, its numbers give {ours:.6g}{verdict}"
        note += f"; {self.comment}" if self.comment else ""
        value = float(self.printed)
        return CatalogRow("rig", name, f"{self.quantity} (printed)", value, self.unit, self.source, False, note)

    def agrees(self, value: float) -> bool:
        """True if `value` rounds to the printed digits."""
        exponent = Decimal(self.printed).as_tuple().exponent
        return abs(value - float(self.printed)) <= 0.5001 * 10.0 ** int(exponent)


class CatalogRow(NamedTuple):
    """One printable line of the catalogue."""

    kind: str
    name: str
    quantity: str
    value: float
    unit: str
    source: str
    assumed: bool
    note: str


def assumed(value: float, unit: str, reason: str) -> Sourced:
    """A number that no source gives; `reason` says why this one."""
    return Sourced(value, unit, "assumed", True, reason)


def sourced_fields(entry: Any) -> Iterator[tuple[str, Sourced]]:
    """Name and number of every Sourced field of a catalogue entry, in the order of its class."""
    for field in fields(entry):
        number = getattr(entry, field.name)
        if isinstance(number, Sourced):
            yield field.name, number
