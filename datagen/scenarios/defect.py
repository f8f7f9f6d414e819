"""Spalls drawn from the settings of a part."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from datagen.distributions.kinds import Distribution, Fixed
from datagen.recipes.defect_settings import IN_THE_LOAD_ZONE, Combination, DefectSettings, SpallSettings
from datagen.recipes.operation_settings import ANY_ANGLE
from datagen.recipes.profile_table import ProfileTable
from datagen.scenarios.draw import Draw
from datagen.scenarios.picker import DEGREES_PER_RADIAN, Picker
from labels.schema import HEALTHY
from physics.bearing import Bearing
from physics.checks import InvalidParameter, require
from physics.hertz import contact_width
from physics.paths.roughness import draw_roughness
from physics.spall import ARC_ROUNDING, Spall, is_extended, require_apart

TURN = 2.0 * math.pi
DEFAULT_TAPER_SHARE = {"tukey": 0.1, "ball_path": 0.0, "table": 0.0}
ROWS: dict[str, tuple[int, ...]] = {"1": (1,), "2": (2,), "both": (1, 2)}


def draw_spalls(settings: DefectSettings, bearing: Bearing, load: float, draw: Draw) -> tuple[Spall, ...]:
    """Spalls of one record under `load` (N), which only sets the width of contact that smooths their roughness.

    Raises InvalidParameter if what was drawn is impossible; the caller draws again, with the same `draw.intended`.
    """
    pick = draw.picker("defect")
    kind = draw.intended.settle((pick.word(settings.condition), pick.word(settings.race), pick.word(settings.profile)))
    if kind[0] == HEALTHY:
        return ()
    turn = draw.turns.turn
    try:
        return _spalls_of(kind, settings, bearing, load, draw)
    except InvalidParameter:
        others = (other for other in settings.refined if other != kind)
        if not any(_can_be(other, settings, bearing, load, replace(draw, turn=turn)) for other in others):
            draw.intended.release()
        raise


def _spalls_of(
    kind: Combination, settings: DefectSettings, bearing: Bearing, load: float, draw: Draw
) -> tuple[Spall, ...]:
    condition, race, profile = kind
    spalls = list(_draw_all(settings.refined[kind], race, profile, bearing, load, draw))
    _require_condition(condition, max(spall.extent for spall in spalls), bearing)
    require_apart(spalls)
    return tuple(spalls)


def _can_be(kind: Combination, settings: DefectSettings, bearing: Bearing, load: float, draw: Draw) -> bool:
    try:
        _spalls_of(kind, settings, bearing, load, draw)
    except InvalidParameter:
        return False
    return True


def _draw_all(
    settings: SpallSettings, race: str, profile: str, bearing: Bearing, load: float, draw: Draw
) -> Iterator[Spall]:
    pick = draw.picker("spall")
    word = pick.word(settings.row or Fixed(1))
    rows: tuple[int, ...] = ()
    count = pick.whole(settings.count) or 1
    angle = pick.number(settings.angle_deg or IN_THE_LOAD_ZONE, DEGREES_PER_RADIAN)
    for item in range(count):
        if item > 0:
            pick = draw.picker("spall", item)
            angle += pick.number(settings.separation_deg or ANY_ANGLE, DEGREES_PER_RADIAN)
        shape = _draw_shape(settings, race, profile, bearing, pick)
        if item == 0:
            rows = _rows(word, bearing, pick)
        rough = _draw_roughness(shape, bearing, load, draw, item)
        for row in rows:
            yield replace(rough, row=row, angle=angle % TURN)


def _rows(word: str, bearing: Bearing, pick: Picker) -> tuple[int, ...]:
    share = pick.share()
    return (1 + int(share * bearing.rows),) if word == "any" else ROWS[word]


def _draw_shape(settings: SpallSettings, race: str, profile: str, bearing: Bearing, pick: Picker) -> Spall:
    """A spall without place and without its roughness values."""
    extent = _draw_extent(settings, race, bearing, pick)
    depth = pick.number(settings.depth_um or Fixed(0.0), 1e6)
    entry = _draw_taper(settings.entry_taper_deg, settings.entry_taper_share, profile, extent, pick)
    exit_ = _draw_taper(settings.exit_taper_deg, settings.exit_taper_share, profile, extent, pick)
    roughness = pick.number(settings.roughness_um or Fixed(0.0), 1e6)
    if profile == "table" and settings.table is not None:
        return _measured_spall(race, settings.table)
    require(depth > 0.0 or roughness > 0.0, "a spall with neither depth nor roughness is none", "depth")
    _require_arcs(extent, entry, exit_, bearing, race)
    return Spall(
        race=race,
        row=1,
        angle=0.0,
        extent=extent,
        depth=depth,
        entry_taper=entry,
        exit_taper=exit_,
        profile=profile,
        roughness=roughness,
    )


def _measured_spall(race: str, table: ProfileTable) -> Spall:
    arcs, depths = table.centred_angles(), table.depths()
    extent = math.radians(table.extent_deg)
    return Spall(race, 1, 0.0, extent, max(depths), profile="table", table_angle=arcs, table_depth=depths)


def _draw_extent(settings: SpallSettings, race: str, bearing: Bearing, pick: Picker) -> float:
    number = pick.optional(settings.extent_deg or settings.extent_mm or settings.extent_spacing)
    if number is None:
        return bearing.spacing
    if settings.extent_deg is not None:
        return math.radians(number)
    return number / 1e3 / bearing.raceway_radius(race) if settings.extent_mm is not None else number * bearing.spacing


def _require_arcs(extent: float, entry: float, exit_: float, bearing: Bearing, race: str) -> None:
    """Raise InvalidParameter, in the units of recipes, unless spall and tapers (rad) fit on their raceway."""
    covered = math.degrees(extent)
    require(
        extent <= math.pi,
        f"the spall covers {covered:.4g} degrees; allowed: at most 180 degrees, on this raceway "
        f"{math.pi * bearing.raceway_radius(race) * 1e3:.4g} mm or {math.pi / bearing.spacing:.4g} ball spacings",
        "extent",
    )
    for field, taper in (("entry_taper", entry), ("exit_taper", exit_)):
        require(
            taper <= extent,
            f"the {field.replace('_', ' ')} of {math.degrees(taper):.4g} degrees is longer than the spall of "
            f"{covered:.4g} degrees",
            field,
        )
    require(
        entry + exit_ <= extent * (1.0 + ARC_ROUNDING),
        f"entry and exit taper of {math.degrees(entry):.4g} and {math.degrees(exit_):.4g} degrees are together longer "
        f"than the spall of {covered:.4g} degrees",
        "entry_taper",
    )


def _draw_taper(
    arc: Distribution | None, share: Distribution | None, profile: str, extent: float, pick: Picker
) -> float:
    if arc is not None:
        return pick.number(arc, DEGREES_PER_RADIAN)
    return pick.number(share or Fixed(DEFAULT_TAPER_SHARE[profile])) * extent


def _draw_roughness(spall: Spall, bearing: Bearing, load: float, draw: Draw, item: int) -> Spall:
    if spall.roughness == 0.0:
        return spall
    width = _smoothing_width(spall, bearing, load)
    generator = draw.stream("roughness", item)
    values = draw_roughness(generator, bearing, spall.race, spall.extent, spall.roughness, width)
    return replace(spall, roughness_values=values)


def _smoothing_width(spall: Spall, bearing: Bearing, load: float) -> float | None:
    """Width of the contact that smooths the roughness of a hand-set path, m; None where a ball is rolled over it."""
    if spall.profile != "tukey":
        return None
    require(
        load > 0.0,
        f"the static load of {load:g} N gives the contact no width to smooth the roughness of profile tukey over; "
        "allowed: a load above 0, or profile ball_path",
        "load",
    )
    return contact_width(bearing, spall.race, bearing.stribeck_peak_load(load))


def _require_condition(condition: str, extent: float, bearing: Bearing) -> None:
    extended = is_extended(extent, bearing)
    if extended != (condition == "extended"):
        relation = "reaches" if extended else "is shorter than"
        spacing = f"{math.degrees(bearing.spacing):.4g} degrees"
        raise InvalidParameter(
            f"condition = {condition}, but the spall of {math.degrees(extent):.4g} degrees {relation} the ball spacing "
            f"of {spacing}; allowed: {'at least' if condition == 'extended' else 'below'} {spacing}",
            "extent",
        )
