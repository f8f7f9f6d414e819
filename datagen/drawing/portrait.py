"""Everything a preview shows of one record, wherever it came from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from datagen.drawing.close_up import CloseUp
from labels.description import largest_spall
from labels.truth import PassTable
from physics.angular_speed import in_hertz
from physics.arrays import Array
from physics.hertz import is_roller
from physics.scene import Scene
from physics.spall import Spall

PASSES_SHOWN = 3.0


@dataclass(frozen=True)
class Portrait:
    """One record: `acceleration` (T, 2) as recorded, `envelope` (T,), both m/s².

    Where they are known, m/s²: `clean` (T, 2) of the resonator; `sensor` (T, 2), after sensor paths and mounting; and
    `background` (T, 2), the sum of its layers.
    `stiffness` (3, S): kxx, kyy, kxy in N/m at `stiffness_time` (S,), s. `labels` are keyed as in labels.schema.
    """

    corpus: str
    scene: Scene
    labels: Mapping[str, Any]
    rate: float
    acceleration: Array
    clean: Array | None
    envelope: Array
    stiffness_time: Array
    stiffness: Array
    passes: PassTable
    sensor: Array | None = None
    background: Array | None = None

    @property
    def undisturbed(self) -> Array | None:
        """What the sensor gives without background (T, 2), m/s², as far as it is known."""
        return self.clean if self.sensor is None else self.sensor

    @property
    def recorded_words(self) -> str:
        """What the recorded acceleration is called beside the clean one."""
        bare = self.background is not None and not self.background.any()
        return "as recorded" if bare else "with background"

    @property
    def has_parts(self) -> bool:
        """True if the record has a background and is known with and without it."""
        return self.sensor is not None and self.background is not None and bool(self.background.any())

    @cached_property
    def time(self) -> Array:
        """Instants of the samples (T,), s."""
        return np.arange(self.acceleration.shape[0]) / self.rate

    @property
    def duration(self) -> float:
        """Length of the record, s."""
        return float(self.acceleration.shape[0] / self.rate)

    @cached_property
    def frequencies(self) -> dict[str, float]:
        """BPFO, BPFI, FTF and shaft frequency (Hz) at the cage's mean speed in this record."""
        cage, shaft = self.scene.cage.mean_speed, self.scene.operation.shaft_speed
        balls = self.scene.rig.bearing.balls
        angular = {"BPFO": balls * cage, "BPFI": balls * (shaft - cage), "FTF": cage, "shaft": shaft}
        return {name: in_hertz(value) for name, value in angular.items()}

    @property
    def defect_frequency(self) -> str:
        """Name of the frequency at which the record's defect shows; BPFO if it is healthy."""
        return "BPFI" if self.scene.defective_race == "inner" else "BPFO"

    @property
    def element(self) -> str:
        """What a rolling element of the bearing is called."""
        return "roller" if is_roller(self.scene.rig.bearing) else "ball"

    def element_of(self, number: int) -> str:
        """Name of the rolling element of the pass of this number, and of its row where there are two."""
        row = f" of row {self.passes.row[number]}" if self.scene.rig.bearing.rows > 1 else ""
        return f"{self.element} {self.passes.ball[number]}{row}"

    @cached_property
    def shown_pass(self) -> int | None:
        """The pass in the middle of the close-up: the complete, loaded one with the strongest signal, or None."""
        signal = np.abs((self.acceleration if self.clean is None else self.clean)[:, 1])
        table = self.passes
        settled = table.complete & (table.entry_time > 0.15 * self.duration)
        fit = np.flatnonzero(settled & table.loaded) if np.any(settled & table.loaded) else np.flatnonzero(settled)
        if fit.size == 0:
            return None
        peaks = [_peak(signal, self.rate, table.entry_time[k], table.exit_time[k]) for k in fit]
        return int(fit[int(np.argmax(peaks))])

    @cached_property
    def shown_spall(self) -> Spall | None:
        """The spall of the shown pass, the largest if no pass is shown, or None."""
        if self.shown_pass is None:
            return largest_spall(self.scene)
        return self.scene.spalls[int(self.passes.defect[self.shown_pass])]

    @cached_property
    def window(self) -> CloseUp:
        """Start and end (s) of the close-up: a few ball passes."""
        width = PASSES_SHOWN / self.frequencies[self.defect_frequency]
        centre = self.duration / 2.0
        if self.shown_pass is not None:
            centre = (self.passes.entry_time[self.shown_pass] + self.passes.exit_time[self.shown_pass]) / 2.0
        start = min(max(centre - width / 2.0, 0.0), max(self.duration - width, 0.0))
        return CloseUp(start, min(start + width, self.duration))


def _peak(signal: Array, rate: float, start: float, stop: float) -> float:
    part = signal[int(start * rate) : int(stop * rate) + 2]
    return float(part.max()) if part.size else 0.0
