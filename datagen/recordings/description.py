"""The labels of a recording: what its SPEC says, what follows from that, and "unknown" or NaN for the rest."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from datagen.errors import BadInput
from datagen.recordings.settings import BearingNumbers
from datagen.recordings.source import Source
from labels.description import NO_SPALL, spall_condition
from labels.schema import HEALTHY, LABELS, MEASURED, UNKNOWN, Label
from physics.bearing import MOST_BALLS, RACES, Bearing
from physics.catalog import bearing as catalogue_bearing
from physics.checks import InvalidParameter
from physics.hertz import BALL_EXPONENT

UNSOLVED: dict[str, Any] = {"model": MEASURED, "method": "none", "validity": "", "contact_law": UNKNOWN}
NUMBERS = (
    "one of these, or its numbers: bearing = {balls = …, ball_diameter_mm = …, pitch_diameter_mm = …}, or bpfo and bpfi"
)
ORDERS = ("bpfo", "bpfi", "bsf", "ftf")
# By how much BPFO + BPFI may miss a whole number, and BPFO the balls times the cage's order: orders are rounded.
WHOLE_WITHIN, CAGE_WITHIN = 0.05, 0.01


def recording_labels(source: Source) -> dict[str, Any]:
    """The labels that the SPEC's settings give or imply, the other texts "unknown" and the other numbers NaN; counts
    and truth values are left out if unknown. Raises BadInput for settings that contradict each other."""
    bearing = stated_bearing(source)
    known = {label.name: _unknown(label) for label in LABELS if label.dtype in ("str", "float64")}
    known |= UNSOLVED | _words(source) | _bearing_labels(source, bearing) | _defect_labels(source, bearing)
    for name in ("load_n", "snr_db"):
        value = source.number(name)
        known |= {} if value is None else {name: value}
    return known


def _unknown(label: Label) -> Any:
    if label.components:
        return (math.nan,) * len(label.components)
    return UNKNOWN if label.dtype == "str" else math.nan


def _words(source: Source) -> dict[str, Any]:
    names = ("rig", "bearing_id", "split")
    return {"part": source.request.part, "channel": source.request.channel.name, "source_file": source.request.name} | {
        name: source.text(name, UNKNOWN) for name in names
    }


def stated_bearing(source: Source) -> Bearing | None:
    """The bearing whose geometry the SPEC states, or which it names; None if it does neither. Raises BadInput if there
    is no such bearing."""
    said = source.setting("bearing")
    try:
        if isinstance(said, BearingNumbers):
            return geometry(said)
        return None if said is None else catalogue_bearing(said)
    except InvalidParameter as problem:
        instead = "" if isinstance(said, BearingNumbers) else NUMBERS
        raise BadInput(str(problem), file=source.request.place, field="bearing", allowed=instead) from None


def contact_numbers(source: Source) -> dict[str, float]:
    """Hertz factor K (N/mⁿ) and exponent n of the bearing from the SPEC or the catalogue; empty if neither has them."""
    said, bearing = source.setting("bearing"), stated_bearing(source)
    if bearing is None or (isinstance(said, BearingNumbers) and said.load_deflection_n_per_m_to_n is None):
        return {}
    return {"K": bearing.load_deflection, "n": bearing.exponent}


def geometry(numbers: BearingNumbers) -> Bearing:
    """A bearing of this geometry; if K is not stated, its contact stiffness is meaningless. Raises InvalidParameter."""
    return Bearing(
        name=numbers.name,
        balls=numbers.balls,
        rows=numbers.rows,
        pitch_diameter=numbers.pitch_diameter_mm * 1e-3,
        ball_diameter=numbers.ball_diameter_mm * 1e-3,
        contact_angle=math.radians(numbers.contact_angle_deg),
        load_deflection=numbers.load_deflection_n_per_m_to_n or 1.0,
        exponent=numbers.exponent or BALL_EXPONENT,
    )


def _bearing_labels(source: Source, bearing: Bearing | None) -> dict[str, Any]:
    stated = {name: value for name in ORDERS if (value := source.number(name)) is not None}
    if bearing is None:
        _check_orders(source, stated)
        return stated
    if stated:
        raise BadInput(
            "it already follows from the bearing's geometry", file=source.request.place, field=next(iter(stated))
        )
    names = ("balls", "rows", "pitch_diameter", "ball_diameter", "contact_angle", *ORDERS)
    return {"bearing": bearing.name} | {name: getattr(bearing, name) for name in names}


def _check_orders(source: Source, stated: dict[str, float]) -> None:
    """Refuse orders that no bearing has, such as frequencies in Hz: BPFO and BPFI add up to the number of balls, and
    BPFO is that number times the order of the cage."""
    if len({"bpfo", "bpfi"} & stated.keys()) == 1:
        _check_single(source, stated)
    outer, inner = stated.get("bpfo", 0.0), stated.get("bpfi", math.inf)
    balls = outer + inner
    if outer >= inner or MOST_BALLS < balls < math.inf:
        raise BadInput(
            f"with bpfi = {inner:g} it would mean a bearing with {balls:g} balls",
            file=source.request.place,
            field="bpfo",
            value=outer,
            allowed=f"orders of the shaft, bpfo below bpfi; their sum is the number of balls, at most {MOST_BALLS}",
        )
    if {"bpfo", "bpfi"} <= stated.keys() and abs(balls - round(balls)) > WHOLE_WITHIN:
        raise BadInput(
            f"with bpfi = {inner:g} it would mean a bearing with {balls:g} balls",
            file=source.request.place,
            field="bpfo",
            value=outer,
            allowed=f"orders whose sum is the number of balls, within {WHOLE_WITHIN:g} of a whole number",
        )
    _check_cage(source, stated)


def _check_single(source: Source, stated: dict[str, float]) -> None:
    """Refuse a BPFO or a BPFI, of which the other is not stated, that only a bearing with too many balls has: BPFO is
    less than half of their number, BPFI less than all of it."""
    name, fewest = ("bpfo", 2.0 * stated["bpfo"]) if "bpfo" in stated else ("bpfi", stated["bpfi"])
    if fewest > MOST_BALLS:
        raise BadInput(
            f"it would mean a bearing with more than {fewest:g} balls",
            file=source.request.place,
            field=name,
            value=stated[name],
            allowed=f"an order of the shaft, of a bearing with at most {MOST_BALLS} balls",
        )


def _check_cage(source: Source, stated: dict[str, float]) -> None:
    """Refuse an order of the cage that, times a whole number of balls, does not give the BPFO that is stated."""
    if not {"bpfo", "ftf"} <= stated.keys():
        return
    outer, cage = stated["bpfo"], stated["ftf"]
    balls = max(1, round(outer + stated["bpfi"] if "bpfi" in stated else outer / cage))
    if abs(outer - balls * cage) > CAGE_WITHIN * outer:
        raise BadInput(
            f"with bpfo = {outer:g} and {balls} balls it should be {outer / balls:.4g}",
            file=source.request.place,
            field="ftf",
            value=cage,
            allowed=f"bpfo over the number of balls, within {CAGE_WITHIN:.0%}",
        )


def _defect_labels(source: Source, bearing: Bearing | None) -> dict[str, Any]:
    location, condition = source.setting("location", UNKNOWN), source.setting("condition", UNKNOWN)
    sizes = _sizes(source, bearing, location)
    healthy = "none" if location == "none" else HEALTHY if condition == HEALTHY else ""
    if healthy:
        if {location, condition} - {"none", HEALTHY, UNKNOWN} or sizes or source.setting("spalls", 0):
            raise BadInput(
                "a healthy bearing has no defect", file=source.request.place, field="location", value=location,
                allowed='location "none", condition "healthy" and no size',
            )  # fmt: skip
        return {"condition": HEALTHY, "location": "none", "spalls": 0} | NO_SPALL
    derived = UNKNOWN
    if bearing and "extent" in sizes:
        derived = spall_condition(sizes["extent"], bearing)
    if condition not in (UNKNOWN, derived) and derived != UNKNOWN:
        raise BadInput(
            f"the defect covers {sizes['extent_spacing']:.3g} ball spacings, which makes it {derived}",
            file=source.request.place, field="condition", value=condition,
        )  # fmt: skip
    count = source.setting("spalls")
    if count == 0:
        raise BadInput(file=source.request.place, field="spalls", value=0, allowed='1 or more, or location "none"')
    stated: dict[str, Any] = {"condition": condition if derived == UNKNOWN else derived, "location": location}
    return stated | sizes | ({} if count is None else {"spalls": count})


def _sizes(source: Source, bearing: Bearing | None, location: str) -> dict[str, float]:
    """The extent in every unit that follows from the one stated, and the depth; only what is known."""
    length, arc, depth = source.number("extent_mm"), source.number("extent_deg"), source.number("depth_um")
    radius = bearing.raceway_radius(location) if bearing and location in RACES else math.nan
    angle = math.radians(arc) if arc is not None else math.nan if length is None else length * 1e-3 / radius
    if angle > 2.0 * math.pi:
        whole = f"a number above 0 up to {2e3 * math.pi * radius:.4g}, the circumference of the {location} race"
        raise BadInput(file=source.request.place, field="extent_mm", value=length, allowed=whole)
    values: dict[str, Callable[[], float]] = {
        "extent": lambda: angle,
        "extent_mm": lambda: length if length is not None else angle * radius * 1e3,
        "extent_spacing": lambda: angle / bearing.spacing if bearing else math.nan,
        "depth": lambda: math.nan if depth is None else depth * 1e-6,
    }
    return {name: value for name, value_of in values.items() if not math.isnan(value := value_of())}
