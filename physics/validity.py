"""Whether a scene lies where the model holds: what it neglects, set beside what it computes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from physics.angular_speed import in_rpm
from physics.bearing import Bearing
from physics.hertz import is_roller, roller_length
from physics.paths.depth_path import DepthPath
from physics.paths.profile import build_path, is_rough
from physics.rating import static_load_rating
from physics.scene import Scene
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium, instants_without_period, load_range
from physics.statics.rest import NO_EQUILIBRIUM

STEEL_DENSITY = 7850.0  # kg/m³, assumed for every rolling element
NEGLIGIBLE_SHARE = 0.2  # the paper's own fan rig reaches 0.19 over the sharp exit that its response needs
LIMITING_SPEED_FACTOR = 5e5  # rpm · mm, shaft speed times pitch diameter: usual limit of greased bearings
SAME_SPEED = 1e-6  # a nominal cage speed rounded to seven digits is still that of pure rolling
# A path is looked at in so many places; a rough one in at least as many for each of its roughness values or points of
# its table.
PATH_SAMPLES, SAMPLES_PER_KNOT = 4001, 8
PEAK_INSTANTS = 256


def assess(scene: Scene) -> tuple[str, ...]:
    """Clauses with numbers on where `scene` leaves the range of the model; empty where it holds."""
    peak = peak_ball_load(scene)
    forces = (_centrifugal(scene, peak), _ball_inertia(scene, peak), _steps(scene))
    run = (_speed(scene), _cage_speed(scene))
    notes = (*forces, *run, _load(scene, peak), _reversed(scene), _contact_angle(scene))
    return tuple(note for note in notes if note)


def element_mass(bearing: Bearing) -> float:
    """Mass of a steel ball, or of a steel roller of the length that K stands for, kg."""
    radius = bearing.ball_radius
    if is_roller(bearing):
        return STEEL_DENSITY * math.pi * radius**2 * roller_length(bearing.load_deflection)
    return STEEL_DENSITY * 4.0 / 3.0 * math.pi * radius**3


def centrifugal_force(scene: Scene) -> float:
    """Centrifugal force of one ball on its circle at the nominal speed of the faster cage, N."""
    bearing = scene.rig.bearing
    cage = max(path.nominal_speed for path in scene.cages)
    return element_mass(bearing) * bearing.pitch_diameter / 2.0 * cage**2


def inertia_force(scene: Scene, spall: Spall) -> float:
    """Force (N) that takes a ball down, or up, its path over `spall` in the time the path gives it.

    m · 2h/t² for the drop h over the shorter of the times t from entry edge to floor and from floor to exit edge. Where
    a surface that stands proud of the race lifts the ball, which begins beyond the edges, the same for the way up to
    its highest place, if that takes more. Over a rough path, the largest of every way h from one turning point of the
    path to the next in the time t between them.
    """
    bearing = scene.rig.bearing
    way = _steepest_way(spall, bearing)
    return element_mass(bearing) * 2.0 * way.drop * (scene.crossing_speed(spall) / way.arc) ** 2


class Descent(NamedTuple):
    """A ball's way down, or up, by a `drop` (m) over an `arc` (rad) of the race."""

    drop: float
    arc: float


def _steepest_way(spall: Spall, bearing: Bearing) -> Descent:
    """The way that takes the largest force."""
    half = spall.extent / 2.0
    if is_rough(spall, bearing):
        return _steepest_rough_way(spall, bearing)
    if spall.profile == "tukey":
        return Descent(spall.depth, max(min(spall.entry_taper, spall.exit_taper), spall.extent / (PATH_SAMPLES - 1)))
    path = build_path(spall, bearing)
    first, last = path.breaks[[0, -1]].tolist()
    down, up = _way_from_edges(path, -half, half, 1.0), _way_from_edges(path, first, last, -1.0)
    return max(down, up, key=lambda way: way.drop / way.arc**2)


def _way_from_edges(path: DepthPath, first: float, last: float, sense: float) -> Descent:
    """The way from the nearer of two edges (rad) to where the path is deepest between them, or highest with a `sense`
    of −1; no drop over all of the arc if it goes nowhere."""
    arc = np.linspace(first, last, PATH_SAMPLES)
    away = sense * path.depth(arc)
    farthest = float(away.max())
    if farthest <= 0.0:
        return Descent(0.0, last - first)
    there = arc[away >= 0.999 * farthest]
    resolution = (last - first) / (PATH_SAMPLES - 1)
    return Descent(farthest, max(min(float(there[0]) - first, last - float(there[-1])), resolution))


def _steepest_rough_way(spall: Spall, bearing: Bearing) -> Descent:
    """The way between the two neighbouring turning points whose drop over arc squared is largest."""
    samples = max(PATH_SAMPLES, SAMPLES_PER_KNOT * max(len(spall.roughness_values), len(spall.table_depth)))
    arc = np.linspace(-spall.extent / 2.0, spall.extent / 2.0, samples)
    depth = build_path(spall, bearing).depth(arc)
    direction = np.sign(np.diff(depth))
    turning = np.concatenate([[0], np.flatnonzero(np.diff(direction)) + 1, [samples - 1]])
    drop, arcs = np.abs(np.diff(depth[turning])), np.diff(arc[turning])
    steepest = int(np.argmax(drop / arcs**2))
    return Descent(float(drop[steepest]), float(arcs[steepest]))


def peak_ball_load(scene: Scene) -> float:
    """Largest quasi-static load of a ball while the scene lasts, as if there were no spalls, N.

    Over 256 instants; those at which no position carries the load are left out.
    """
    healthy = replace(scene, spalls=())
    rest = equilibrium(healthy, instants_without_period(scene.duration, PEAK_INSTANTS))
    return float(rest.ball_load[rest.status != NO_EQUILIBRIUM].max(initial=0.0))


def _centrifugal(scene: Scene, peak: float) -> str:
    force = centrifugal_force(scene)
    if force <= NEGLIGIBLE_SHARE * peak:
        return ""
    return (
        f"the centrifugal force of a ball ({force:.3g} N) is left out but is {_share(force, peak)} "
        f"the peak ball load ({peak:.3g} N)"
    )


def _ball_inertia(scene: Scene, peak: float) -> str:
    if not scene.spalls:
        return ""
    force = max(inertia_force(scene, spall) for spall in scene.spalls)
    if force <= NEGLIGIBLE_SHARE * peak:
        return ""
    return (
        f"the inertia of a ball on its way over the spall ({force:.3g} N, 2 m h / t^2 of the steepest drop h and its "
        f"time t, at a cosine edge up to 2.5 times that) is left out but is {_share(force, peak)} the peak ball "
        f"load ({peak:.3g} N)"
    )


def _steps(scene: Scene) -> str:
    radial_damping = scene.rig.radial_film_damping
    steps = [
        spall.depth
        for spall in scene.spalls
        if spall.profile == "tukey" and min(spall.entry_taper, spall.exit_taper) == 0.0
    ]
    if radial_damping == 0.0 or max(steps, default=0.0) == 0.0:
        return ""
    return (
        f"an edge without taper is a step that the film does not feel, though over any taper, however short, it gives "
        f"an impulse of {radial_damping * max(steps):.3g} N s (radial damping times depth): a short taper has another "
        f"response"
    )


def _speed(scene: Scene) -> str:
    rpm = in_rpm(scene.operation.shaft_speed)
    factor = rpm * scene.rig.bearing.pitch_diameter * 1e3
    if factor <= LIMITING_SPEED_FACTOR:
        return ""
    return (
        f"shaft speed times pitch diameter is {factor:.3g} rpm mm, above the {LIMITING_SPEED_FACTOR:.3g} rpm mm usual "
        f"for greased bearings ({rpm:.4g} rpm)"
    )


def _cage_speed(scene: Scene) -> str:
    rolling = scene.rig.bearing.cage_speed(scene.operation.shaft_speed)
    cage = max((path.nominal_speed for path in scene.cages), key=lambda speed: abs(speed - rolling))
    if abs(cage - rolling) <= SAME_SPEED * rolling:
        return ""
    return (
        f"the cage turns at a nominal {cage:.4g} rad/s, but without slip the shaft would turn it at {rolling:.4g} "
        "rad/s: ball-pass frequencies counted from the shaft are not those of the balls"
    )


def _load(scene: Scene, peak: float) -> str:
    bearing = scene.rig.bearing
    _, largest = load_range(scene)
    if largest == 0.0 and peak == 0.0:
        return "there is no load (0 N): balls touch only by chance and no quasi-static position is defined"
    rating = static_load_rating(bearing)
    dents = bearing.stribeck_peak_load(rating)
    if largest > rating:
        return (
            f"the load on the shaft ({largest:.4g} N at its largest) exceeds the static rating of the bearing "
            f"({rating:.4g} N), where elements and races are dented"
        )
    if peak > dents:
        return (
            f"the most loaded ball carries {peak:.4g} N, more than at the static rating of the bearing ({dents:.4g} "
            f"N), where elements and races are dented"
        )
    return ""


def _reversed(scene: Scene) -> str:
    load = scene.operation.load
    if load >= 0.0:
        return ""
    return f"the static load is reversed ({load:.4g} N): the load zone is centred at 90 degrees instead of 270"


def _contact_angle(scene: Scene) -> str:
    angle = scene.rig.bearing.contact_angle
    if math.sin(angle) <= NEGLIGIBLE_SHARE:  # the axial part of the force on every ball
        return ""
    return (
        f"the contact angle of {math.degrees(angle):.4g} degrees enters only as a factor {math.cos(angle):.4g} on "
        "deflection and force: axial motion and its change under load are left out"
    )


def _share(force: float, peak: float) -> str:
    return f"{force / peak:.2g} times" if peak > 0.0 else "not small beside"
