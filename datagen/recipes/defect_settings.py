"""What a recipe says of the spalls of a record."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property, partial
from itertools import product
from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field, WithJsonSchema, model_validator

from datagen.distributions.kinds import Distribution, Fixed
from datagen.recipes.profile_table import DEEPEST_UM, ProfileTable
from datagen.recipes.quantities import EXTENTS_MM, Degrees, Share
from datagen.settings.table import Between, OneOf, Table, Whole, at_most_one, possible_words, refuse
from labels.schema import CONDITIONS, HEALTHY
from physics.bearing import RACES
from physics.spall import ARC_ROUNDING, EXTENDED_FROM, PROFILES

EXTENTS = ("extent_deg", "extent_mm", "extent_spacing")
ENTRY_TAPERS = ("entry_taper_deg", "entry_taper_share")
EXIT_TAPERS = ("exit_taper_deg", "exit_taper_share")
ALTERNATIVES = (EXTENTS, ENTRY_TAPERS, EXIT_TAPERS)
Arc = Annotated[Distribution, Between(0.0, 180.0, above=True)]
TaperArc = Annotated[Distribution, Between(0.0, 180.0)]
Combination = tuple[str, str, str]
KIND = ("condition", "race", "profile")  # what a combination is of
PlaceOf = Callable[[str], str]
FILE_SCHEMA = {"type": "string"}
IN_THE_LOAD_ZONE = Fixed(270.0)
DEPTHS_UM = Between(0.0, DEEPEST_UM)


class SpallSettings(Table):
    """Place, size and shape of the spalls of a race; each further spall draws its own size and shape."""

    row: Annotated[Distribution, OneOf((1, 2, "both", "any"))] | None = None
    """Row of the spall; "both" puts the same one on both rows, "any" on one of the bearing's. 1 if not given."""
    count: Annotated[Distribution, Whole(1, 20)] | None = None
    """Spalls on the race. 1 if not given."""
    angle_deg: Degrees | None = None
    """Centre of the first spall at the start, degrees; 270, in the load zone, if not given."""
    separation_deg: Annotated[Distribution, Between(-360.0, 360.0)] | None = None
    """From the centre of each spall to that of the next, degrees; anywhere if not given."""
    extent_deg: Arc | None = None
    """Arc covered by the spall, degrees. Every spall but a measured table needs this or one of the next two."""
    extent_mm: Annotated[Distribution, EXTENTS_MM] | None = None
    """Length of the spall along its raceway, mm."""
    extent_spacing: Annotated[Distribution, Between(0.0, 100.0, above=True)] | None = None
    """Arc covered by the spall, in ball spacings."""
    depth_um: Annotated[Distribution, DEPTHS_UM] | None = None
    """Depth of the floor, µm. Every spall but a measured table needs one."""
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
    """Standard deviation of the roughness inside the spall, µm; 0 if not given. That of profile tukey is smoothed over
    the width of the contact under the static load, which must be above 0."""
    table: Annotated[ProfileTable, WithJsonSchema(FILE_SCHEMA)] | None = None
    """CSV file of a measured surface (angle_deg, depth_um from 0 to 10000) for profile table, which alone gives its
    extent, depth, tapers and roughness: those settings have no effect on it."""

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

    condition: Annotated[Distribution, OneOf(CONDITIONS)]
    """healthy, line (shorter than the ball spacing) or extended (at least the ball spacing)."""
    race: Annotated[Distribution, OneOf(RACES)] = Fixed("outer")
    """The defective race."""
    profile: Annotated[Distribution, OneOf(PROFILES)] = Fixed("tukey")
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
        conditions = [word for word in possible_words(self.condition) if word != HEALTHY]
        combinations = product(conditions, possible_words(self.race), possible_words(self.profile))
        return {combination: self._refine(combination) for combination in combinations}

    def _refine(self, combination: Combination) -> SpallSettings:
        merged = _given(self)
        for word in combination:
            merged = _replaced(merged, _given(getattr(self, word, None)) if word != "table" else {})
        return SpallSettings.model_construct(**merged)

    def place_of(self, combination: Combination, field: str) -> str:
        """Where the `field` that holds for a combination is written: alone, or after the table that refines it."""
        tables = [word for word in combination if getattr(getattr(self, word, None), field, None) is not None]
        return f"{tables[-1]}.{field}" if tables else field

    def stated_of(self, combination: Combination) -> set[str]:
        """Where what holds for a combination is written, as `place_of` says it; of a healthy one its words alone."""
        spall = self.refined.get(combination)
        return {*KIND, *(() if spall is None else (self.place_of(combination, field) for field in _given(spall)))}

    def check_against_bearings(self, most_rows: int, ball_counts: tuple[int, ...]) -> None:
        """Raise PydanticCustomError for spalls that no bearing of a part can have.

        Its bearings have up to `most_rows` rows, each of one of `ball_counts` rolling elements (none: not known yet).
        """
        for combination, spall in self.refined.items():
            place = partial(_within_defect, self, combination)
            if most_rows == 1 and spall.row is not None and set(possible_words(spall.row)) <= {2, "both"}:
                raise refuse("no bearing of this part has a second row", place("row"), "1, any")
            if spall.extent_deg is not None and ball_counts:
                _check_reach(spall.extent_deg, combination[0], ball_counts, place("extent_deg"))

    @model_validator(mode="after")
    def _complete(self) -> DefectSettings:
        for combination, spall in self.refined.items():
            condition, race, profile = combination
            where = f"{condition} spall, {race} race, profile {profile}"
            _check_shape(spall, where, condition, profile, partial(self.place_of, combination))
        return self


def _within_defect(defect: DefectSettings, combination: Combination, field: str) -> str:
    return f"defect.{defect.place_of(combination, field)}"


def _check_reach(extent: Distribution, condition: str, ball_counts: tuple[int, ...], field: str) -> None:
    """A line spall, of an extent in degrees, is shorter than the ball spacing of some bearing, an extended one not."""
    widest, narrowest = 360.0 / min(ball_counts), 360.0 / max(ball_counts)
    if condition == "line" and min(extent.stated()) >= widest * EXTENDED_FROM:
        raise refuse("a line spall is shorter than the ball spacing", field, f"below {widest:.9g}")
    if condition == "extended" and max(extent.stated()) < narrowest * EXTENDED_FROM:
        raise refuse("an extended spall is at least as long as the ball spacing", field, f"{narrowest:.9g} or more")


def _given(table: BaseModel | None) -> dict[str, Any]:
    if table is None:
        return {}
    return {name: value for name in SpallSettings.model_fields if (value := getattr(table, name)) is not None}


def _replaced(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    dropped = {name for fields in ALTERNATIVES if over.keys() & set(fields) for name in fields}
    return {name: value for name, value in base.items() if name not in dropped} | over


def _check_shape(spall: SpallSettings, where: str, condition: str, profile: str, place: PlaceOf) -> None:
    """Raise PydanticCustomError for what can be no spall of that condition and profile, whatever is drawn.

    `where` says in words which spall it is, `place` where one of its settings is written.
    """
    _check_separation(spall, where, place)
    if profile == "table":
        if spall.table is None:
            raise refuse(f"{where} needs a file of the measured surface", place("table"))
        return
    if all(getattr(spall, name) is None for name in EXTENTS):
        lacks = "neither size nor depth" if spall.depth_um is None else "no size"
        raise refuse(f"{where} has {lacks}", place("extent_deg"), f"one of {', '.join(EXTENTS)}")
    if spall.depth_um is None:
        raise refuse(f"{where} has no depth", place("depth_um"), DEPTHS_UM.allowed())
    if max(spall.depth_um.stated()) == 0.0 and (spall.roughness_um is None or max(spall.roughness_um.stated()) == 0.0):
        raise refuse(
            f"{where} with neither depth nor roughness is none",
            place("depth_um"),
            "above 0, or a roughness_um above 0",
        )
    _check_size(spall, where, condition, place)
    _check_tapers(spall, place)


def _check_size(spall: SpallSettings, where: str, condition: str, place: PlaceOf) -> None:
    """A line spall is shorter than the ball spacing, an extended one is not."""
    if spall.extent_spacing is not None:
        shortest, longest = min(spall.extent_spacing.stated()), max(spall.extent_spacing.stated())
        if condition == "line" and shortest >= EXTENDED_FROM:
            raise refuse(f"{where}: {shortest:.9g} is no line spall", place("extent_spacing"), "below 1 ball spacing")
        if condition == "extended" and longest < EXTENDED_FROM:
            raise refuse(
                f"{where}: {longest:.9g} is no extended spall", place("extent_spacing"), "at least 1 ball spacing"
            )


def _check_separation(spall: SpallSettings, where: str, place: PlaceOf) -> None:
    """Several spalls, each a fixed arc further than the one before, must not come to lie on one another."""
    count, step = spall.count, spall.separation_deg
    if count is None or not isinstance(step, Fixed):
        return
    extent = min(spall.extent_deg.stated()) if spall.extent_deg is not None else 0.0
    for steps in range(1, min(count.stated())):
        apart = abs(math.remainder(steps * float(step.value), 360.0))
        if apart < max(extent * (1.0 - ARC_ROUNDING), ARC_ROUNDING):
            raise refuse(
                f"{where}: spalls 1 and {1 + steps} of {min(count.stated())} overlap, as their centres are {apart:g} "
                f"degrees apart",
                place("separation_deg"),
                f"such that the centres of all are at least {extent:g} degrees apart"
                if extent
                else "such that no two centres coincide",
            )


def _check_tapers(spall: SpallSettings, place: PlaceOf) -> None:
    largest = max(spall.extent_deg.stated()) if spall.extent_deg is not None else None
    shares = 0.0
    for arc_field, share_field in (ENTRY_TAPERS, EXIT_TAPERS):
        arc, share = getattr(spall, arc_field), getattr(spall, share_field)
        if arc is not None and largest is not None:
            shortest = min(arc.stated())
            if shortest > largest:
                raise refuse(
                    f"{shortest:g} is longer than the spall, extent_deg = {largest:g}",
                    place(arc_field),
                    f"0 to {largest:g}",
                )
            shares += shortest / largest
        elif share is not None:
            shares += min(share.stated())
    if shares > 1.0 + ARC_ROUNDING:
        field = next(name for name in (*EXIT_TAPERS, *ENTRY_TAPERS) if getattr(spall, name) is not None)
        raise refuse("entry and exit taper together are longer than the spall", place(field), "at most the whole spall")
