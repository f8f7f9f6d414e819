"""Draws that were refused: what was impossible of each, and how often each parameter was."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Redraw:
    """An impossible draw of a machine or record (`scope`): the number of the attempt, and why it was refused.

    `field` names the parameter that was refused, a short key to count by; `reason` is a sentence with its numbers.
    """

    scope: str
    attempt: int
    field: str
    reason: str


@dataclass(frozen=True)
class Refused:
    """How many draws were refused for one parameter, and the sentence that one of them gave as its reason."""

    count: int
    example: str


def count_refused(redraws: Iterable[Redraw]) -> dict[str, Refused]:
    """Refused draws by "scope: parameter"."""
    return add_refused({f"{redraw.scope}: {redraw.field or 'other'}": Refused(1, redraw.reason)} for redraw in redraws)


def add_refused(counted: Iterable[dict[str, Refused]]) -> dict[str, Refused]:
    """The sums of several counts, the most frequent first; of the reasons the first is kept."""
    total: dict[str, Refused] = {}
    for counts in counted:
        for what, more in counts.items():
            before = total.get(what, Refused(0, more.example))
            total[what] = replace(before, count=before.count + more.count)
    return dict(sorted(total.items(), key=lambda item: (-item[1].count, item[0])))
