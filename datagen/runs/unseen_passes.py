"""Records with a spall that can be made but hardly show its ball passes, and how many of a recipe's are so."""

from __future__ import annotations

from datagen.runs.redraws import OFTEN
from datagen.scenarios.scenario import Scenario
from physics.angular_speed import in_hertz


class UnseenPasses:
    """Counts the scenarios whose records are shorter than the time between two passes of their spall, or whose envelope
    cannot show them: its frequencies are differences of two within its band."""

    def __init__(self) -> None:
        self._records = self._short = self._narrow = 0

    def add(self, scenario: Scenario) -> None:
        """Count one more scenario."""
        self._records += 1
        scene = scenario.scene
        if scene.spalls:
            pass_frequency = in_hertz(scene.rig.bearing.balls * min(map(scene.crossing_speed, scene.spalls)))
            low, high = scenario.envelope_band
            self._short += scenario.duration * pass_frequency < 1.0
            self._narrow += pass_frequency > high - low

    def sentences(self) -> list[str]:
        """What a tenth of the records or more lack and which setting mends it, one sentence for each lack."""
        lacks = (
            (self._short, "are shorter than the time between two ball passes of their spall: raise signal.duration_s"),
            (
                self._narrow,
                "have an envelope band narrower than the ball pass frequency of their spall, which their envelope thus "
                "does not show: state a wider signal.envelope_band_hz",
            ),
        )
        return [
            f"{count} of {self._records} records {lack}"
            for count, lack in lacks
            if count and count >= OFTEN * self._records
        ]
