"""Columns of how a mean pass looks round each event, whatever its partner: steps of energy, sway, sign of the wave."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.ndimage import gaussian_filter1d

from labels.spall_size.events.pairs import EVENTS, PairView
from labels.spall_size.signal.mean_pass import Channel, MeanPass
from labels.spall_size.signal.running_energy import ENERGY_FLOOR, RunningEnergy
from physics.arrays import Array

# Samples from a candidate at which windows end; the first is half the width of its core.
REACHES = (1.5, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0)
# Periods from a candidate at which wider windows end.
PERIOD_REACHES = (0.03, 0.1, 0.25)
# Samples from a candidate to which the windows reach whose levels make the steps of the low band.
LOW_REACHES = (3.0, 12.0, 48.0)
# Samples from a candidate at which these windows begin.
LOW_NEAREST = 1.0
# Standard deviations of the blur under which the sway is read, samples.
SWAY_BLURS = (2.0, 6.0, 20.0)
# Samples that, added to the blur, make the length over which a slope of the sway is counted.
SLOPE_REACH = 4.0
# Samples on either side of a candidate among which the extreme of the waveform is looked for.
WAVE = 3
SHAPES = (
    "core",
    *(f"{side}_{reach:g}" for side in ("before", "after") for reach in REACHES[1:]),
    *(f"{side}_{reach:g}_periods" for side in ("before", "after") for reach in PERIOD_REACHES[1:]),
    *(f"low_step_{reach:g}" for reach in LOW_REACHES),
    *(f"sway_{what}_{blur:g}" for blur in SWAY_BLURS for what in ("slope", "level")),
    "wave_sign",
)
NAMES = tuple(f"{event}_{shape}" for event in EVENTS for shape in SHAPES)


def measure(view: PairView) -> dict[str, Array]:
    """Columns (P,) by NAMES: the shapes of the candidates that are either event of a pair."""
    shapes = event_shapes(view.mean, view.places, view.summed)
    return {
        f"{event}_{shape}": column[candidate]
        for event, candidate in zip(EVENTS, (view.first, view.last), strict=True)
        for shape, column in shapes.items()
    }


def event_shapes(mean: MeanPass, places: Array, summed: RunningEnergy) -> dict[str, Array]:
    """Columns (C,) by SHAPES, of the candidates at `places` (C,).

    Core level over the largest of the pass; levels in windows further and further off over that of the core; steps of
    the low band, all logarithms; slope and level of the sway, standard deviations; the signed extreme of the
    prewhitened waveform over its RMS.
    """
    largest = float(np.log(mean.energy[Channel.ALL].max() + ENERGY_FLOOR))
    core = summed.level(places - REACHES[0], places + REACHES[0])[Channel.ALL]
    found = {"core": core - largest}
    for reaches, unit, words in ((REACHES, 1.0, ""), (PERIOD_REACHES, mean.period, "_periods")):
        for near, far in pairwise(reaches):
            before, after = _beside(summed, places, near * unit, far * unit)
            found |= {
                f"before_{far:g}{words}": before[Channel.ALL] - core,
                f"after_{far:g}{words}": after[Channel.ALL] - core,
            }
    for reach in LOW_REACHES:
        before, after = _beside(summed, places, LOW_NEAREST, reach)
        found[f"low_step_{reach:g}"] = after[Channel.LOW] - before[Channel.LOW]
    return found | _sways(mean, places) | {"wave_sign": _wave_sign(mean, places)}


def _beside(summed: RunningEnergy, places: Array, near: float, far: float) -> tuple[Array, Array]:
    """Log energies (4, C) between `near` and `far` samples before the places, and behind them."""
    return summed.level(places - far, places - near), summed.level(places + near, places + far)


def _sways(mean: MeanPass, places: Array) -> dict[str, Array]:
    found: dict[str, Array] = {}
    for blur in SWAY_BLURS:
        smooth = gaussian_filter1d(mean.sway, blur)
        found |= {
            f"sway_slope_{blur:g}": (blur + SLOPE_REACH) * np.interp(places, mean.offset, np.gradient(smooth)),
            f"sway_level_{blur:g}": np.interp(places, mean.offset, smooth),
        }
    return found


def _wave_sign(mean: MeanPass, places: Array) -> Array:
    near = mean.around(places, WAVE)
    wave, energy = mean.waveform[near], mean.energy[Channel.ALL][near].mean(axis=1)
    extreme = np.take_along_axis(wave, np.abs(wave).argmax(axis=1)[:, None], axis=1)[:, 0]
    return np.asarray(extreme / np.sqrt(energy + ENERGY_FLOOR))
