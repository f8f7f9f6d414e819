"""Rules of the literature for the size of a spall, to compare with: a lag from the envelope, and a multiple of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.signal import find_peaks, hilbert

from labels.dead_sensor import live_axis
from labels.spall_size.estimation.first_passes import first_passes
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import FEWEST_PASSES, LONGEST_EXTENT, SizeEstimate, SizeOutcome
from physics.arrays import Array
from physics.checks import require_positive

# Periods: longer lags are not looked for.
LONGEST_SHARE = 0.95
# Samples: shorter lags are not looked for.
SHORTEST_SAMPLES = 3
# Share of the highest peak's prominence from which on a peak counts.
MARKED = 0.5


def envelope_lag(signal: Array, rate: float, longest: float) -> float:
    """Lag (s) of the first marked peak of the autocorrelation of the squared envelope of a `signal` (T,) at `rate`
    (Hz); NaN if there is none below `longest` (s).

    A peak is marked if it reaches half the prominence of the highest.
    """
    envelope = np.abs(hilbert(signal - np.mean(signal))) ** 2
    envelope -= envelope.mean()
    spectrum = np.abs(np.fft.rfft(envelope, 2 * envelope.size)) ** 2
    correlation = np.fft.irfft(spectrum)[: int(longest * rate) + 1]
    peaks, found = find_peaks(correlation, prominence=0.0)
    kept = peaks >= SHORTEST_SAMPLES
    peaks, prominence = peaks[kept], found["prominences"][kept]
    if peaks.size == 0:
        return math.nan
    return float(peaks[prominence >= MARKED * prominence.max()][0] / rate)


@dataclass(frozen=True)
class EnvelopeLagRule:
    """Takes the spall for `share` times what a ball covers in the envelope's lag: 1 plain geometry, 2 the half-size
    rule, by which the events show half the spall."""

    share: float = 1.0

    def estimate(self, acceleration: Array, rate: float, situation: Situation) -> SizeEstimate:
        """Size of the spall in `acceleration` (T,) or (T, axes: y last), m/s², sampled at `rate` (Hz).

        If the `situation` does not name the race, it is taken for the outer one. InvalidParameter unless the rate is
        finite and above 0.
        """
        require_positive("rate", rate, "Hz")
        method, signal = f"envelope lag, {self.share:g} times", live_axis(acceleration)
        if signal is None:
            return SizeEstimate(SizeOutcome.NO_SIGNAL, method)
        race = situation.race or "outer"
        period, bearing = situation.pass_periods()[race], situation.bearing()
        if signal.size < FEWEST_PASSES * period * rate:
            return SizeEstimate(SizeOutcome.TOO_SHORT, method)
        lag = envelope_lag(first_passes(signal, rate, situation), rate, LONGEST_SHARE * period)
        if math.isnan(lag):
            return SizeEstimate(SizeOutcome.NO_EVENT_PAIR, method)
        arc = lag / period * bearing.spacing
        extent = min(self.share * arc, LONGEST_EXTENT)
        return SizeEstimate(
            SizeOutcome.ESTIMATED,
            method,
            race,
            lag=lag,
            lag_arc=arc,
            extent=extent,
            extent_mm=extent * bearing.raceway_radius(race) * 1e3,
            candidates=(extent,),
            pass_period=period,
        )
