"""Everything that features of one record are read from: spectra, families, refined speed. Computed once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from labels.band_tree import COMMON_BANDWIDTH
from labels.features.combs import without_combs
from labels.features.conditioning import Conditioned, condition
from labels.features.envelopes import ENVELOPE_HARMONICS, HIGHEST_SHARE, EnvelopeSpectra, envelope_spectra
from labels.features.families import HARMONICS, Family, find_family
from labels.features.foreign_combs import MOST_COMBS, foreign_combs
from labels.features.kinematics import MEASURED_WITHIN, SLIP_PRIOR, SLIP_TOLERANCE, Kinematics
from labels.features.known_lines import mains_components, shaft_components, without_shaft
from labels.features.lines import Lines, lines_in
from labels.features.race_combs import race_combs
from labels.features.speed import Speed, refine_speed, vibration_lines
from labels.features.turning import Turning
from physics.arrays import Array

# Share of BPFO by which the line may lie off: a slipping cage lowers it, a contact angle of up to 15° raises it.
OUTER_WINDOW = (-0.027, 0.013)
# The same of BPFI, which slip raises and a contact angle lowers.
INNER_WINDOW = (-0.012, 0.020)
# The same where no harmonics of the shaft show its speed.
UNCERTAIN_WINDOW = (-0.025, 0.025)
# Refined speeds within this share of each other, or of the one stated, are the same.
SAME_SPEED = 0.003
# Another speed found without the mains is taken if it has this share of the evidence of the one found with them, both
# without the strongest harmonic. Of shafts near the synchronous speed it had a seventh, of hum 0.99 and more.
WITHOUT_MAINS = 0.75
# Nats of shaft harmonics above which the speed is taken as known; noise alone has 8 at most, in 120 records.
CERTAIN_SPEED = 15.0
VIBRATION_ORDERS = 12.0
# Share by which a race's family may lie higher than stated, and turns of the shaft to its farthest sideband.
FASTER, TURNS_BESIDE = 0.06, 2.0
# Fundamentals, in orders, that no part of a bearing has by design: what other machines and chance put there.
DECOYS = (2.31, 2.63, 2.87, 3.17, 3.37, 3.71, 4.29, 4.61, 5.23, 5.83, 6.37, 6.71, 7.37, 8.29)
RATIOS = (0.5, 2.0 / 3.0, 1.0, 1.5, 2.0)


@dataclass(frozen=True)
class Analysis:
    """One axis of one record: `record` its spectrum, `given` the kinematics at the speed given."""

    record: Conditioned
    given: Kinematics

    @property
    def drift_hz(self) -> float:
        """Half the frequency of the shaft, Hz: anything slower is drift of the sensor, not motion of the bearing."""
        return 0.5 * self.speed.shaft_hz

    @property
    def top_hz(self) -> float:
        """Highest frequency of interest in an envelope, Hz: of the highest harmonic, however the cage slips and the
        speed is off, and of the sidebands beside it."""
        fastest = ENVELOPE_HARMONICS * max(self.given.bpfo, self.given.bpfi) * (1.0 + FASTER)
        return (fastest + TURNS_BESIDE) * self.given.shaft_hz

    @cached_property
    def envelopes(self) -> EnvelopeSpectra:
        """Squared envelope spectra of all bands."""
        return envelope_spectra(
            self.record,
            self.given.shaft_hz,
            min(self.top_hz, HIGHEST_SHARE * self.record.bandwidth),
            self.given.narrowest_band_hz,
        )

    @cached_property
    def vibration_with_shaft(self) -> tuple[Lines, Array]:
        """Lines of the vibration's own spectrum, those of the shaft too, and its power over its local floor (1, F)."""
        top = max(self.top_hz, VIBRATION_ORDERS * self.given.shaft_hz)
        return vibration_lines(self.record, self.given.shaft_hz, min(top, self.record.bandwidth))

    @property
    def speed(self) -> Speed:
        """The refined speed of the shaft; where it changes, the mean that follows exactly from its turning."""
        return self._speed_and_combs[0]

    @cached_property
    def _speed_and_combs(self) -> tuple[Speed, list[float]]:
        """The refined speed, and the rates (Hz) of other shafts that would have moved it.

        Knocks of another shaft can lie near multiples of this one, and near a race's line, at a wrong speed. So where
        the speed found is not the one stated, it is looked for again without the lines of such combs.
        """
        spectrum, power = self.vibration_with_shaft
        if self.record.turning is not None:
            return refine_speed(spectrum, self.envelopes, self.given, exact=True), []
        stated, step, envelopes = self.given.shaft_hz, self.envelopes.step, self.envelopes
        speed, found = refine_speed(spectrum, envelopes, self.given), list[float]()
        mains = mains_components(envelopes.excess.shape[-1], step)
        while _differ(speed.shaft_hz, stated) and len(found) < MOST_COMBS:
            excess = np.where(mains, 1.0, envelopes.excess)
            combs = race_combs(excess, step, self.given.at(speed.shaft_hz), ~mains)
            if not found:
                combs += foreign_combs(excess, step, self.given, ~mains, self.given.speed_within)
            if not combs:
                break
            found += combs
            power = without_combs(power, self.record.step, combs, stated)
            envelopes = replace(envelopes, excess=without_combs(envelopes.excess, step, combs, stated))
            speed = refine_speed(lines_in(power, self.record.step), envelopes, self.given)
        return self._not_drawn_by_mains(speed, power, envelopes), found

    def _not_drawn_by_mains(self, speed: Speed, power: Array, envelopes: EnvelopeSpectra) -> Speed:
        """`speed`, or the one that the lines apart from those of the mains show, if hum may have drawn it from there.

        `power` (1, F) is that of the vibration's spectrum over its floor, with the `envelopes` beside it.
        Hum stands at multiples of the synchronous speed, near which motors turn.
        """
        is_measured = self.given.speed_within <= MEASURED_WITHIN
        if is_measured and not _differ(speed.shaft_hz, self.given.shaft_hz):
            return speed
        mains = mains_components(power.shape[-1], self.record.step)
        spectrum = lines_in(np.where(mains, 1.0, power), self.record.step)
        mains = mains_components(envelopes.excess.shape[-1], envelopes.step)
        other = refine_speed(spectrum, replace(envelopes, excess=np.where(mains, 1.0, envelopes.excess)), self.given)
        if not _differ(other.shaft_hz, speed.shaft_hz):
            return speed
        only_hum = is_measured and other.evidence < CERTAIN_SPEED
        return other if only_hum or other.of_others >= WITHOUT_MAINS * speed.of_others else speed

    @cached_property
    def kinematics(self) -> Kinematics:
        """Kinematics at the refined speed."""
        return self.given.at(self.speed.shaft_hz)

    @cached_property
    def envelope_lines(self) -> Lines:
        """Lines of the envelope spectra, without those of the shaft, of the mains and of other shafts that knock."""
        excess, step, shaft_hz = self.envelopes.excess, self.envelopes.step, self.speed.shaft_hz
        taken_out = shaft_components(excess.shape[-1], step, shaft_hz)
        if self.record.turning is None:
            taken_out |= mains_components(excess.shape[-1], step)
        excess = without_combs(np.where(taken_out, 1.0, excess), step, self._speed_and_combs[1], shaft_hz)
        for look_for in (foreign_combs, race_combs):  # at the speed that was found, which is not in doubt
            excess = without_combs(excess, step, look_for(excess, step, self.kinematics, ~taken_out), shaft_hz)
        return lines_in(excess, step)

    @cached_property
    def all_envelope_lines(self) -> Lines:
        """Lines of the envelope spectra, the shaft's too."""
        return lines_in(self.envelopes.excess, self.envelopes.step)

    @cached_property
    def vibration(self) -> Lines:
        """Lines of the vibration's own spectrum, without those of the shaft."""
        excess = without_shaft(self.vibration_with_shaft[1], self.record.step, self.speed.shaft_hz)
        return lines_in(excess, self.record.step)

    def envelope_family(self, order: float, harmonics: int = HARMONICS) -> Family:
        """The strongest family near an order of the refined speed, in every band's envelope."""
        shaft_hz = self.speed.shaft_hz
        return find_family(self.envelope_lines, order * shaft_hz, SLIP_TOLERANCE, shaft_hz, SLIP_PRIOR, harmonics)

    def race_family(self, lines: Lines, race: str) -> Family:
        """The strongest family of the race "outer" or "inner" in `lines`, within what slip and contact angle allow."""
        centre, tolerance = self.race_window(race)
        return find_family(lines, centre, tolerance, self.speed.shaft_hz, SLIP_PRIOR)

    def race_window(self, race: str) -> tuple[float, float]:
        """Centre (Hz) and half width (a share) of where the first line of the race "outer" or "inner" may lie."""
        window = OUTER_WINDOW if race == "outer" else INNER_WINDOW
        if self.record.turning is None and self.speed.evidence < CERTAIN_SPEED:
            window = UNCERTAIN_WINDOW
        centre = 1.0 + 0.5 * (window[0] + window[1])
        return centre * self.given.pass_order(race) * self.speed.shaft_hz, 0.5 * (window[1] - window[0])

    @cached_property
    def outer(self) -> Family:
        """Outer-race family in the envelopes."""
        return self.race_family(self.envelope_lines, "outer")

    @cached_property
    def inner(self) -> Family:
        """Inner-race family in the envelopes."""
        return self.race_family(self.envelope_lines, "inner")

    @cached_property
    def decoys(self) -> Array:
        """Evidence (D,) of families at fundamentals that belong to no part of the bearing, best band each.

        D is eight, or as many of DECOYS as lie apart from the lines of this bearing.
        """
        of_bearing = np.array([self.given.bpfo, self.given.bpfi, 2.0 * self.given.ball_spin])
        near = [np.abs(order / np.outer(of_bearing, RATIOS) - 1.0).min() < 2.0 * SLIP_TOLERANCE for order in DECOYS]
        chosen = [order for order, taken in zip(DECOYS, near, strict=True) if not taken][:8]
        return np.array([self.envelope_family(order).evidence.max() for order in chosen])


def analyse(
    signal: Array,
    rate: float,
    kinematics: Kinematics,
    bandwidth: float = COMMON_BANDWIDTH,
    turning: Turning | None = None,
) -> Analysis:
    """The analysis of one axis (T,) sampled at `rate` (Hz), below `bandwidth` (Hz).

    Where the speed changes, `turning` says how; it takes precedence over the speed of the `kinematics`, and every
    frequency is an order times the mean speed. ValueError where `condition` finds no signal.
    """
    record = condition(signal, rate, bandwidth, turning)
    if record.turning is not None:
        kinematics = kinematics.at(record.turning.revolutions * record.step)
    return Analysis(record, kinematics)


def _differ(one_hz: float, another_hz: float) -> bool:
    """Whether these are two speeds of a shaft."""
    return abs(one_hz / another_hz - 1.0) >= SAME_SPEED
