"""The background of a virtual machine: what a sensor shows besides the bearing, in absolute units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physics.backgrounds.gear_mesh import GearMesh
from physics.backgrounds.impulses import Impulses
from physics.backgrounds.mains_hum import MainsHum
from physics.backgrounds.pink import PinkNoise
from physics.backgrounds.shaft_harmonics import ShaftHarmonics


@dataclass(frozen=True)
class Background:
    """Levels of the layers of a machine (None: absent); what is random in a record comes from the layer's own stream.

    `white_rms` (m/s²) is the standard deviation of white noise on each axis; `recording_gain` (m/s²) stands for one
    unit of the recording whose stretches the records take.
    """

    white_rms: float = 0.0
    pink: PinkNoise | None = None
    shaft_harmonics: ShaftHarmonics | None = None
    gear_mesh: GearMesh | None = None
    mains_hum: MainsHum | None = None
    impulses: Impulses | None = None
    recording_gain: float = 0.0

    @property
    def noisy(self) -> bool:
        """Whether it has broadband noise, and not tones alone."""
        return self.white_rms > 0.0 or self.pink is not None


@dataclass(frozen=True)
class Stretch:
    """What one record takes of a recording: `content` holds little-endian float32 (T, 2) in units of the file.

    `file` and `sha256` name the recording, `starts` its first sample for x and for y.
    """

    file: str
    sha256: str
    starts: tuple[int, int]
    content: bytes

    @property
    def samples(self) -> NDArray[np.float64]:
        """The stretch (T, 2) in units of the file."""
        return np.frombuffer(self.content, dtype="<f4").reshape(-1, 2).astype(np.float64)


@dataclass(frozen=True)
class NoiseTarget:
    """A signal-to-noise ratio (dB) of the y axis to which a record's whole background is scaled.

    `whole` says over which band: True, 0 to half the sampling rate; False, the record's snr_band.
    """

    ratio_db: float
    whole: bool
