"""What the calibration is fitted to: pairs of candidates of training records, each clean, with noise and cut short."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from datagen.scenarios.streams import stream
from datagen.sizing.in_blocks import in_blocks
from datagen.sizing.scored_record import CLEAN_DB, must_be_sized
from datagen.sizing.sized_records import SizedRecord, sized_records
from datagen.sizing.stored_record import nominal_period
from labels.noise import with_white_noise
from labels.spall_size.estimation.estimator import ONSET
from labels.spall_size.estimation.gathering import gather_evidence
from labels.spall_size.event_truth import EventTruth
from labels.spall_size.events.evidence import Evidence
from labels.spall_size.events.pairs import LONGEST_LAG
from labels.spall_size.situation import Situation
from physics.arrays import Array

LEVELS_DB = (20.0, 10.0, 5.0, 0.0)
SHORTEST_LEARNED_LAG = 1.5  # samples
LAG_SCALE = 0.12
LAG_RESOLVED, PLACE_RESOLVED = 0.5, 2.5  # samples; what is off by no more than that is not wrong
PLACE_TOLERANCE = 0.4  # of the lag, or of what is left of the period
SHORTEST_SHARE, LONGEST_SHARE = 0.1, 0.5
# Noise and excerpts are drawn alike for records of one number, whatever their corpus; no corpus uses this item for
# these purposes. Another seed asks for a new fit.
FIT_SEED, FIT_ITEM = 0, 1


@dataclass(frozen=True)
class Excerpt:
    """What a trial is made of: a `signal` (T,), m/s², of a record from its sample `start` on.

    `stored` if it is whole and its noise the corpus's own, `clean` if it is whole and without noise.
    """

    signal: Array
    start: int
    stored: bool
    clean: bool


@dataclass(frozen=True)
class Trial:
    """What was found in an excerpt of a record, and what is true; `stored` and `clean` as in Excerpt, `asked` if a
    size must be given of it.

    `true_lag` in samples (NaN: no events); `lag` the same modulo the period (NaN: no events or the wrong race), `arc`
    the spall's in rad (modulo the spacing), `quality` (P,) of each pair, 0 to 1.
    """

    record: int
    bearing_id: str
    stored: bool
    clean: bool
    asked: bool
    situation: Situation
    evidence: Evidence
    true_lag: float
    lag: float
    arc: float
    quality: Array

    def without_load(self) -> Trial:
        """The same as whoever knows neither load nor Hertz factor sees it."""
        return replace(self, situation=self.situation.without_load())


def trials(folder: Path, splits: tuple[str, ...], workers: int) -> list[Trial]:
    """Every trial of the records of `splits` in a corpus that stores clean signals."""
    from joblib import delayed

    records = sized_records(folder, splits)
    made = in_blocks((delayed(_of_record)(sized) for sized in records), workers)
    return [trial for several in made for trial in several]


def _of_record(sized: SizedRecord) -> list[Trial]:
    made = []
    for excerpt in _excerpts(sized):
        evidence = gather_evidence(excerpt.signal, sized.rate, sized.situation.pass_periods())
        if evidence is not None:
            made.append(trial(sized, _slim(evidence), excerpt))
    return made


def _excerpts(sized: SizedRecord) -> list[Excerpt]:
    """The y axis as stored; clean if it was stored with noise, else with noise of a level drawn from those of the size
    ladder; and of one of both, drawn, a part that holds a tenth to half of it."""
    stored = sized.acceleration[:, 1]
    clean = stored if sized.clean is None else sized.clean[:, 1]
    noisy = float(sized.labels["snr_db"]) < CLEAN_DB
    other = clean if noisy else in_noise_of_the_ladder(clean, sized.record)
    generator = stream(FIT_SEED, "record", sized.record, "signal", item=FIT_ITEM)
    share = SHORTEST_SHARE * (LONGEST_SHARE / SHORTEST_SHARE) ** generator.random()
    length = round(share * stored.size)
    start = int(generator.integers(stored.size - length + 1))
    part = (stored, other)[int(generator.integers(2))][start : start + length]
    return [Excerpt(stored, 0, True, not noisy), Excerpt(other, 0, False, noisy), Excerpt(part, start, False, False)]


def in_noise_of_the_ladder(clean: Array, record: int) -> Array:
    """The signal (T,) in white noise of a level drawn from LEVELS_DB; the `record` sets the random numbers."""
    generator = stream(FIT_SEED, "record", record, "white_noise", item=FIT_ITEM)
    return with_white_noise(clean, LEVELS_DB[int(generator.integers(len(LEVELS_DB)))], generator)


def _slim(evidence: Evidence) -> Evidence:
    """What the fit needs: no signals, and numbers in the single precision in which trees compare them."""
    nothing = np.zeros(0)
    pairs = replace(evidence.pairs, features=evidence.pairs.features.astype(np.float32))
    energy: Any = evidence.mean.energy.astype(np.float32)
    mean = replace(evidence.mean, energy=energy, waveform=nothing, sway=nothing, give=nothing)
    return replace(evidence, mean=mean, pairs=pairs)


def trial(sized: SizedRecord, evidence: Evidence, excerpt: Excerpt) -> Trial:
    """The `evidence` found in an `excerpt` of a record beside its truth."""
    lag, arc, quality = math.nan, math.nan, np.zeros(evidence.pairs.lag.size)
    truth = None if sized.truth is None else sized.truth.within(*_stretch(sized, excerpt))
    true_lag = truth.lag * sized.rate if truth is not None else math.nan
    if truth is not None and evidence.race == sized.labels["location"] and true_lag >= SHORTEST_LEARNED_LAG:
        turns = math.floor(true_lag / (LONGEST_LAG * evidence.mean.period))
        lag = max(true_lag - turns * evidence.mean.period, 1.0)
        arc = float(sized.labels["extent"]) - turns * sized.situation.bearing().spacing
        quality = _quality(evidence, truth, lag)
    bearing_id = str(sized.labels["bearing_id"])
    stored, clean, asked = excerpt.stored, excerpt.clean, _asked(sized, true_lag)
    return Trial(
        record=sized.record,
        bearing_id=bearing_id,
        stored=stored,
        clean=clean,
        asked=asked,
        situation=sized.situation,
        evidence=evidence,
        true_lag=true_lag,
        lag=lag,
        arc=arc,
        quality=quality,
    )


def _stretch(sized: SizedRecord, excerpt: Excerpt) -> tuple[float, float]:
    """Where the `excerpt` begins and ends in its record, s."""
    return excerpt.start / sized.rate, (excerpt.start + excerpt.signal.size) / sized.rate


def _asked(sized: SizedRecord, true_lag: float) -> bool:
    period = nominal_period(sized.labels) * sized.rate
    return must_be_sized(true_lag, 1.0, period, float(sized.labels["extent_spacing"]))


def _quality(evidence: Evidence, truth: EventTruth, lag: float) -> Array:
    """exp(−|log error of the lag| / 0.12), but 0 for pairs whose events lie elsewhere in the pass."""
    period, pairs = evidence.mean.period, evidence.pairs
    short = min(lag, period - lag)
    beyond = np.maximum(_apart(pairs.lag - lag, period) - LAG_RESOLVED, 0.0)
    error = np.minimum(np.abs(np.log(pairs.lag / lag)), beyond / short)
    away = [
        _apart(place - mean_place(evidence, times) - ONSET, period)
        for place, times in ((pairs.entry, truth.first), (pairs.exit, truth.last))
    ]
    near = np.maximum(np.maximum(*away) - PLACE_RESOLVED, 0.0) / short < PLACE_TOLERANCE
    return np.asarray(np.exp(-error / LAG_SCALE) * near)


def _apart(distance: Array, period: float) -> Array:
    return np.abs(_nearest(distance, period))


def _nearest(distance: Array, period: float) -> Array:
    """The distances (N,) less the whole periods in them, from half a period below 0 to half a period above."""
    return (distance + 0.5 * period) % period - 0.5 * period


def mean_place(evidence: Evidence, times: Array) -> float:
    """Where in the pass the events at `times` (K,), s, lie: samples from the anchor, modulo the period."""
    anchor, period = evidence.alignment.place, evidence.mean.period
    nearest = np.abs(anchor[None, :] - times[:, None] * evidence.rate).argmin(axis=1)
    distance, weight = times * evidence.rate - anchor[nearest], evidence.alignment.weight[nearest]
    turn = 2.0 * math.pi / period
    middle = float(np.angle((weight * np.exp(1j * turn * distance)).sum())) / turn
    unwrapped = _nearest(distance - middle, period)
    return middle + float(np.median(unwrapped[weight >= np.median(weight)]))
