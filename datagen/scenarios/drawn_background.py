"""Backgrounds drawn for virtual machines, and what is drawn of them for each record."""

from __future__ import annotations

import numpy as np

from datagen.distributions.kinds import Distribution
from datagen.recipes.background_settings import (
    BackgroundSettings,
    GearSettings,
    HumSettings,
    ImpulseSettings,
    PinkSettings,
    ShaftSettings,
)
from datagen.recipes.recording_settings import RecordedLayerSettings
from datagen.scenarios.background import Background, NoiseTarget, Stretch
from datagen.scenarios.draw import Draw
from datagen.scenarios.optional import if_given
from datagen.scenarios.picker import Picker
from physics.backgrounds.gear_mesh import GearMesh
from physics.backgrounds.impulses import Impulses, Resonance
from physics.backgrounds.mains_hum import MainsHum
from physics.backgrounds.pink import PinkNoise
from physics.backgrounds.recording import draw_starts
from physics.backgrounds.shaft_harmonics import ShaftHarmonics


def draw_background(settings: BackgroundSettings, rate: float, draw: Draw) -> Background:
    """Levels of the layers of one machine sampled at `rate` (Hz).

    Raises InvalidParameter if a frequency that was drawn does not lie below half the rate.
    """
    pick = draw.picker
    return Background(
        white_rms=pick("background").number(settings.white_rms_m_s2),
        pink=if_given(settings.pink, lambda layer: _draw_pink(layer, rate, pick("pink_noise"))),
        shaft_harmonics=if_given(settings.shaft_harmonics, lambda layer: _draw_shaft(layer, pick("shaft_harmonics"))),
        gear_mesh=if_given(settings.gear_mesh, lambda layer: _draw_gears(layer, pick("gear_mesh"))),
        mains_hum=if_given(settings.mains_hum, lambda layer: _draw_hum(layer, pick("mains_hum"))),
        impulses=if_given(settings.impulses, lambda layer: _draw_impulses(layer, rate, pick("impulses"))),
        recording_gain=pick("recording").number(settings.recording.gain_m_s2) if settings.recording else 0.0,
    )


def draw_stretch(settings: RecordedLayerSettings, samples: int, draw: Draw) -> Stretch:
    """What a record of `samples` takes of the recording, at a random place.

    Raises InvalidParameter if the recording is too short, BadInput if it is not at hand.
    """
    recording = settings.load()
    first, second = draw_starts(draw.stream("recording"), recording.shape[0], samples)
    starts = (first, first if recording.shape[1] == 2 else second)
    axes = [recording[start : start + samples, min(k, recording.shape[1] - 1)] for k, start in enumerate(starts)]
    content = np.ascontiguousarray(np.stack(axes, axis=1), dtype="<f4").tobytes()
    return Stretch(settings.file, settings.sha256, starts, content)


def draw_noise_target(settings: BackgroundSettings, pick: Picker) -> NoiseTarget | None:
    """The signal-to-noise ratio that a record is scaled to; None if its background keeps its absolute level."""
    setting = settings.snr_db or settings.snr_band_db
    return None if setting is None else NoiseTarget(pick.number(setting), settings.snr_db is not None)


def _draw_pink(settings: PinkSettings, rate: float, pick: Picker) -> PinkNoise:
    noise = PinkNoise(pick.number(settings.rms_m_s2), pick.number(settings.lowest_hz), pick.number(settings.slope))
    noise.check_rate(rate)
    return noise


def _draw_shaft(settings: ShaftSettings, pick: Picker) -> ShaftHarmonics:
    first, last = settings.orders
    decay = pick.number(settings.decay)
    return ShaftHarmonics(_falling(settings.amplitude_m_s2, decay, first, last, pick), first)


def _draw_gears(settings: GearSettings, pick: Picker) -> GearMesh:
    teeth, other_teeth = pick.whole(settings.teeth) or 0, pick.whole(settings.other_teeth) or 0
    sidebands, decay = pick.whole(settings.sidebands) or 0, pick.number(settings.decay)
    modulation, other_modulation = pick.number(settings.modulation), pick.number(settings.other_modulation)
    return GearMesh(
        teeth=teeth,
        amplitudes=_falling(settings.amplitude_m_s2, decay, 1, settings.harmonics, pick),
        other_teeth=other_teeth,
        modulation=modulation,
        other_modulation=other_modulation,
        sidebands=sidebands,
    )


def _draw_hum(settings: HumSettings, pick: Picker) -> MainsHum:
    frequency, decay = pick.number(settings.frequency_hz), pick.number(settings.decay)
    return MainsHum(frequency, _falling(settings.amplitude_m_s2, decay, 1, settings.harmonics, pick))


def _draw_impulses(settings: ImpulseSettings, rate: float, pick: Picker) -> Impulses:
    per_second, amplitude = pick.number(settings.per_second), pick.number(settings.amplitude_m_s2)
    spread, count = pick.number(settings.spread), pick.whole(settings.resonances) or 1
    resonances = tuple(
        Resonance(pick.number(settings.frequency_hz), pick.number(settings.damping)) for _ in range(count)
    )
    knocks = Impulses(per_second, amplitude, spread, resonances)
    knocks.check_rate(rate)
    return knocks


def _falling(amplitude: Distribution, decay: float, first: int, last: int, pick: Picker) -> tuple[float, ...]:
    """Amplitudes of the orders from `first` to `last`, each drawn and brought down by (first / order)^decay."""
    return tuple(pick.number(amplitude) * (first / order) ** decay for order in range(first, last + 1))
