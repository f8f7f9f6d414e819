"""The features of one signal, by name: the front door for who has an array and no corpus."""

from __future__ import annotations

from labels.band_tree import COMMON_BANDWIDTH, usable_bandwidth
from labels.dead_sensor import FEWEST_LEVELS, is_dead
from labels.features.analysis import analyse
from labels.features.conditioning import sound_signal
from labels.features.envelopes import HIGHEST_SHARE
from labels.features.kinematics import Kinematics
from labels.features.mending import mended
from labels.features.table import FEATURE_NAMES, feature_values
from labels.features.turning import Turning
from physics.arrays import Array

# Turns of the shaft: in a single one several balls pass even of a slow bearing, and it is judged well by them.
FEWEST_TURNS = 1.0


def signal_features(
    signal: Array,
    rate: float,
    kinematics: Kinematics,
    bandwidth: float = COMMON_BANDWIDTH,
    turning: Turning | None = None,
) -> dict[str, float]:
    """All features, in the order of FEATURES, of the acceleration `signal` (T,) of one axis sampled at `rate` (Hz).

    `kinematics` says how often balls pass and how fast the shaft turns (`bearing_kinematics`); `turning` how its speed
    changes, if it does, with an angle for each sample; its mean speed then takes the place of theirs. Features see what
    lies below `bandwidth` (Hz). In which unit the signal is does not matter.

    The values are those that `spallgen classify` judges a record no longer than 10.5 s by; it cuts longer ones into
    equal pieces. Of less than 0.1 s it judges nothing: the features of so little say little.

    ValueError for fewer than 64 samples, several axes, a rate that is no finite number above 0, samples that are not
    finite, fewer than four different values, a `turning` of another number of samples, less than one turn of the shaft,
    or balls that pass the inner race at more than 0.45 of the bandwidth.
    """
    signal = sound_signal(signal, rate)
    if turning is not None:
        kinematics = kinematics.at(turning.revolutions * rate / signal.size)
    turns = kinematics.shaft_hz * signal.size / rate
    if turns < FEWEST_TURNS:
        raise ValueError(f"the shaft makes {turns:.3g} turns in the signal; features need {FEWEST_TURNS:g} or more")
    highest = HIGHEST_SHARE * usable_bandwidth(rate, bandwidth)
    if kinematics.bpfi * kinematics.shaft_hz > highest:
        passes = kinematics.bpfi * kinematics.shaft_hz
        raise ValueError(f"balls pass the inner race at {passes:.4g} Hz; at {rate:g} Hz features see {highest:.4g} Hz")
    if is_dead(signal):
        raise ValueError(f"the signal has fewer than {FEWEST_LEVELS} different values: no sensor was connected")
    whole = mended(signal, turns).signal
    values = feature_values(analyse(whole, rate, kinematics, bandwidth, turning))
    return dict(zip(FEATURE_NAMES, values.tolist(), strict=True))
