"""Rigs and bearings as a recipe's machine table says: of the catalogue, altered, or drawn number by number."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

from datagen.recipes.machine_settings import DRAWN, FactorSettings, MachineSettings
from datagen.scenarios.picker import DEGREES_PER_RADIAN, Picker
from physics import catalog
from physics.angular_speed import RPM
from physics.bearing import Bearing
from physics.checks import require
from physics.hertz import (
    BALL_EXPONENT,
    ROLLER_EXPONENT,
    hertz_load_deflection,
    is_roller,
    roller_load_deflection_factor,
)
from physics.modes import rated_matrices
from physics.rating import static_load_rating
from physics.rig import Rig

RPM_PER_RAD_S = 1.0 / RPM
# (setting, field, how many of the setting's units make one SI unit). Append only: the order is that of the stream.
BEARING_NUMBERS = (
    ("pitch_diameter_mm", "pitch_diameter", 1e3),
    ("ball_diameter_mm", "ball_diameter", 1e3),
    ("contact_angle_deg", "contact_angle", DEGREES_PER_RADIAN),
    ("row_offset_deg", "row_offset", DEGREES_PER_RADIAN),
    ("load_deflection_n_per_m_to_n", "load_deflection", 1.0),
    ("exponent", "exponent", 1.0),
    ("clearance_um", "clearance", 1e6),
)
RIG_NUMBERS = (
    ("inner_mass_kg", "inner_mass", 1.0),
    ("outer_mass_kg", "outer_mass", 1.0),
    ("resonator_mass_kg", "resonator_mass", 1.0),
    ("support_stiffness_x_n_per_m", "support_stiffness_x", 1.0),
    ("support_stiffness_y_n_per_m", "support_stiffness_y", 1.0),
    ("resonator_stiffness_n_per_m", "resonator_stiffness", 1.0),
    ("support_damping_x_n_s_per_m", "support_damping_x", 1.0),
    ("support_damping_y_n_s_per_m", "support_damping_y", 1.0),
    ("resonator_damping_n_s_per_m", "resonator_damping", 1.0),
    ("film_damping_n_s_per_m", "film_damping", 1.0),
)
CONFORMITIES = (
    ("inner_conformity", "inner_conformity", 1.0),
    ("outer_conformity", "outer_conformity", 1.0),
)
RATED_NUMBERS = (("rated_speed_rpm", "rated_speed", RPM_PER_RAD_S), ("rated_load_n", "rated_load", 1.0))
# Every setting of the machine table but its factors, in the order of the stream.
STREAM = (
    "rig",
    "bearing",
    "balls",
    "rows",
    *(name for name, _, _ in (*BEARING_NUMBERS, *RIG_NUMBERS)),
    "separate_cages",
    "inner_conformity",
    "outer_conformity",
    "elements",
    "ball_diameter_of_pitch",
    "fill",
    "roller_length_of_diameter",
    "support_frequency_hz",
    "support_stiffness_x_over_y",
    "support_damping_ratio",
    "resonator_frequency_hz",
    "resonator_damping_ratio",
    "film_damping_us",
    "rated_speed_rpm",
    "rated_load_n",
    "rated_load_of_static_rating",
)
MASSES = ("inner_mass", "outer_mass", "resonator_mass")
SUPPORT_STIFFNESS = ("support_stiffness_x", "support_stiffness_y")
SUPPORT_DAMPING = ("support_damping_x", "support_damping_y")
GEOMETRY = ("pitch_diameter", "ball_diameter", "contact_angle", "inner_conformity", "outer_conformity")
# Stand-ins whose every number is replaced.
NO_BEARING = Bearing(DRAWN, balls=3, rows=1, pitch_diameter=1.0, ball_diameter=0.1, load_deflection=1.0)
NO_RIG = Rig(DRAWN, NO_BEARING, *(1.0,) * 12)
Values = dict[str, Any]


def draw_rig(settings: MachineSettings, pick: Picker) -> tuple[Rig, bool]:
    """A rig, and whether the rows of its bearing have separate cages; raises InvalidParameter if the machine is
    impossible."""
    said = {name: pick.value(getattr(settings, name)) for name in STREAM}
    drawn = {name: pick.optional(getattr(settings.factors, name)) for name in FactorSettings.model_fields}
    factors = {name: 1.0 if factor is None else factor for name, factor in drawn.items()}
    rig = NO_RIG if said["rig"] == DRAWN else catalog.rig(said["rig"])
    bearing = _altered_bearing(_mounted(said, rig), said, factors)
    return _altered_rig(replace(rig, bearing=bearing), said, factors), said["separate_cages"] and bearing.rows > 1


def _mounted(said: Values, rig: Rig) -> Bearing:
    if said["bearing"] is None:
        return rig.bearing
    return NO_BEARING if said["bearing"] == DRAWN else catalog.bearing(said["bearing"])


def _numbers(base: Bearing | Rig, said: Values, numbers: tuple[tuple[str, str, float], ...]) -> Values:
    """Every field of `base`, SI units, some replaced by the `numbers` that the settings (`said`) give."""
    given = {field: said[name] / per_unit for name, field, per_unit in numbers if said[name] is not None}
    return {field.name: getattr(base, field.name) for field in fields(base)} | given


def _altered_bearing(base: Bearing, said: Values, factors: Values) -> Bearing:
    """`base` altered as the settings (`said`) and the `factors` ask; K follows the geometry unless it is given."""
    numbers = _numbers(base, said, (*BEARING_NUMBERS, *CONFORMITIES))
    numbers["pitch_diameter"] *= factors["pitch_diameter"]
    if said["ball_diameter_of_pitch"] is not None:
        numbers["ball_diameter"] = said["ball_diameter_of_pitch"] * numbers["pitch_diameter"]
    numbers["ball_diameter"] *= factors["ball_diameter"]
    numbers["clearance"] *= factors["clearance"]
    if said["rows"] is not None:
        numbers["rows"] = said["rows"]
    balls = said["balls"] if said["fill"] is None else _balls_that_fill(said["fill"], numbers)
    if balls is not None:
        numbers["balls"] = balls
        numbers["row_offset"] = None if said["row_offset_deg"] is None else numbers["row_offset"]
    if said["elements"] is not None:
        numbers["exponent"] = ROLLER_EXPONENT if said["elements"] == "rollers" else BALL_EXPONENT
    bearing = Bearing(**numbers)
    if said["load_deflection_n_per_m_to_n"] is None:
        bearing = replace(bearing, load_deflection=_load_deflection(base, bearing, said))
    return replace(bearing, load_deflection=bearing.load_deflection * factors["load_deflection"])


def _balls_that_fill(fill: float, numbers: Values) -> int:
    """The number of balls that is the share `fill` of the most that fit side by side on the pitch circle."""
    ratio = numbers["ball_diameter"] / numbers["pitch_diameter"]
    require(ratio < 1.0, f"a ball of {ratio:.3g} pitch diameters does not fit", "ball_diameter")
    return math.floor(fill * math.pi / math.asin(ratio) * (1.0 + 1e-12))


def _load_deflection(base: Bearing, bearing: Bearing, said: Values) -> float:
    """K of `bearing`: by the law of its contact if it is drawn, else that of `base` scaled as this law scales."""
    if base is NO_BEARING or said["elements"] is not None:
        if is_roller(bearing):
            return roller_load_deflection_factor(said["roller_length_of_diameter"] * bearing.ball_diameter)
        return hertz_load_deflection(bearing)
    if is_roller(bearing) or all(getattr(bearing, field) == getattr(base, field) for field in GEOMETRY):
        return base.load_deflection
    return base.load_deflection * hertz_load_deflection(bearing) / hertz_load_deflection(base)


def _altered_rig(base: Rig, said: Values, factors: Values) -> Rig:
    """`base` altered as the settings (`said`) and the `factors` ask: masses, then the stiffness and damping that depend
    on them, the rated load and the film."""
    numbers = _numbers(base, said, (*RIG_NUMBERS, *RATED_NUMBERS))
    for mass in MASSES:
        numbers[mass] *= factors[mass]
    _set_stiffness(numbers, said, factors)
    _set_damping(numbers, said, factors)
    if said["rated_load_of_static_rating"] is not None:
        numbers["rated_load"] = said["rated_load_of_static_rating"] * static_load_rating(base.bearing)
    rig = Rig(**numbers)
    if said["film_damping_us"] is not None:
        rig = replace(rig, film_damping=_film_damping(rig, said["film_damping_us"] / 1e6))
    return replace(rig, film_damping=rig.film_damping * factors["film_damping"])


def _set_stiffness(numbers: Values, said: Values, factors: Values) -> None:
    if said["support_frequency_hz"] is not None:
        along_y = (2.0 * math.pi * said["support_frequency_hz"]) ** 2 * numbers["outer_mass"]
        numbers["support_stiffness_y"] = along_y
        numbers["support_stiffness_x"] = along_y * said["support_stiffness_x_over_y"]
    if said["resonator_frequency_hz"] is not None:
        angular = 2.0 * math.pi * said["resonator_frequency_hz"]
        numbers["resonator_stiffness"] = angular**2 * numbers["resonator_mass"]
    for field in SUPPORT_STIFFNESS:
        numbers[field] *= factors["support_stiffness"]
    numbers["resonator_stiffness"] *= factors["resonator_stiffness"]


def _set_damping(numbers: Values, said: Values, factors: Values) -> None:
    if said["support_damping_ratio"] is not None:
        for damping, stiffness in zip(SUPPORT_DAMPING, SUPPORT_STIFFNESS, strict=True):
            critical = 2.0 * math.sqrt(numbers[stiffness] * numbers["outer_mass"])
            numbers[damping] = said["support_damping_ratio"] * critical
    if said["resonator_damping_ratio"] is not None:
        critical = 2.0 * math.sqrt(numbers["resonator_stiffness"] * numbers["resonator_mass"])
        numbers["resonator_damping"] = said["resonator_damping_ratio"] * critical
    for field in SUPPORT_DAMPING:
        numbers[field] *= factors["support_damping"]
    numbers["resonator_damping"] *= factors["resonator_damping"]


def _film_damping(rig: Rig, time: float) -> float:
    """Damping of one contact (N s/m) that makes the bearing's damping along y `time` (s) times its stiffness."""
    stiffness, damping = rated_matrices(replace(rig, film_damping=1.0))
    require(damping[1, 1] > 0.0, "no ball carries the rated load, so no film can damp it", "film_damping")
    return float(time * stiffness[1, 1] / damping[1, 1])
