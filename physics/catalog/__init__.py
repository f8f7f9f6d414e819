"""The catalogue: named bearings and rigs, and a printable table of every number with its source.

- `bearings`, `rigs`: the entries; `sourced`: a number with its origin
- `claims`: what the sources print besides their parameters, beside what those parameters give
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from physics.bearing import Bearing
from physics.catalog.bearings import BEARINGS, CatalogBearing
from physics.catalog.rigs import RIGS, CatalogRig
from physics.catalog.sourced import CatalogRow, sourced_fields
from physics.checks import InvalidParameter
from physics.rig import Rig
from physics.spelling import suggestion

__all__ = ["BEARINGS", "RIGS", "CatalogBearing", "CatalogRig", "bearing", "catalog_rows", "rig"]


def bearing(name: str) -> Bearing:
    """The bearing of that name; raises InvalidParameter with the nearest known name."""
    _require_known("bearing", name, BEARINGS)
    return BEARINGS[name].build(name)


def rig(name: str) -> Rig:
    """The rig of that name; raises InvalidParameter with the nearest known name."""
    _require_known("rig", name, RIGS)
    return RIGS[name].build(name)


def catalog_rows() -> list[CatalogRow]:
    """Every number of the catalogue and every claim of its sources, one printable row each, SI units."""
    rows: list[CatalogRow] = []
    for name, bearing_entry in BEARINGS.items():
        rows += _number_rows("bearing", name, bearing_entry)
    for name, rig_entry in RIGS.items():
        rows += _number_rows("rig", name, rig_entry)
        rows += [claim.row(name, rig_entry.build(name)) for claim in rig_entry.claims]
    return rows


def _number_rows(kind: str, name: str, entry: CatalogBearing | CatalogRig) -> Iterator[CatalogRow]:
    for quantity, number in sourced_fields(entry):
        yield CatalogRow(kind, name, quantity, number.value, number.unit, number.source, number.assumed, number.note)


def _require_known(kind: str, name: str, known: Iterable[str]) -> None:
    names = list(known)
    if name in names:
        return
    problem = f'{kind} = "{name}" is not in the catalogue: {", ".join(names)}{suggestion(name, names)}'
    raise InvalidParameter(problem, kind)
