"""The search behind question 1: a grid of extended profiles and what each does beside the line spall."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from datagen.paper.figure08_velocity_spectra import FIRST_READ, SIXTH, harmonics
from datagen.paper.figure09_envelope_spectra import envelope_line
from datagen.paper.scenes import (
    SEEDS,
    SHORTEST_WAVE,
    WAVY_DEPTH,
    WAVY_DEVIATION,
    machine,
    reference_extended_spall,
    scene,
    signal,
    waved_extended_spall,
    wavy_extended_spall,
)
from datagen.paper.simulated import simulated
from physics.arrays import Array
from physics.reference_scenes import extended_spall
from physics.spall import Spall

MICRON, MILLIMETRE = 1e-6, 1e-3
MEAN_DEPTHS_UM = (4.0, 8.0)
DEVIATIONS_UM = (1.0, 2.0, 4.0, 8.0)
SHORTEST_WAVES_MM = (0.4, 1.0, 2.0, 4.0)
SMOOTH_DEPTHS_UM, TAPERS_DEG = (4.0, 8.0, 12.0, 15.0), (0.3, 1.0, 3.0, 10.0)
WAVES_PER_SPACING = (3, 4, 5, 6, 7, 10)
WAVE_SIZES_UM = ((4.0, 2.0), (8.0, 6.0))
ROUGH_SEEDS = len(SEEDS)  # whose line spalls the chapters have simulated already
MOST_RECORDS = 0.8


@dataclass(frozen=True)
class Profile:
    """One kind of extended spall: its family, what it is in words, and its draws (one scene a seed).

    Of random waves also their mean depth and standard deviation (µm) and the shortest (mm); NaN of the others.
    """

    family: str
    title: str
    draws: tuple[Spall, ...]
    depth_um: float = math.nan
    deviation_um: float = math.nan
    shortest_wave_mm: float = math.nan


@dataclass(frozen=True)
class Outcome:
    """What a profile does beside the line spall under the same slip, one value a draw.

    `above` (N, 13) levels of the velocity harmonics over the line spall's, dB; `strongest` (N,) number of the
    strongest harmonic; `envelope_ratio` (N,) BPFO line of the line spall's squared envelope over this one's.
    """

    profile: Profile
    above: Array
    strongest: NDArray[np.int64]
    envelope_ratio: Array

    @property
    def median_lift_db(self) -> float:
        """Median over the draws of how far harmonics 3 to 13 lie, on average, above the line spall's, dB."""
        return float(np.median(np.mean(self.above[:, FIRST_READ - 1 :], axis=1)))

    @property
    def sixth(self) -> float:
        """Median over the draws of how far the sixth harmonic lies above the line spall's, dB."""
        return float(np.median(self.above[:, SIXTH - 1]))

    @property
    def lifts(self) -> bool:
        """Figure 8: the lines as a whole and, in most draws, the sixth lie above, and the sixth is the strongest."""
        sixth = np.mean(self.above[:, SIXTH - 1] > 0.0)
        strongest = np.mean(self.strongest == SIXTH)
        return self.median_lift_db > 0.0 and bool(sixth >= MOST_RECORDS) and bool(strongest >= MOST_RECORDS)

    @property
    def keeps_envelope(self) -> bool:
        """Figure 9: in every draw the line spall's envelope line is the higher one."""
        return bool(np.all(self.envelope_ratio > 1.0))


def smooth_title(depth_um: float, taper_deg: float) -> str:
    """What a smooth profile is called: depth (µm) and tapers (°)."""
    return f"smooth, {depth_um:g} µm deep, tapers {taper_deg:g}°"


def rough_title(depth_um: float, deviation_um: float, shortest_wave_mm: float) -> str:
    """What a profile of random waves is called: mean depth and standard deviation (µm), shortest wave (mm)."""
    return f"{deviation_um:g} µm about {depth_um:g} µm, shortest wave {shortest_wave_mm:g} mm"


# The profile that the other figures use for the extended spall, and the two drawn beside it: scenes G2r and G2.
CHOSEN = rough_title(WAVY_DEPTH / MICRON, WAVY_DEVIATION / MICRON, SHORTEST_WAVE / MILLIMETRE)
REFERENCE, SMOOTH = "reference profile G2r", smooth_title(4.0, 1.0)


def titled(found: Sequence[Outcome], title: str) -> Outcome:
    """The outcome of the profile of this title; ValueError if it was not searched."""
    for outcome in found:
        if outcome.profile.title == title:
            return outcome
    raise ValueError(f'no profile "{title}" among the {len(found)} searched')


def profiles() -> Iterator[Profile]:
    """The whole grid; everything stays between the race and 15 µm below it, but for the reference profile."""
    yield from smooth_profiles()
    yield from waved_profiles()
    yield from rough_profiles(SHORTEST_WAVES_MM, DEVIATIONS_UM, MEAN_DEPTHS_UM)
    draws = tuple(reference_extended_spall(seed) for seed in range(ROUGH_SEEDS))
    yield Profile("reference", REFERENCE, draws)


def smooth_profiles() -> Iterator[Profile]:
    """Tapered windows, each under two draws of slip."""
    for depth in SMOOTH_DEPTHS_UM:
        for taper in TAPERS_DEG:
            draws = (extended_spall(depth * MICRON, math.radians(taper)),) * 2
            yield Profile("smooth", smooth_title(depth, taper), draws)


def waved_profiles() -> Iterator[Profile]:
    """One wave along the spall, a whole number to a ball spacing, in two phases."""
    spacing = machine("gearbox").bearing.spacing
    for waves in WAVES_PER_SPACING:
        for depth, amplitude in WAVE_SIZES_UM:
            sizes = (depth * MICRON, amplitude * MICRON, spacing / waves)
            draws = tuple(waved_extended_spall(*sizes, phase) for phase in (0.0, math.pi / 2.0))
            title = f"waves of {math.degrees(spacing / waves):.3g}°, ±{amplitude:g} µm about {depth:g} µm"
            yield Profile("wave", title, draws)


def rough_profiles(
    shortest_waves: Sequence[float], deviations: Sequence[float], depths: Sequence[float]
) -> Iterator[Profile]:
    """Random waves: shortest wave (mm), standard deviation (µm) and mean depth (µm), cut off at 0 and 15 µm."""
    for depth in depths:
        for deviation in deviations:
            for wave in shortest_waves:
                family = "short" if wave < 2.0 else "long" if wave == 2.0 else "longer"
                draws = tuple(
                    wavy_extended_spall(seed, depth * MICRON, deviation * MICRON, wave * MILLIMETRE)
                    for seed in range(ROUGH_SEEDS)
                )
                yield Profile(family, rough_title(depth, deviation, wave), draws, depth, deviation, wave)


def outcome(profile: Profile) -> Outcome:
    """Simulate every draw of a profile with the slip of the line spall's record of the same number."""
    lines = simulated("line", ROUGH_SEEDS)
    above, strongest, ratio = [], [], []
    for seed, spall in enumerate(profile.draws):
        found = signal(scene("gearbox", spall, slip_seed=seed))
        level = harmonics(found)
        above.append(level - harmonics(lines[seed]))
        strongest.append(int(np.argmax(level)) + 1)
        ratio.append(envelope_line(lines[seed]) / envelope_line(found))
    return Outcome(profile, np.array(above), np.array(strongest), np.array(ratio))
