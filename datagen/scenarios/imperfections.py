"""Imperfections of a virtual machine's bearing, drawn from the settings of a part."""

from __future__ import annotations

from datagen.recipes.imperfection_settings import ImperfectionSettings, WavinessSettings
from datagen.scenarios.picker import DEGREES_PER_RADIAN, Picker
from physics.bearing import Bearing
from physics.imperfections import Imperfections, Waviness


def draw_imperfections(
    settings: ImperfectionSettings, bearing: Bearing, pick: Picker, pick_scale: Picker
) -> Imperfections:
    """Ball deviations and waviness from the numbers of `pick`, their scales from those of `pick_scale`."""
    wave_scale = pick_scale.number(settings.waviness_scale)
    ball_scale = pick_scale.number(settings.ball_deviation_scale)
    deviation = tuple(
        tuple(ball_scale * pick.number(settings.ball_deviation_um, 1e6) for _ in range(bearing.balls))
        for _ in range(bearing.rows)
    )
    unequal = any(value != 0.0 for row in deviation for value in row)
    waviness = tuple(wave for entry in settings.waviness for wave in _draw_waviness(entry, wave_scale, pick))
    return Imperfections(waviness=waviness, ball_deviation=deviation if unequal else ())


def _draw_waviness(settings: WavinessSettings, scale: float, pick: Picker) -> list[Waviness]:
    race, decay = pick.word(settings.race), pick.number(settings.decay)
    first, last = settings.orders
    drawn = [
        (order, pick.number(settings.amplitude_um, 1e6), pick.number(settings.phase_deg, DEGREES_PER_RADIAN))
        for order in range(first, last + 1)
    ]
    return [
        Waviness(race, order, scale * amplitude * (first / order) ** decay, phase)
        for order, amplitude, phase in drawn
        if scale * amplitude > 0.0
    ]
