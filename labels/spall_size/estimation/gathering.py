"""From a record to its evidence: prewhitened, its passes on either race tracked and lined up, their events paired."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from labels.spall_size.columns.table import pair_rows
from labels.spall_size.events.candidates import candidate_places
from labels.spall_size.events.evidence import Evidence
from labels.spall_size.events.pairs import Pairs, RecordFacts, all_pairs
from labels.spall_size.signal.alignment import Alignment, aligned
from labels.spall_size.signal.divisors import divisor
from labels.spall_size.signal.mean_pass import mean_pass
from labels.spall_size.signal.noise_floor import log_noise_share
from labels.spall_size.signal.pass_track import PassTrack, track_passes
from labels.spall_size.signal.prewhitening import Prewhitened, prewhitened
from physics.arrays import Array


@dataclass(frozen=True)
class Heard:
    """What is heard of a `signal` (T,) whichever way its sensor looks: the signal prewhitened, the `track` of the
    passes on the `race` that shows most clearly, these passes lined up, and `facts`."""

    signal: Array
    rate: float
    white: Prewhitened
    race: str
    track: PassTrack
    alignment: Alignment
    facts: RecordFacts

    def evidence(self, sign: float = 1.0) -> Evidence | None:
        """The evidence of the signal times its `sign`, 1 or -1; None without two places that may be events."""
        mean = mean_pass(sign * self.signal, sign * self.white.residual, self.alignment, self.track.period * self.rate)
        places = candidate_places(mean)
        if places.size < 2:
            return None
        view = all_pairs(mean, places, self.facts)
        return Evidence(
            race=self.race,
            rate=self.rate,
            deviation=float(np.std(self.signal)),
            unit=self.white.unit,
            alignment=self.alignment,
            mean=mean,
            pairs=Pairs(view.entry, view.exit, view.lag, pair_rows(view)),
        )


def hear(signal: Array, rate: float, pass_period: dict[str, float]) -> Heard | None:
    """What is heard of `signal` (T,) of the race whose `pass_period` (s) shows most clearly; None without passes."""
    white = prewhitened(signal)
    if white.unit == 0.0:  # so small a signal that its squares are none
        return None
    energy = white.residual**2
    tracks = {race: track_passes(energy, rate, period) for race, period in pass_period.items()}
    found = {race: track for race, track in tracks.items() if track is not None}
    if not found:
        return None
    race = max(found, key=lambda name: found[name].score)
    alignment = aligned(energy, rate, found[race])
    if alignment is None:
        return None
    facts = RecordFacts(
        score=found[race].score,
        inner=race == "inner",
        peakedness=peakedness(energy),
        predictability=predictability(signal),
        noise=log_noise_share(signal),
    )
    return Heard(signal, rate, white, race, found[race], alignment, facts)


def gather_evidence(signal: Array, rate: float, pass_period: dict[str, float]) -> Evidence | None:
    """Evidence of `signal` (T,) for the race whose `pass_period` (s) shows most clearly; None without passes or
    events."""
    heard = hear(signal, rate, pass_period)
    return None if heard is None else heard.evidence()


def peakedness(energy: Array) -> float:
    """Log of the mean over the median of an `energy` (T,): the rarer and larger its bursts, the larger."""
    return math.log(float(energy.mean()) / divisor(np.median(energy)))


def predictability(signal: Array) -> float:
    """Log of the variance of a `signal` (T,) over that of its differences: the smoother the signal, the larger."""
    return math.log(float(np.var(signal)) / divisor(np.var(np.diff(signal))))
