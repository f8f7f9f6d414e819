"""Sampling rates that are too low for what rings in a rig, and how many records cannot be made because of that."""

from __future__ import annotations

import math

from datagen.scenarios.scenario import Scenario
from physics.integrators.propagator import fast_periods
from physics.motion import motion_model
from physics.outcome import SimulationFailed
from physics.response.oversampling import MOST_OVERSAMPLING, SAMPLES_WHERE_RAISED, oversampling


def against_rate(scenario: Scenario) -> str:
    """Why the scenario cannot be simulated at its rate, empty if it can."""
    try:
        oversampling(scenario.scene, scenario.rate, scenario.chain.fastest)
    except SimulationFailed as problem:
        return str(problem)
    return ""


def lowest_rate(scenario: Scenario) -> float:
    """The sampling rate (Hz) below which the fastest mode of the scenario's rig cannot be held."""
    fastest = fast_periods(motion_model(scenario.scene), 1.0)
    return fastest * SAMPLES_WHERE_RAISED / MOST_OVERSAMPLING


class TooLowRates:
    """Counts the scenarios whose rate is too low for them."""

    def __init__(self) -> None:
        self._records = self._impossible = 0
        self._needed = 0.0
        self._example = ""

    def add(self, scenario: Scenario) -> None:
        """Count one more scenario."""
        self._records += 1
        problem = against_rate(scenario)
        if problem:
            self._impossible += 1
            self._needed = max(self._needed, lowest_rate(scenario))
            self._example = self._example or problem

    def sentence(self) -> str:
        """How many records will not be made, and the rate that would do for all; empty if there are none."""
        if not self._impossible:
            return ""
        return (
            f"{self._impossible} of {self._records} records cannot be made at their sampling rate (for example: "
            f"{self._example}); signal.rate_hz of about {math.ceil(self._needed)} or more would do for all"
        )
