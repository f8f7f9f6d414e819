"""Power over time and frequency in decibels, and the natural frequencies of a rig across it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from datagen.drawing.style import INK, MAP
from physics.arrays import Array
from physics.modes import Modes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NUMBER_HEIGHT = 0.08  # of the panel's height


def draw_decibels(axes: Axes, time: Array, frequency: Array, power: Array, *, span: float, top: float = np.inf) -> None:
    """The `power` (F, T) at times (T,), s, and frequencies (F,), Hz, over the `span` (dB) below its maximum: kHz by ms.

    Frequencies above `top` (Hz) are not drawn, but their power counts to the maximum.
    """
    keep = frequency <= top
    level = 10.0 * np.log10(np.maximum(power, 1e-300) / max(power.max(), 1e-300))
    axes.pcolormesh(
        time * 1e3, frequency[keep] * 1e-3, level[keep], vmin=-span, vmax=0.0, cmap=MAP, shading="nearest",
        rasterized=True,
    )  # fmt: skip


def mark_frequencies(axes: Axes, frequencies: Iterable[float]) -> None:
    """Dashed white lines at the frequencies (Hz) across a panel in kHz, their numbers behind its right end, one above
    the other where they are close. The panel's limits must be set."""
    low, high = axes.get_ylim()
    free = low
    for line in sorted(frequencies):
        axes.axhline(line * 1e-3, color="white", linewidth=0.8, linestyle=(0, (4, 3)), alpha=0.85)
        place = max(line * 1e-3, free)
        axes.annotate(
            f"{line * 1e-3:.2f}", (1.0, place), xycoords=("axes fraction", "data"), xytext=(3, 0),
            textcoords="offset points", va="center", fontsize=7, color=INK,
        )  # fmt: skip
        free = place + NUMBER_HEIGHT * (high - low)


def frequencies_along_y(found: Modes) -> Array:
    """Natural frequencies (N,) of the modes that move more along y than along x, Hz, rising."""
    moves = np.abs(found.shape) ** 2
    return np.asarray(found.frequency_hz[moves[1::2].sum(axis=0) > moves[0::2].sum(axis=0)])
