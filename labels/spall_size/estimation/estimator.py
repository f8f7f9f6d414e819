"""The size of a spall from one record: events found, their lag corrected, the arc that goes with it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from labels.dead_sensor import live_axis
from labels.spall_size.columns.table import leading_rows
from labels.spall_size.estimation.calibration import Calibration, Judgement
from labels.spall_size.estimation.first_passes import first_passes
from labels.spall_size.estimation.gathering import hear
from labels.spall_size.estimation.measurement import Measurement, measure
from labels.spall_size.events.evidence import Evidence
from labels.spall_size.events.leading import leading_view
from labels.spall_size.signal.alignment import LEAST_WEIGHT
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import (
    FEWEST_PASSES,
    FEWEST_SAMPLES_A_PASS,
    LONGEST_EXTENT,
    SizeEstimate,
    SizeOutcome,
)
from physics.arrays import Array
from physics.checks import require_positive

# Samples from an event to the peak of its prewhitened energy.
ONSET = 1.8
BLIND, WITH_LOAD = "event pair, prior shortening", "event pair, shortening from load and Hertz factor"


@dataclass(frozen=True)
class SizeEstimator:
    """Estimates sizes with what `calibration` learned from simulated machines.

    The shipped one was fitted to records at 65 536 Hz alone, and much of what it looks at is counted in samples or in
    shares of the sampling rate. At 48 and 51.2 kHz it fares about as well, at 25.6 kHz and below clearly worse
    (docs/size.md); bringing such records to 65 536 Hz first does not help.
    """

    calibration: Calibration

    def estimate(self, acceleration: Array, rate: float, situation: Situation) -> SizeEstimate:
        """Size of the spall in `acceleration` (T,) or (T, axes: y last), m/s², sampled at `rate` (Hz).

        The last axis that has a signal is used, and of it the first MOST_PASSES. If its polarity is not known, the one
        of the larger trust.
        InvalidParameter unless the rate is finite and above 0.
        """
        require_positive("rate", rate, "Hz")
        signal, method = live_axis(acceleration), _method(situation)
        if signal is None:
            return SizeEstimate(SizeOutcome.NO_SIGNAL, method)
        shortest = min(situation.pass_periods().values()) * rate
        if signal.size < FEWEST_PASSES * shortest:
            return SizeEstimate(SizeOutcome.TOO_SHORT, method)
        if shortest < FEWEST_SAMPLES_A_PASS:
            return SizeEstimate(SizeOutcome.TOO_COARSE, method)
        part = np.asarray(first_passes(signal, rate, situation), dtype=np.float64)
        heard = hear(part, rate, situation.pass_periods())
        if heard is None:
            return SizeEstimate(SizeOutcome.NO_PASSES, method)
        found = map(heard.evidence, (1.0,) if situation.polarity_known else (1.0, -1.0))
        judged = [self.judge(evidence, situation) for evidence in found if evidence is not None]
        return max(judged, key=lambda size: size.trust) if judged else SizeEstimate(SizeOutcome.NO_PASSES, method)

    def judge(self, evidence: Evidence, situation: Situation) -> SizeEstimate:
        """Size of the spall that gave `evidence`."""
        score = self.calibration.pair_score.predict(evidence.pairs.features)
        judgement = self.calibration.with_load if situation.load_known else self.calibration.blind
        leading = leading_view(evidence, score, situation)
        rows = leading_rows(leading)
        measured = measure(leading, rows, judgement.rank.predict(rows))
        doubt = float(judgement.doubt.predict(measured.row[None])[0])
        trust = min(max(1.0 - doubt, 0.0), 1.0)
        if doubt > judgement.most:
            return SizeEstimate(SizeOutcome.NO_EVENT_PAIR, _method(situation), evidence.race, trust=trust)
        return _answer(evidence, measured, judgement, situation, trust)


def _method(situation: Situation) -> str:
    return WITH_LOAD if situation.load_known else BLIND


def _answer(
    evidence: Evidence, measured: Measurement, judgement: Judgement, situation: Situation, trust: float
) -> SizeEstimate:
    bearing = situation.bearing()
    lag_factor, lag_spread = judgement.lag.correction(measured.row)
    lag = min(measured.lag * lag_factor, evidence.mean.period) / evidence.rate
    arc_factor, arc_spread = judgement.arc.correction(measured.row)
    extent = min(measured.lag_arc * arc_factor, LONGEST_EXTENT)
    millimetres = bearing.raceway_radius(evidence.race) * 1e3
    more = math.floor((LONGEST_EXTENT - extent) / bearing.spacing)
    return SizeEstimate(
        outcome=SizeOutcome.ESTIMATED,
        method=_method(situation),
        race=evidence.race,
        lag=lag,
        lag_interval=(lag / lag_spread, lag * lag_spread),
        lag_arc=lag * evidence.rate / evidence.mean.period * bearing.spacing,
        extent=extent,
        extent_interval=(extent / arc_spread, extent * arc_spread),
        extent_mm=extent * millimetres,
        extent_mm_interval=(extent / arc_spread * millimetres, extent * arc_spread * millimetres),
        candidates=tuple(extent + turns * bearing.spacing for turns in range(more + 1)),
        pass_period=evidence.mean.period / evidence.rate,
        trust=trust,
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
