"""How a mean pass looks round each candidate, whatever its partner: steps of energy, sway and sign of the waveform."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from labels.spall_size.mean_pass import MeanPass
from labels.spall_size.running_energy import RunningEnergy

Array = NDArray[np.float64]

REACHES = (1.5, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0)  # samples
PERIOD_REACHES = (0.03, 0.1, 0.25)  # periods
LOW_REACHES = (3.0, 12.0, 48.0)
SWAY_BLURS = (2.0, 6.0, 20.0)
WAVE = 3
SHAPES = (
    "core",
    *(f"{side}_{reach:g}" for side in ("before", "after") for reach in REACHES[1:]),
    *(f"{side}_{reach:g}_periods" for side in ("before", "after") for reach in PERIOD_REACHES[1:]),
    *(f"low_step_{reach:g}" for reach in LOW_REACHES),
    *(f"sway_{what}_{blur:g}" for blur in SWAY_BLURS for what in ("slope", "level")),
    "wave_sign",
)


def event_shapes(mean: MeanPass, places: Array, summed: RunningEnergy) -> Array:
    """One row a candidate (C, len(SHAPES)).

    Core level over the largest of the pass; levels in windows further and further off over that of the core; steps of
    the low band; slope and level of the sway; the signed extreme of the prewhitened waveform over its energy.
    """
    largest = float(np.log(mean.energy[0].max() + 1e-9))
    core = summed.level(places - REACHES[0], places + REACHES[0])[0]
    columns = [core - largest]
    for reaches in (REACHES, tuple(share * mean.period for share in PERIOD_REACHES)):
        for side in (-1.0, 1.0):
            columns += [_beside(summed, places, side, near, far)[0] - core for near, far in pairwise(reaches)]
    for reach in LOW_REACHES:
        columns.append((_beside(summed, places, 1.0, 1.0, reach) - _beside(summed, places, -1.0, 1.0, reach))[1])
    columns += _sway_columns(mean, places)
    return np.column_stack([*columns, _wave_sign(mean, places)])


def _beside(summed: RunningEnergy, places: Array, side: float, near: float, far: float) -> Array:
    first, last = (places - far, places - near) if side < 0.0 else (places + near, places + far)
    return summed.level(first, last)


def _sway_columns(mean: MeanPass, places: Array) -> list[Array]:
    columns = []
    for blur in SWAY_BLURS:
        smooth = gaussian_filter1d(mean.sway, blur)
        for curve, scale in ((np.gradient(smooth), blur + 4.0), (smooth, 1.0)):
            columns.append(scale * np.interp(places, mean.offset, curve))
    return columns


def _wave_sign(mean: MeanPass, places: Array) -> Array:
    centre = np.round(places).astype(np.int64) - mean.offset[0]
    near = np.clip(centre[:, None] + np.arange(-WAVE, WAVE + 1), 0, mean.waveform.size - 1)
    wave, energy = mean.waveform[near], mean.energy[0][near].mean(axis=1)
    extreme = np.take_along_axis(wave, np.abs(wave).argmax(axis=1)[:, None], axis=1)[:, 0]
    return np.asarray(extreme / np.sqrt(energy + 1e-9))
