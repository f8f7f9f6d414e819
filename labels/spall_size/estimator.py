"""The size of a spall from one record: events found, their lag corrected, the arc that goes with it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.alignment import LEAST_WEIGHT
from labels.spall_size.calibration import Calibration
from labels.spall_size.evidence import Evidence, gather_evidence
from labels.spall_size.measurement import Measurement, measure
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome

Array = NDArray[np.float64]

LOAD_AXIS = -1  # y, or the only axis of a recording
ONSET = 1.8  # samples from an event to the peak of its prewhitened energy
LONGEST_EXTENT = math.pi
BLIND, WITH_LOAD = "event pair, prior shortening", "event pair, shortening from load and Hertz factor"


@dataclass(frozen=True)
class SizeEstimator:
    """Estimates sizes with what `calibration` learned from simulated machines."""

    calibration: Calibration

    def estimate(self, acceleration: Array, rate: float, situation: Situation) -> SizeEstimate:
        """Size of the spall in `acceleration` (T,) or (T, axes: y last), m/s², sampled at `rate` (Hz)."""
        signal = acceleration if acceleration.ndim == 1 else acceleration[:, LOAD_AXIS]
        method = WITH_LOAD if situation.load_known else BLIND
        shortest = 6.0 * min(situation.pass_periods().values())
        if signal.size < shortest * rate:
            return SizeEstimate(SizeOutcome.TOO_SHORT, method)
        evidence = gather_evidence(np.asarray(signal, dtype=np.float64), rate, situation.pass_periods())
        if evidence is None:
            return SizeEstimate(SizeOutcome.NO_PASSES, method)
        score = self.calibration.pair_score.predict(evidence.pairs.features)
        measured = measure(evidence, score, situation)
        odds, least = self._trust(measured)
        if odds < least:
            return SizeEstimate(SizeOutcome.NO_EVENT_PAIR, method, evidence.race, trust=_probability(odds))
        return self._told(evidence, measured, situation, method, odds)

    def _trust(self, measured: Measurement) -> tuple[float, float]:
        learned = self.calibration
        if measured.load_row is None:
            return float(learned.trust.predict(measured.row[None])[0]), learned.least
        return float(learned.trust_with_load.predict(measured.load_row[None])[0]), learned.least_with_load

    def _told(
        self, evidence: Evidence, measured: Measurement, situation: Situation, method: str, odds: float
    ) -> SizeEstimate:
        learned, bearing = self.calibration, situation.bearing()
        factor, doubt = learned.lag.tell(measured.row)
        lag = min(measured.lag * factor, evidence.mean.period) / evidence.rate
        if measured.load_row is None:
            arc_factor, arc_doubt = learned.arc.tell(measured.row)
        else:
            arc_factor, arc_doubt = learned.arc_with_load.tell(measured.load_row)
        extent = min(measured.lag_arc * arc_factor, LONGEST_EXTENT)
        millimetres = bearing.raceway_radius(evidence.race) * 1e3
        more = math.floor((LONGEST_EXTENT - extent) / bearing.spacing)
        return SizeEstimate(
            outcome=SizeOutcome.ESTIMATED,
            method=method,
            race=evidence.race,
            lag=lag,
            lag_interval=(lag / doubt, lag * doubt),
            lag_arc=lag * evidence.rate / evidence.mean.period * bearing.spacing,
            extent=extent,
            extent_interval=(extent / arc_doubt, extent * arc_doubt),
            extent_mm=extent * millimetres,
            extent_mm_interval=(extent / arc_doubt * millimetres, extent * arc_doubt * millimetres),
            candidates=tuple(extent + turns * bearing.spacing for turns in range(more + 1)),
            pass_period=evidence.mean.period / evidence.rate,
            trust=_probability(odds),
            event_times=_event_times(evidence, measured, lag),
        )


def _event_times(evidence: Evidence, measured: Measurement, lag: float) -> Array:
    """Both events of every pass that is heard (K, 2), s; the one that is the anchor stays where it was found."""
    heard = evidence.alignment.place[evidence.alignment.weight >= LEAST_WEIGHT]
    if abs(measured.entry) <= abs(measured.exit):
        first = (heard + measured.entry - ONSET) / evidence.rate
        return np.column_stack([first, first + lag])
    last = (heard + measured.exit - ONSET) / evidence.rate
    return np.column_stack([last - lag, last])


def _probability(log_odds: float) -> float:
    return 1.0 / (1.0 + math.exp(-max(min(log_odds, 50.0), -50.0)))
