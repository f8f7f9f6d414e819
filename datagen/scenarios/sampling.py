"""From a recipe to one of its scenarios: a pure function of (recipe, record), whoever draws it and when."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from datagen.recipes.distributions import Distribution, Fixed
from datagen.recipes.machine_settings import CLEAN
from datagen.recipes.operation_settings import OperationSettings
from datagen.recipes.recipe import Part, Recipe
from datagen.records.background import Background
from datagen.scenarios.defect import draw_spalls
from datagen.scenarios.feasibility import require_equilibrium
from datagen.scenarios.machine import DEGREES_PER_RADIAN, Machine, draw_machine
from datagen.scenarios.picker import Picker
from datagen.scenarios.redraw import MOST_ATTEMPTS, Redraw, given_up
from datagen.scenarios.scenario import Scenario, Seeds
from datagen.scenarios.streams import stream
from labels.envelope import default_band
from physics.bearing import Bearing
from physics.cage import CagePath, draw_slip_knots
from physics.checks import InvalidParameter
from physics.operation import Operation
from physics.rig import Rig
from physics.scene import Scene

RPM = 60.0 / (2.0 * math.pi)


def draw_scenario(recipe: Recipe, record: int) -> Scenario:
    """Scenario of `record` (0 ≤ record < recipe.count); BadInput if its part can hardly be drawn."""
    part_index, machine_number = recipe.place(record)
    part = recipe.part[part_index]
    machine = draw_machine(recipe, part, machine_number)
    redraws = list(machine.redraws)
    for attempt in range(MOST_ATTEMPTS):
        try:
            return _draw(recipe, part, machine, record, attempt, tuple(redraws))
        except InvalidParameter as refused:
            redraws.append(Redraw("record", attempt, refused.field, str(refused)))
    raise given_up(recipe, part, f"record {record}", redraws)


def _draw(
    recipe: Recipe, part: Part, machine: Machine, record: int, attempt: int, redraws: tuple[Redraw, ...]
) -> Scenario:
    def open_stream(purpose: str, item: int = 0) -> np.random.Generator:
        return stream(recipe.seed, "record", record, purpose, attempt, item)

    rig, run, pick = machine.rig, part.operation, Picker.of(open_stream("operation"))
    operation = _draw_operation(run, rig, pick)
    slip = _draw_slip(run, rig.bearing, operation.shaft_speed, pick)
    contact_law = pick.word(part.contact_law)
    spalls = draw_spalls(part.defect, rig.bearing, operation.load, open_stream)
    duration = machine.samples / machine.rate
    scene = Scene(
        rig=rig,
        operation=operation,
        cage=slip.path(duration, slip.start_angle, open_stream("slip")),
        spalls=spalls,
        imperfections=machine.imperfections,
        contact_law=contact_law,
        second_cage=slip.path(duration, slip.second_start_angle, open_stream("slip", 1))
        if machine.separate_cages
        else None,
    )
    require_equilibrium(scene)
    return Scenario(
        scene=scene,
        rate=machine.rate,
        seeds=Seeds(recipe.seed, record, attempt, machine.number, machine.attempt),
        part=part.name,
        bearing_id=machine.bearing_id,
        split=machine.split,
        envelope_band=recipe.signal.envelope_band_hz or _default_band(rig, machine.rate),
        slip_deviation=slip.deviation,
        slip_correlation_time=slip.correlation_time,
        background=_draw_background(part, machine, open_stream("background")),
        redraws=redraws,
    )


def _draw_background(part: Part, machine: Machine, generator: np.random.Generator) -> Background:
    """The machine's noise floor, or the record's own noise where the part states its signal-to-noise ratio."""
    setting = part.background.white_snr_db
    level = CLEAN if setting is None else setting.draw(generator)
    return machine.background if level == CLEAN else Background(white_snr_db=float(level))


_default_band = lru_cache(maxsize=256)(default_band)


def _draw_operation(settings: OperationSettings, rig: Rig, pick: Picker) -> Operation:
    speed = _absolute_or_relative(settings.speed_rpm, RPM, settings.speed_of_rated, rig.rated_speed, pick)
    load = _absolute_or_relative(settings.load_n, 1.0, settings.load_of_rated, rig.rated_load, pick)
    unbalance, unbalance_phase = pick.number(settings.unbalance_n), pick.number(settings.unbalance_phase_deg)
    fluctuation, fluctuation_phase = pick.number(settings.load_fluctuation), pick.number(settings.fluctuation_phase_deg)
    return Operation(
        shaft_speed=speed,
        load=load,
        unbalance_force=unbalance,
        unbalance_phase=unbalance_phase / DEGREES_PER_RADIAN if unbalance else 0.0,
        load_fluctuation=fluctuation,
        fluctuation_phase=fluctuation_phase / DEGREES_PER_RADIAN if fluctuation else 0.0,
    )


def _absolute_or_relative(
    absolute: Distribution | None, per_unit: float, share: Distribution | None, rated: float, pick: Picker
) -> float:
    if absolute is not None:
        return pick.number(absolute, per_unit)
    return pick.number(share or Fixed(1.0)) * rated


@dataclass(frozen=True)
class _Slip:
    """Statistics of the slip and the cages' start; `correlation_time` s, angles rad."""

    nominal_speed: float
    mean_slip: float
    deviation: float
    correlation_time: float
    start_angle: float
    second_start_angle: float

    def path(self, duration: float, start_angle: float, generator: np.random.Generator) -> CagePath:
        """A cage's path over `duration` (s), its knots drawn from `generator`."""
        if self.deviation == 0.0:
            return CagePath(self.nominal_speed, duration, start_angle, self.mean_slip)
        step, start, values = draw_slip_knots(generator, self.deviation, self.correlation_time, duration)
        return CagePath(self.nominal_speed, duration, start_angle, self.mean_slip, step, start, values)


def _draw_slip(settings: OperationSettings, bearing: Bearing, shaft_speed: float, pick: Picker) -> _Slip:
    cage_speed = bearing.cage_speed(shaft_speed)
    return _Slip(
        nominal_speed=cage_speed,
        start_angle=pick.number(settings.cage_angle_deg, DEGREES_PER_RADIAN),
        second_start_angle=pick.number(settings.second_cage_angle_deg, DEGREES_PER_RADIAN),
        mean_slip=pick.number(settings.mean_slip),
        deviation=pick.number(settings.slip_deviation),
        correlation_time=pick.number(settings.slip_correlation_passes) * bearing.spacing / cage_speed,
    )
