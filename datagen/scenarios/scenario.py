"""A scenario: one record with every number fixed. It alone is enough to make the record again, with any others or
none, on any machine."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from datagen.scenarios.accuracy import Accuracy
from datagen.scenarios.background import Background, NoiseTarget, Stretch
from datagen.scenarios.refused import Redraw
from datagen.scenarios.streams import stream
from labels.description import condition
from physics.scene import Scene
from physics.sensor.chain import SensorChain

NO_BACKGROUND = Background()
PLAIN_CHAIN = SensorChain()
USUAL_ACCURACY = Accuracy()


@dataclass(frozen=True)
class Seeds:
    """What opens every random stream of a record (see `streams`): the recipe's seed, indices and attempts."""

    recipe: int
    record: int
    record_attempt: int
    machine: int
    machine_attempt: int


@dataclass(frozen=True)
class Scenario:
    """A physical scene with how it is recorded and where it belongs.

    The record is sampled at `rate` (Hz) and begins when the machine has run for `settle` (s) from rest. `envelope_band`
    (Hz) holds the lower and the upper edge; `slip_deviation` and `slip_correlation_time` (s) are the statistics that
    the slip was drawn from. `stretch` is what the record takes from a recording, `noise_target` what its background is
    scaled to, and `snr_band` (Hz) the band of its second signal-to-noise ratio (None: the envelope's). `redraws` are
    the impossible draws before it, `accuracy` the error that its simulation may have.
    """

    scene: Scene
    rate: float
    seeds: Seeds
    part: str
    bearing_id: str
    split: str
    envelope_band: tuple[float, float]
    settle: float = 0.0
    slip_deviation: float = 0.0
    slip_correlation_time: float = 0.0
    chain: SensorChain = PLAIN_CHAIN
    background: Background = NO_BACKGROUND
    stretch: Stretch | None = None
    noise_target: NoiseTarget | None = None
    snr_band: tuple[float, float] | None = None
    redraws: tuple[Redraw, ...] = ()
    accuracy: Accuracy = USUAL_ACCURACY

    @property
    def record(self) -> int:
        """Index of the record in the corpus, from 0."""
        return self.seeds.record

    @property
    def duration(self) -> float:
        """Length of the record, s."""
        return self.scene.duration

    @property
    def samples(self) -> int:
        """Number of samples."""
        return round(self.rate * self.duration)

    @property
    def simulated_samples(self) -> int:
        """Number of samples with those before the record begins."""
        return self.samples + round(self.rate * self.settle)

    @property
    def noise_band(self) -> tuple[float, float]:
        """Band of the second signal-to-noise ratio, Hz."""
        return self.snr_band or self.envelope_band

    @property
    def rig(self) -> str:
        """Name of the rig."""
        return self.scene.rig.name

    @property
    def bearing(self) -> str:
        """Designation of the bearing."""
        return self.scene.rig.bearing.name

    @property
    def condition(self) -> str:
        """healthy, line or extended."""
        return condition(self.scene)

    @property
    def location(self) -> str:
        """The defective race: none, outer or inner."""
        return self.scene.defective_race

    def generator(self, purpose: str) -> np.random.Generator:
        """The stream of one purpose of this record, such as "white_noise"."""
        seeds = self.seeds
        return stream(seeds.recipe, "record", seeds.record, purpose, seeds.record_attempt)
