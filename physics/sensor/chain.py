"""The measurement chain: resonator and paths to the sensor, mounting, recorder."""

from __future__ import annotations

from dataclasses import dataclass

from physics.arrays import Array
from physics.checks import require_not_negative, settle_tuples
from physics.response.resampling import decimate
from physics.sensor.mode import SensorMode, mode_accelerations
from physics.sensor.mounting import Mounting, mounted
from physics.sensor.recorder import Recorder
from physics.trace import Trace


@dataclass(frozen=True)
class SensorChain:
    """`resonator_gain` times the resonator plus `modes`, through `mounting`, into `recorder` (None: without).

    The default is the paper's: the resonator's acceleration alone. InvalidParameter if the gain is below 0.
    """

    modes: tuple[SensorMode, ...] = ()
    resonator_gain: float = 1.0
    mounting: Mounting | None = None
    recorder: Recorder | None = None

    def __post_init__(self) -> None:
        settle_tuples(self, "modes")
        require_not_negative("resonator_gain", self.resonator_gain)

    @property
    def needs_outer_ring(self) -> bool:
        """True if the trace must keep the outer ring's motion."""
        return bool(self.modes)

    @property
    def fastest(self) -> float:
        """Frequency of the fastest mode, Hz; 0 without modes."""
        return max((mode.frequency for mode in self.modes), default=0.0)

    def check_rate(self, rate: float) -> None:
        """Raise InvalidParameter unless resonances and cutoff lie below half the sampling `rate` (Hz)."""
        for mode in self.modes:
            mode.check_rate(rate)
        if self.mounting is not None:
            self.mounting.check_rate(rate)


def sensed(chain: SensorChain, trace: Trace) -> Array:
    """What the sensor gives (T, 2), m/s², before background and recorder.

    Modes are solved at the rate of the outer ring's motion and then lowered to the trace's. ValueError if the chain has
    modes and the trace kept no motion of the outer ring (`Kept(outer=True)`); InvalidParameter if a resonance or the
    cutoff does not lie below half the trace's rate.
    """
    chain.check_rate(trace.rate)
    signal = trace.acceleration if chain.resonator_gain == 1.0 else chain.resonator_gain * trace.acceleration
    if chain.modes:
        signal = signal + _of_outer_ring(chain.modes, trace)
    return signal if chain.mounting is None else mounted(chain.mounting, signal, trace.rate)


def _of_outer_ring(modes: tuple[SensorMode, ...], trace: Trace) -> Array:
    if trace.outer is None:
        raise ValueError("sensor modes need a trace that kept the outer ring's motion: keep=Kept(outer=True)")
    raised = mode_accelerations(modes, trace.outer)
    return decimate(raised, round(trace.outer.rate / trace.rate))[: trace.time.size]
