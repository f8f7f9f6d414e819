"""Measurement chains drawn for virtual machines."""

from __future__ import annotations

from datagen.recipes.chain_settings import ChainSettings, ModeSettings
from datagen.scenarios.draw import Draw
from datagen.scenarios.picker import Picker
from physics.sensor.chain import SensorChain
from physics.sensor.mode import SensorMode
from physics.sensor.mounting import Mounting
from physics.sensor.recorder import Recorder


def draw_chain(settings: ChainSettings, rate: float, draw: Draw) -> SensorChain:
    """The chain of one machine sampled at `rate` (Hz).

    Raises InvalidParameter if a frequency that was drawn does not lie below half the rate.
    """
    pick = draw.picker("chain")
    gain = pick.number(settings.resonator_gain)
    cutoff, order = pick.optional(settings.mounting_cutoff_hz), pick.whole(settings.mounting_order)
    full_scale, bits = pick.optional(settings.recorder_range_m_s2), pick.whole(settings.recorder_bits)
    groups = [_draw_modes(group, draw.picker("sensor_modes", k)) for k, group in enumerate(settings.modes)]
    modes = tuple(mode for group in groups for mode in group)
    chain = SensorChain(
        modes=modes,
        resonator_gain=gain,
        mounting=None if cutoff is None or order is None else Mounting(cutoff, order),
        recorder=None if full_scale is None or bits is None else Recorder(full_scale, bits),
    )
    chain.check_rate(rate)
    return chain


def _draw_modes(settings: ModeSettings, pick: Picker) -> list[SensorMode]:
    count = pick.whole(settings.count) or 0
    return [
        SensorMode(pick.number(settings.frequency_hz), pick.number(settings.damping), pick.number(settings.gain))
        for _ in range(count)
    ]
