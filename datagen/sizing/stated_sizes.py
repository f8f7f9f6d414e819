"""Recordings scored by what their publishers state: ball passes are unknown, but the extent or the health is stated."""

from __future__ import annotations

import math
from pathlib import Path

from datagen.corpus_files.index import read_index
from datagen.corpus_files.manifest import read_manifest
from datagen.sizing.bearing_intervals import mean_with_interval
from datagen.sizing.record_errors import extent_error
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_summary import StatedSizes


def summarise_stated(records: list[ScoredRecord]) -> StatedSizes | None:
    """Mean relative error of the arc, with its interval over bearings, of the answered records of a stated extent whose
    passes are unknown, and how many stated healthy were given a size; None if there is nothing of either.

    Records of unknown bearings count as bearings of their own.
    """
    asked = [record for record in records if record.asked and not record.truth.known]
    spalled = [record for record in asked if math.isfinite(record.truth.extent) and record.truth.extent > 0.0]
    healthy = [record for record in asked if record.truth.race == "none"]
    if not spalled and not healthy:
        return None
    answered = [record for record in spalled if record.found]
    errors = [extent_error(record) for record in answered]
    return StatedSizes(
        records=len(spalled),
        answered=len(answered),
        answered_on_the_stated_race=sum(record.answer.race == record.truth.race for record in answered),
        arc_error=mean_with_interval(errors, answered),
        healthy=len(healthy),
        healthy_answered=sum(record.found for record in healthy),
    )


def states_sizes(folder: Path) -> bool:
    """True if the corpus in `folder` is of recordings and states an extent, or that it is healthy, for any of them."""
    if not read_manifest(folder).imported:
        return False
    table = read_index(folder)
    return bool((table["extent"] > 0.0).any() or (table["location"] == "none").any())
