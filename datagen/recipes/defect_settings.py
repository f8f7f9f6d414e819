"""What a recipe says of the spalls of a record."""

from __future__ import annotations

from functools import cached_property
from itertools import product
from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field, WithJsonSchema, model_validator

from datagen.distributions.kinds import Distribution, Fixed, Uniform
from datagen.recipes.profile_table import ProfileTable
from datagen.settings.table import Between, OneOf, Table, Whole, at_most_one, possible_words, refuse
from physics.bearing import RACES

EXTENTS = ("extent_deg", "extent_mm", "extent_spacing")
ENTRY_TAPERS = ("entry_taper_deg", "entry_taper_share")
EXIT_TAPERS = ("exit_taper_deg", "exit_taper_share")
ALTERNATIVES = (EXTENTS, ENTRY_TAPERS, EXIT_TAPERS)
Arc = Annotated[Distribution, Between(0.0, 180.0, above=True)]
TaperArc = Annotated[Distribution, Between(0.0, 180.0)]
Share = Annotated[Distribution, Between(0.0, 1.0)]
Combination = tuple[str, str, str]
FILE_SCHEMA = {"type": "string"}
ANYWHERE = Uniform(0.0, 360.0)
IN_THE_LOAD_ZONE = Fixed(270.0)


class SpallSettings(Table):
    """Place, size and shape of the spalls of a race; each further spall draws its own size and shape."""

    row: Annotated[Distribution, OneOf((1, 2, "both", "any"))] | None = None
    """Row of the spall; "both" puts the same one on both rows, "any" on one of the bearing's. 1 if not given."""
    count: Annotated[Distribution, Whole(1, 20)] | None = None
    """Spalls on the race. 1 if not given."""
    angle_deg: Annotated[Distribution, Between()] | None = None
    """Centre of the first spall at the start, degrees; 270, in the load zone, if not given."""
    separation_deg: Annotated[Distribution, Between(-360.0, 360.0)] | None = None
    """From the centre of each spall to that of the next, degrees; anywhere if not given."""
    extent_deg: Arc | None = None
    """Arc covered by the spall, degrees."""
    extent_mm: Annotated[Distribution, Between(0.0, 1e4, above=True)] | None = None
    """Length of the spall along its raceway, mm."""
    extent_spacing: Annotated[Distribution, Between(0.0, 100.0, above=True)] | None = None
    """Arc covered by the spall, in ball spacings."""
    depth_um: Annotated[Distribution, Between(0.0, 1e4)] | None = None
    """Depth of the floor, µm."""
    entry_taper_deg: TaperArc | None = None
    """Arc of the taper that a ball meets first, degrees. At 0 the film does not feel the edge of profile tukey; short
    tapers have the limit of 0.001."""
    entry_taper_share: Share | None = None
    """The same as a share of the spall. If neither is given: 0.1 for profile tukey, 0 for ball_path."""
    exit_taper_deg: TaperArc | None = None
    """Arc of the taper that a ball meets last, degrees. At 0 the film does not feel the edge of profile tukey; short
    tapers have the limit of 0.001."""
    exit_taper_share: Share | None = None
    """The same as a share of the spall. If neither is given: 0.1 for profile tukey, 0 for ball_path."""
    roughness_um: Annotated[Distribution, Between(0.0, 1e3)] | None = None
    """Standard deviation of the roughness inside the spall, µm; 0 if not given."""
    table: Annotated[ProfileTable, WithJsonSchema(FILE_SCHEMA)] | None = None
    """CSV file of a measured surface (angle_deg, depth_um) for profile table, which alone gives its extent, depth,
    tapers and roughness: those settings have no effect on it."""

    @model_validator(mode="after")
    def _one_of_each(self) -> SpallSettings:
        for fields in ALTERNATIVES:
            at_most_one(self, *fields)
        return self


class DefectSettings(SpallSettings):
    """State of health of a record.

    The tables `line`, `extended`, `outer`, `inner`, `tukey` and `ball_path` refine it for records of that condition,
    then race, then profile; the later replaces the earlier.
    """

    condition: Annotated[Distribution, OneOf(("healthy", "line", "extended"))]
    """healthy, line (shorter than the ball spacing) or extended (at least the ball spacing)."""
    race: Annotated[Distribution, OneOf(RACES)] = Fixed("outer")
    """The defective race."""
    profile: Annotated[Distribution, OneOf(("tukey", "ball_path", "table"))] = Fixed("tukey")
    """How the path of the ball's centre follows from the settings."""
    drawn_for: Literal["record", "machine"] = "record"
    """record: each record draws its own spalls; machine: all records of a virtual machine have the same ones."""
    healthy_records: Annotated[int, Field(ge=0, le=10_000_000)] = 0
    """First records of each virtual machine that are healthy whatever is drawn: before the damage."""
    line: SpallSettings | None = None
    """Settings of line spalls."""
    extended: SpallSettings | None = None
    """Settings of extended spalls."""
    outer: SpallSettings | None = None
    """Settings of spalls on the outer race."""
    inner: SpallSettings | None = None
    """Settings of spalls on the inner race."""
    tukey: SpallSettings | None = None
    """Settings of spalls of profile tukey."""
    ball_path: SpallSettings | None = None
    """Settings of spalls of profile ball_path."""

    @cached_property
    def refined(self) -> dict[Combination, SpallSettings]:
        """Settings of each combination of condition, race and profile that can be drawn (none for healthy)."""
        conditions = [word for word in possible_words(self.condition) if word != "healthy"]
        combinations = product(conditions, possible_words(self.race), possible_words(self.profile))
        return {combination: self._refine(combination) for combination in combinations}

    def _refine(self, combination: Combination) -> SpallSettings:
        merged = _given(self)
        for word in combination:
            merged = _replaced(merged, _given(getattr(self, word, None)) if word != "table" else {})
        return SpallSettings.model_construct(**merged)

    @model_validator(mode="after")
    def _complete(self) -> DefectSettings:
        for (condition, race, profile), spall in self.refined.items():
            where = f"{condition} spall, {race} race, profile {profile}"
            _check_shape(spall, profile, where)
        return self


def _given(table: BaseModel | None) -> dict[str, Any]:
    if table is None:
        return {}
    return {name: value for name in SpallSettings.model_fields if (value := getattr(table, name)) is not None}


def _replaced(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    dropped = {name for fields in ALTERNATIVES if over.keys() & set(fields) for name in fields}
    return {name: value for name, value in base.items() if name not in dropped} | over


def _check_shape(spall: SpallSettings, profile: str, where: str) -> None:
    extents = [name for name in EXTENTS if getattr(spall, name) is not None]
    if profile == "table":
        if spall.table is None:
            raise refuse(f"{where} needs a file of the measured surface", "table")
        return
    if not extents:
        raise refuse(f"{where} has no size", "extent_deg", f"one of {', '.join(EXTENTS)}")
    if spall.depth_um is None:
        raise refuse(f"{where} has no depth", "depth_um")
    if max(spall.depth_um.stated()) == 0.0 and (spall.roughness_um is None or max(spall.roughness_um.stated()) == 0.0):
        raise refuse(
            f"{where} with neither depth nor roughness is none", "depth_um", "above 0, or a roughness_um above 0"
        )
    _check_tapers(spall)


def _check_tapers(spall: SpallSettings) -> None:
    largest = max(spall.extent_deg.stated()) if spall.extent_deg is not None else None
    shares = 0.0
    for arc_field, share_field in (ENTRY_TAPERS, EXIT_TAPERS):
        arc, share = getattr(spall, arc_field), getattr(spall, share_field)
        if arc is not None and largest is not None:
            shortest = min(arc.stated())
            if shortest > largest:
                raise refuse(
                    f"{shortest:g} is longer than the spall, extent_deg = {largest:g}", arc_field, f"0 to {largest:g}"
                )
            shares += shortest / largest
        elif share is not None:
            shares += min(share.stated())
    if shares > 1.0 + 1e-12:
        field = next(name for name in (*EXIT_TAPERS, *ENTRY_TAPERS) if getattr(spall, name) is not None)
        raise refuse("entry and exit taper together are longer than the spall", field, "at most the whole spall")
