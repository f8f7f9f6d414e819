"""When the pulses of a tach rise, from the channel that holds them or from a list of their times."""

from __future__ import annotations

from datagen.recordings.pulses import rising_edges
from datagen.recordings.settings import Tach
from datagen.recordings.source import Source
from physics.arrays import Array

# Share by which a tach of a rate of its own may last longer or shorter than the vibration.
LASTS_WITHIN = 0.1


def pulse_times(source: Source, tach: Tach, rate: float, size: int) -> Array | None:
    """When the pulses (N,) rise, s; None if there are none and a nominal speed is known instead.

    Raises BadInput if they do not fit the vibration of `size` samples at `rate`, Hz.
    """
    dispensable = source.or_none("nominal_speed_rpm") is not None
    if dispensable and not source.variable(tach.variable, "tach.variable"):
        return None
    times = _listed(source, tach, size / rate) if tach.times else _risen(source, tach, rate, size)
    return times if times.size or not dispensable else None


def _listed(source: Source, tach: Tach, duration: float) -> Array:
    """The times that a variable lists of a vibration that lasts so long, s."""
    said = source.instants(tach.variable, "tach.variable") * tach.factor
    times = said - source.first_time()
    if said.size and not ((times >= 0.0) & (times <= duration)).any():
        raise source.refusal(
            f"its pulses are from {times[0]:.4g} to {times[-1]:.4g} s after the first sample, and the vibration lasts "
            f"{duration:.4g} s",
            "tach.variable",
            tach.variable,
            "times in s by the clock of the vibration; tach.factor brings others to s",
        )
    return times


def _risen(source: Source, tach: Tach, rate: float, size: int) -> Array:
    """The times at which a channel beside a vibration of `size` samples at `rate`, Hz, rises."""
    pulses = source.array(tach.variable, "tach.variable")
    if tach.rate_hz is None and pulses.size != size:
        raise source.refusal(
            f"holds {pulses.size} samples, the vibration {size}",
            "tach.variable",
            tach.variable,
            "equally many, or the sampling rate of the pulses in tach.rate_hz, or tach.times = true if these "
            "are the times of pulses",
        )
    if tach.rate_hz is not None:
        _require_as_long(source, tach.rate_hz, pulses.size, size / rate)
    return rising_edges(pulses, tach.threshold) / (tach.rate_hz or rate)


def _require_as_long(source: Source, rate: float, size: int, duration: float) -> None:
    """Raise BadInput if `size` samples of a tach at its own `rate` (Hz) do not last about as long as the vibration,
    `duration` (s): usually that rate is wrong, and the speed would be too."""
    lasts = size / rate
    if abs(lasts - duration) > LASTS_WITHIN * duration:
        raise source.refusal(
            f"its {size} samples then last {lasts:.4g} s, the vibration {duration:.4g} s",
            "tach.rate_hz",
            rate,
            f"a rate at which both last equally long, within {LASTS_WITHIN:.0%}",
        )
