"""Which records can be judged at all, by their labels and their length, before a waveform is looked at."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from datagen.judging.known import what_is_missing
from labels.band_tree import usable_bandwidth
from labels.features.conditioning import FEWEST_SAMPLES_USED
from labels.features.envelopes import HIGHEST_SHARE
from labels.features.kinematics import Kinematics
from labels.features.signal_features import FEWEST_TURNS

TOO_SHORT = "too short"
TOO_FAST = "ball passes too fast for the rate"
# s; the shortest that is learned from lasts 0.3 s. In 0.1 s a third of the faults of CWRU is found, in 0.05 s a sixth,
# and a healthy recording of MFPT alarms.
SHORTEST = 0.1


def unfit(labels: Mapping[str, Any], kinematics: Kinematics | None, samples: int, rate: float, bandwidth: float) -> str:
    """Why a record of so many `samples` at `rate` (Hz), of which features see `bandwidth` (Hz), cannot be judged.

    Empty if it can.
    """
    if kinematics is None:
        return what_is_missing(labels)
    duration = samples / rate
    if samples < FEWEST_SAMPLES_USED or duration < SHORTEST or duration * kinematics.shaft_hz < FEWEST_TURNS:
        return TOO_SHORT
    highest = HIGHEST_SHARE * usable_bandwidth(rate, bandwidth)
    return TOO_FAST if kinematics.bpfi * kinematics.shaft_hz > highest else ""
