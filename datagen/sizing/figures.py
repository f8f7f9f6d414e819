"""The figures of the scored records: mean errors by level of noise, abstentions and coverage, beside their targets."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from datagen.sizing.bearing_intervals import mean_with_interval
from datagen.sizing.record_errors import RULES, extent_error, lag_error, noise_level, noise_levels, noise_title, silent
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_summary import Figure
from labels.spall_size.size_estimate import Bounds

# What the mean relative error of the lag and of the arc, by level of noise (dB), and the shares are to be.
LAG_TARGETS = {math.inf: 0.05, 10.0: 0.10}
ARC_TARGETS = {math.inf: 0.10, 10.0: 0.15}
NO_ESTIMATE_TARGETS = {math.inf: 0.05}
ABSTENTION_TARGET = 0.95
COVERAGE_TARGET = (0.85, 0.95)


def figures_of(records: list[ScoredRecord], load_known: bool) -> list[Figure]:
    """Every figure of the scored records, with its target where it has one."""
    scorable = [record for record in records if record.scorable]
    answered = [record for record in scorable if record.found]
    figures: list[Figure] = []
    for level in noise_levels(scorable):
        name = noise_title(level)
        sized = [record for record in answered if noise_level(record) == level]
        asked = [record for record in scorable if noise_level(record) == level]
        figures.append(_figure(f"lag error, {name}", sized, lag_error, LAG_TARGETS.get(level)))
        arc_target = ARC_TARGETS.get(level) if load_known else None
        figures.append(_figure(f"arc error, {name}", sized, extent_error, arc_target))
        figures += [_figure(f"arc error by rule: {rule}, {name}", sized, error) for rule, error in RULES.items()]
        figures.append(_figure(f"no estimate, {name}", asked, silent, NO_ESTIMATE_TARGETS.get(level), is_share=True))
    eventless = [record for record in records if record.without_event]
    figures.append(
        _figure(
            "abstention where there is no event", eventless, silent, ABSTENTION_TARGET, is_share=True, at_least=True
        )
    )
    figures.append(_coverage("lag", answered, lambda record: _holds(record.answer.lag_interval, record.truth.lag)))
    figures.append(
        _coverage("arc", answered, lambda record: _holds(record.answer.extent_interval, record.truth.extent))
    )
    return figures


def _holds(interval: Bounds, true: float) -> float:
    """1 if an interval holds the true number, else 0; NaN if the estimator gave none."""
    low, high = interval
    return math.nan if math.isnan(low) or math.isnan(high) else float(low <= true <= high)


def _figure(
    name: str,
    records: list[ScoredRecord],
    value: Callable[[ScoredRecord], float],
    target: float | None = None,
    *,
    is_share: bool = False,
    at_least: bool = False,
) -> Figure:
    values = [value(record) for record in records]
    mean, count = mean_with_interval(values, records, is_share=is_share), sum(map(math.isfinite, values))
    if target is None or not count:
        return Figure(name, mean, count)
    met = mean.value >= target if at_least else mean.value <= target
    return Figure(name, mean, count, f"{'≥' if at_least else '≤'} {target:g}", bool(met))


def _coverage(what: str, answered: list[ScoredRecord], inside: Callable[[ScoredRecord], float]) -> Figure:
    plain = _figure(f"90 % interval of the {what} holds the truth", answered, inside, is_share=True)
    low, high = COVERAGE_TARGET
    if plain.count == 0:
        return plain
    return replace(plain, target=f"{low:g} to {high:g}", met=low <= plain.mean.value <= high)
