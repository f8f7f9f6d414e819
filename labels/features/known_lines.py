"""Which components of a spectrum lie on lines that say nothing of a defect: those of the shaft and of the mains."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.features.families import HARMONICS
from labels.features.kinematics import SLIP_SPREAD, Kinematics
from physics.arrays import Array
from physics.bearing import RACES

MAINS = (50.0, 60.0)
# Share by which mains (0.4 % in an interconnected grid, EN 50160) and a stated rate may be off together, and the most
# (Hz) that is allowed for it: high multiples are weak, and their margins would cover the axis.
MAINS_SPREAD, MAINS_REACH = 0.006, 0.8
# The share that is allowed for at every multiple.
STEADY_MAINS = 0.001
COARSEST_STEP = 1.3
# Components so near (in orders) to a multiple of the shaft speed are not counted for a defect family.
SHAFT_MARGIN = 0.025
# The most orders around each multiple in which components are left out: more would take a large part of the axis.
WIDEST_MARGIN = 0.12


def without_shaft(excess: Array, step: float, shaft_hz: float) -> Array:
    """The spectra (B, F) over their floor, components `step` (Hz) apart, with those near multiples of the shaft speed
    set to the floor, 1."""
    return np.where(shaft_components(excess.shape[-1], step, shaft_hz), 1.0, excess)


def shaft_components(count: int, step: float, shaft_hz: float) -> NDArray[np.bool_]:
    """Which (F,) of `count` components, `step` (Hz) apart from 0, count as the shaft's.

    None in a record of so few turns that the margin would cover a large part of the axis.
    """
    margin = multiple_margin(step, shaft_hz)
    if margin > WIDEST_MARGIN * shaft_hz:
        return np.zeros(count, dtype=bool)
    return near_multiples(count, step, shaft_hz, margin)


def multiple_margin(step: float, shaft_hz: float) -> float:
    """How near (Hz) to a multiple of a rotating part's rate a component of the envelope counts as one."""
    return max(SHAFT_MARGIN * shaft_hz, 1.01 * step)


def near_multiples(count: int, step: float, rate: float, margin: float) -> NDArray[np.bool_]:
    """Which (F,) of `count` components, `step` (Hz) apart from 0, lie within `margin` (Hz) of a multiple of `rate`
    (Hz)."""
    order = np.arange(count) * step / rate
    return np.asarray((np.abs(order - np.round(order)) * rate <= margin) & (order > 0.5))


def mains_components(count: int, step: float) -> NDArray[np.bool_]:
    """Which (F,) of `count` components, `step` (Hz) apart from 0, count as mains of 50 or 60 Hz: none if too far apart.

    Motors and their supplies modulate at twice the mains frequency, often near a ball-pass frequency.
    """
    if step > COARSEST_STEP:
        return np.zeros(count, dtype=bool)
    return _taken_for_mains(np.arange(count) * step, step)


def races_in_mains(kinematics: Kinematics, step: float) -> tuple[str, ...]:
    """The races whose ball pass frequency, as far as slip moves it, may count as mains in a spectrum of components
    `step` (Hz) apart: with all its harmonics it is left out then, and a fault of that race is hardly seen."""
    if step > COARSEST_STEP:
        return ()
    orders = np.array([kinematics.pass_order(race) for race in RACES], dtype=np.float64)
    hidden = _taken_for_mains(orders * kinematics.shaft_hz, step, SLIP_SPREAD)
    return tuple(race for race, is_hidden in zip(RACES, hidden, strict=True) if is_hidden)


def races_in_shaft(kinematics: Kinematics, step: float) -> tuple[str, ...]:
    """The races whose ball pass line and harmonics all count as the shaft's in a spectrum of components `step`
    (Hz) apart: a fault of that race is hardly seen unless the cage slips, which moves them."""
    margin = multiple_margin(step, kinematics.shaft_hz) / kinematics.shaft_hz
    if margin > WIDEST_MARGIN:
        return ()
    family = np.arange(1.0, HARMONICS + 1.0)
    orders = {race: kinematics.pass_order(race) * family for race in RACES}
    return tuple(race for race, order in orders.items() if (np.abs(order - np.round(order)) <= margin).all())


def _taken_for_mains(frequency: NDArray[Any], step: float, spread: float = 0.0) -> NDArray[np.bool_]:
    """Which frequencies (F,), Hz, known to a share `spread`, count as mains in a spectrum of components `step` (Hz)
    apart."""
    margin = np.maximum(np.minimum(MAINS_SPREAD * frequency, MAINS_REACH), STEADY_MAINS * frequency)
    return near_mains(frequency, 1.01 * step + margin + spread * frequency)


def near_mains(frequency: NDArray[Any], margin: NDArray[Any]) -> NDArray[np.bool_]:
    """True where a frequency (F,) lies within its `margin` (F,), both in Hz, of a multiple of 50 or 60 Hz."""
    near = np.zeros(frequency.size, dtype=bool)
    for mains in MAINS:
        near |= np.abs(frequency - mains * np.maximum(np.round(frequency / mains), 1.0)) <= margin
    return near
