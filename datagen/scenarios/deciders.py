"""Which settings of a recipe decide a parameter of the physics, so that a refusal can name them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from datagen.distributions.distribution import Distribution
from datagen.recipes.defect_settings import ENTRY_TAPERS, EXIT_TAPERS, EXTENTS
from datagen.settings.toml_lines import Location

if TYPE_CHECKING:
    from datagen.recipes.defect_settings import Combination
    from datagen.recipes.recipe import Recipe

Setting = tuple[Location, object]
BALL_DIAMETERS = ("ball_diameter_mm", "ball_diameter_of_pitch", "ball_diameter")
PITCH_DIAMETERS = ("pitch_diameter_mm", "pitch_diameter")
RATED_LOADS = ("rated_load_n", "rated_load_of_static_rating")
LOADS = ("load_n", "load_of_rated", *RATED_LOADS)
RESONATORS = (
    "resonator_frequency_hz",
    "resonator_stiffness_n_per_m",
    "resonator_stiffness",
    "resonator_mass_kg",
    "resonator_mass",
)
# The settings that decide each parameter, the likeliest to be wrong first; "table.key" is that key of this table alone.
# A parameter that is not here is decided by the settings whose names begin with its own.
DECIDERS: dict[str, tuple[str, ...]] = {
    "amplitude": ("amplitude_um", "waviness_scale", "waviness.decay"),
    "amplitudes": ("amplitude_m_s2",),
    "angle": ("separation_deg", "count", *EXTENTS),
    "ball_diameter": (*BALL_DIAMETERS, "balls", "fill", *PITCH_DIAMETERS),
    "balls": ("balls", "fill", *BALL_DIAMETERS, *PITCH_DIAMETERS),
    "bits": ("recorder_bits",),
    "correlation_time": (
        "slip_correlation_passes",
        "speed_rpm",
        "speed_of_rated",
        "rated_speed_rpm",
        "duration_s",
        "settle_s",
    ),
    "cage": ("mean_slip", "slip_deviation"),
    "cutoff": ("mounting_cutoff_hz",),
    "depth": ("depth_um", "roughness_um"),
    "duration_s": ("duration_s", "rate_hz", *RESONATORS),
    "entry_taper": (*ENTRY_TAPERS, *EXIT_TAPERS, *EXTENTS),
    "extent": (*EXTENTS, "table", "condition", "balls", "fill", "bearing", "rig"),
    "equilibrium": (*LOADS, "load_deflection_n_per_m_to_n", "clearance_um", "amplitude_um", "waviness_scale"),
    "exit_taper": (*EXIT_TAPERS, *EXTENTS),
    "film_damping": ("film_damping_us", "film_damping_n_s_per_m", "film_damping", *RATED_LOADS, "clearance_um"),
    "full_scale": ("recorder_range_m_s2",),
    "load": LOADS,
    "order": ("mounting_order", "orders"),
    "resonator_stiffness": (*RESONATORS, "outer_mass_kg", "outer_mass", "rate_hz"),
    "row": ("row", "rows", "bearing", "rig"),
    "second_cage": ("mean_slip", "slip_deviation"),
    "shaft_speed": ("speed_rpm", "speed_of_rated", "rated_speed_rpm"),
}


def deciders(recipe: Recipe, part: int, parameter: str, kind: Combination | None) -> list[Setting]:
    """The settings that decide the `parameter` in the part with that index: where each is, and its value as in TOML.

    The likeliest to be wrong comes first. If a `kind` is given, only those settings of spalls count that hold for it.
    Settings that the recipe leaves at their default are not found.
    """
    if not parameter:
        return []
    said, names = _said(recipe, part, kind), DECIDERS.get(parameter)
    if names is None:
        return [setting for setting in said if _name(setting).startswith(parameter)]
    ranked = ((rank, setting) for setting in said if (rank := _rank(setting, names)) is not None)
    return [setting for _, setting in sorted(ranked, key=lambda pair: pair[0])]


def _rank(setting: Setting, names: tuple[str, ...]) -> int | None:
    """The place in `names` of a setting, whether they name its table or not; None if they lack it."""
    path = [key for key in setting[0] if isinstance(key, str)]
    called = (path[-1], ".".join(path[-2:]))
    return next((rank for rank, name in enumerate(names) if name in called), None)


def _name(setting: Setting) -> str:
    return str(setting[0][-1])


def _said(recipe: Recipe, index: int, kind: Combination | None) -> Iterator[Setting]:
    """Every setting of a part that the recipe states, with those of the whole recipe that hold for it.

    Of its spalls, only what holds for the `kind`, if one is given.
    """
    part, defect = recipe.part[index], ("part", index, "defect")
    holding = None if part.defect is None or kind is None else part.defect.stated_of(kind)
    for location, value in _settings(part, ("part", index)):
        if holding is None or location[:3] != defect or ".".join(map(str, location[3:])) in holding:
            yield location, value
    for name in ("signal", *(name for name in ("chain", "background") if getattr(part, name) is None)):
        yield from _settings(getattr(recipe, name), (name,))


def _settings(table: BaseModel, place: Location) -> Iterator[Setting]:
    for name in type(table).model_fields:
        if name in table.model_fields_set:
            yield from _inside(getattr(table, name), (*place, name))


def _inside(value: Any, place: Location) -> Iterator[Setting]:
    if isinstance(value, BaseModel):
        yield from _settings(value, place)
    elif isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
        for index, entry in enumerate(value):
            yield from _settings(entry, (*place, index))
    else:
        yield place, value.to_toml() if isinstance(value, Distribution) else value
