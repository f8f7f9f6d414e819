"""From a recipe to one of its scenarios: a pure function of (recipe, record), whoever draws it and when."""

from __future__ import annotations

from dataclasses import dataclass, replace
from operator import index

from datagen.distributions.kinds import Distribution, Fixed
from datagen.recipes.operation_settings import FASTEST_RPM, SLOWEST_RPM, OperationSettings
from datagen.recipes.recipe import Recipe
from datagen.recipes.record_order import Place
from datagen.scenarios.accuracy import Accuracy
from datagen.scenarios.defect import draw_spalls
from datagen.scenarios.draw import Draw
from datagen.scenarios.drawn_background import draw_noise_target, draw_stretch
from datagen.scenarios.drawn_rig import RPM_PER_RAD_S
from datagen.scenarios.feasibility import require_equilibrium
from datagen.scenarios.intended_kind import IntendedKind
from datagen.scenarios.machine import Machine, draw_machine
from datagen.scenarios.optional import if_given
from datagen.scenarios.picker import DEGREES_PER_RADIAN, Picker
from datagen.scenarios.redraw import MOST_ATTEMPTS, given_up
from datagen.scenarios.refused import Redraw
from datagen.scenarios.scenario import Scenario, Seeds
from physics.angular_speed import in_rpm
from physics.bearing import Bearing
from physics.cage import CagePath, draw_slip_knots
from physics.checks import InvalidParameter, require_between
from physics.operation import Operation
from physics.rig import Rig
from physics.scene import Scene
from physics.spall import Spall


def draw_scenario(recipe: Recipe, record: int) -> Scenario:
    """Scenario of `record` (0 ≤ record < recipe.count); BadInput if its part can hardly be drawn."""
    record = index(record)  # of numpy's whole numbers too, which JSON lacks
    place = recipe.place(record)
    machine = draw_machine(recipe, place.part, place.machine, place.machine_in_part)
    redraws, intended = list(machine.redraws), IntendedKind()
    for attempt in range(MOST_ATTEMPTS):
        draw = Draw(recipe, place.part, "record", record, place.record_in_part, attempt, intended=intended)
        try:
            return _draw(draw, machine, place, tuple(redraws))
        except InvalidParameter as refused:
            redraws.append(Redraw("record", attempt, refused.field, str(refused)))
    raise given_up(recipe, place.part, f"record {record}", redraws, intended.kind)


def _draw(draw: Draw, machine: Machine, place: Place, redraws: tuple[Redraw, ...]) -> Scenario:
    recipe, part = draw.recipe, draw.recipe.part[draw.part]
    rig, run, pick = machine.rig, part.operation, draw.picker("operation")
    operation = _draw_operation(run, rig, pick)
    slip = _draw_slip(run, rig.bearing, operation.shaft_speed, pick)
    contact_law = pick.word(part.contact_law)
    duration = machine.samples / machine.rate
    scene = Scene(
        rig=rig,
        operation=operation,
        cage=slip.path(duration, machine.settle, slip.start_angle, draw),
        spalls=_spalls(draw, machine, place, operation.load),
        imperfections=machine.imperfections,
        contact_law=contact_law,
        second_cage=slip.path(duration, machine.settle, slip.second_start_angle, draw, 1)
        if machine.separate_cages
        else None,
    )
    require_equilibrium(scene, -machine.settle)
    background = recipe.background_of(part)
    return Scenario(
        scene=scene,
        rate=machine.rate,
        settle=machine.settle,
        seeds=Seeds(recipe.seed, draw.number, draw.attempt, machine.number, machine.attempt),
        part=part.name,
        bearing_id=machine.bearing_id,
        split=machine.split,
        envelope_band=machine.envelope_band,
        slip_deviation=slip.deviation,
        slip_correlation_time=slip.correlation_time,
        chain=machine.chain,
        background=machine.background,
        stretch=if_given(background.recording, lambda recording: draw_stretch(recording, machine.samples, draw)),
        noise_target=draw_noise_target(background, draw.picker("noise_target")),
        snr_band=background.snr_band_hz or machine.envelope_band,
        redraws=redraws,
        accuracy=Accuracy(recipe.accuracy.relative, recipe.accuracy.below_noise_db),
    )


def _spalls(draw: Draw, machine: Machine, place: Place, load: float) -> tuple[Spall, ...]:
    """The record's own spalls, or its machine's, unless the record is from before the damage."""
    part = draw.recipe.part[draw.part]
    if part.defect is None or place.record_in_machine < part.defect.healthy_records:
        return ()
    if part.defect.drawn_for == "machine":
        draw = replace(
            draw,
            scope="machine",
            number=machine.number,
            place=place.machine_in_part,
            attempt=machine.attempt,
            turn=machine.turn,
            intended=IntendedKind(machine.kind),
        )
    return draw_spalls(part.defect, machine.rig.bearing, load, draw)


def _draw_operation(settings: OperationSettings, rig: Rig, pick: Picker) -> Operation:
    speed = _absolute_or_relative(settings.speed_rpm, RPM_PER_RAD_S, settings.speed_of_rated, rig.rated_speed, pick)
    load = _absolute_or_relative(settings.load_n, 1.0, settings.load_of_rated, rig.rated_load, pick)
    require_between("shaft_speed", in_rpm(speed), SLOWEST_RPM, FASTEST_RPM, "rpm", "the shaft speed")
    unbalance = _draw_unbalance(settings, rig, speed, pick)
    unbalance_phase = pick.number(settings.unbalance_phase_deg)
    fluctuation, fluctuation_phase = pick.number(settings.load_fluctuation), pick.number(settings.fluctuation_phase_deg)
    return Operation(
        shaft_speed=speed,
        load=load,
        unbalance_force=unbalance,
        unbalance_phase=unbalance_phase / DEGREES_PER_RADIAN if unbalance else 0.0,
        load_fluctuation=fluctuation,
        fluctuation_phase=fluctuation_phase / DEGREES_PER_RADIAN if fluctuation else 0.0,
    )


def _draw_unbalance(settings: OperationSettings, rig: Rig, speed: float, pick: Picker) -> float:
    if settings.unbalance_grade_mm_per_s is not None:
        return pick.number(settings.unbalance_grade_mm_per_s, 1e3) * rig.inner_mass * speed
    return pick.number(settings.unbalance_n or Fixed(0.0))


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

    def path(self, duration: float, settle: float, start_angle: float, draw: Draw, item: int = 0) -> CagePath:
        """The path of cage `item` (from 0) from −`settle` to `duration` (s), its knots drawn from its own stream."""
        if self.deviation == 0.0:
            return CagePath(self.nominal_speed, duration, start_angle, self.mean_slip)
        generator = draw.stream("slip", item)
        step, start, values = draw_slip_knots(generator, self.deviation, self.correlation_time, duration, settle)
        return CagePath(
            nominal_speed=self.nominal_speed,
            duration=duration,
            start_angle=start_angle,
            mean_slip=self.mean_slip,
            knot_step=step,
            knot_start=start,
            knot_values=values,
        )


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
