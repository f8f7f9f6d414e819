"""What a preview shows of an imported recording: its signal, and the frequencies that its labels lead to expect."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import fft

from datagen.drawing.close_up import CloseUp
from labels.envelope import band_envelope, squared_envelope_spectrum
from labels.features.turning import Turning
from labels.kurtogram import most_impulsive_band
from labels.spectrum import amplitude_spectrum
from labels.variables import AXES
from physics.angular_speed import RPM_PER_HZ
from physics.arrays import Array

REVOLUTIONS_SHOWN = 3.0
SHOWN_WITHOUT_SPEED = 0.1
ORDERS = {"BPFO": "bpfo", "BPFI": "bpfi", "BSF": "bsf", "FTF": "ftf"}
SHOWN_LINES = {"outer": ("BPFO",), "inner": ("BPFI",), "ball": ("BSF",), "cage": ("FTF",)}


@dataclass(frozen=True)
class MeasuredPortrait:
    """One recording: its `acceleration` (T, axes) along `axes`, m/s², and `labels` keyed as in labels.schema.

    `shaft_angle` (T,), rad, is known where the speed changes.
    """

    corpus: str
    labels: Mapping[str, Any]
    rate: float
    axes: tuple[str, ...]
    acceleration: Array
    shaft_angle: Array | None = None

    @property
    def axis(self) -> str:
        """The axis that is drawn: y if it was recorded."""
        return AXES[1] if AXES[1] in self.axes else self.axes[0]

    @cached_property
    def main_axis(self) -> Array:
        """Acceleration along that axis (T,), m/s²."""
        return self.acceleration[:, self.axes.index(self.axis)]

    @cached_property
    def band(self) -> tuple[float, float]:
        """Band of the envelope that is drawn, Hz: the record's, or the most impulsive one if it has no y axis."""
        low, high = self.labels["envelope_band"]
        if math.isnan(low):
            return most_impulsive_band(self.main_axis, self.rate, self.main_axis.size)
        return float(low), float(high)

    @cached_property
    def envelope(self) -> Array:
        """Envelope in that band (T,), m/s²."""
        return band_envelope(self.main_axis, self.rate, self.band)

    def envelope_spectrum(self, top: float) -> tuple[Array, Array]:
        """Frequencies (F,) in Hz and amplitudes (F,), (m/s²)², of the squared envelope, up to `top` (Hz) at least.

        Where the speed changes, over the angle of the shaft: frequencies are orders times the mean speed.
        """
        if self.shaft_angle is None:
            return squared_envelope_spectrum(self.envelope, self.rate)
        square = self.envelope**2
        components = np.asarray(fft.rfft(square - square.mean()))
        count = min(int(top * self.duration) + 2, components.size)
        even = Turning(self.shaft_angle).evenly(components, square.size, count)
        frequency, amplitude = amplitude_spectrum(even, even.size / self.duration)
        return frequency[:count], amplitude[:count]

    @cached_property
    def time(self) -> Array:
        """Instants of the samples (T,), s."""
        return np.arange(self.main_axis.size) / self.rate

    @property
    def duration(self) -> float:
        """Length of the record, s."""
        return float(self.main_axis.size / self.rate)

    @cached_property
    def frequencies(self) -> dict[str, float]:
        """Those of BPFO, BPFI, BSF, FTF and shaft frequency (Hz, without slip) that are known."""
        shaft = self.labels["speed_rpm"] / RPM_PER_HZ
        if self.shaft_angle is not None:
            shaft = Turning(self.shaft_angle).revolutions / self.duration
        orders = {name: self.labels[label] for name, label in ORDERS.items()} | {"shaft": 1.0}
        return {name: order * shaft for name, order in orders.items() if order * shaft > 0.0}

    @property
    def expected_lines(self) -> tuple[str, ...]:
        """Names of the defect frequencies worth a look: the stated one, both races' if none is stated."""
        names = SHOWN_LINES.get(str(self.labels["location"]), ("BPFO", "BPFI"))
        return tuple(name for name in names if name in self.frequencies)

    @cached_property
    def window(self) -> CloseUp:
        """Start and end (s) of the close-up: a few revolutions about the largest amplitude."""
        shaft = self.frequencies.get("shaft")
        width = min(REVOLUTIONS_SHOWN / shaft if shaft else SHOWN_WITHOUT_SPEED, self.duration)
        peak = float(np.argmax(np.abs(self.main_axis - self.main_axis.mean()))) / self.rate
        start = min(max(peak - width / 2.0, 0.0), self.duration - width)
        return CloseUp(start, start + width)
