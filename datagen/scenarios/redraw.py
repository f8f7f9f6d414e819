"""Impossible draws: drawn again from the next attempt's streams, counted with their reason, and not for ever."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from datagen.errors import BadInput
from datagen.settings.toml_lines import line_of_setting, text_of

if TYPE_CHECKING:
    from datagen.recipes.recipe import Part, Recipe

MOST_ATTEMPTS = 200
# Parameters of the physics whose keys in recipes begin with another word.
KEYS = {
    "amplitudes": "amplitude",
    "bits": "recorder_bits",
    "cutoff": "mounting_cutoff",
    "full_scale": "recorder_range",
    "shaft_speed": "speed",
}


@dataclass(frozen=True)
class Redraw:
    """A draw that no machine or record could have: `scope` "machine" or "record", its number of attempt and why.

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


def given_up(recipe: Recipe, part: Part, what: str, redraws: list[Redraw]) -> BadInput:
    """The error of a part that can hardly be drawn: says how often each parameter was refused and the last reason."""
    counts = Counter(redraw.field or "other" for redraw in redraws)
    refused = ", ".join(f"{field} {count} times" for field, count in counts.most_common())
    place = ("part", recipe.part.index(part))
    refused_last = redraws[-1].field
    line = line_of_setting(text_of(recipe.source), place, KEYS.get(refused_last, refused_last))
    return BadInput(
        f'part "{part.name}", {what}: {len(redraws)} draws in a row were impossible (refused: {refused}); '
        f"the last: {redraws[-1].reason}",
        file=f"{recipe.source}, line {line}" if line else recipe.source,
        field=f"part[{place[1] + 1}]",
    )
