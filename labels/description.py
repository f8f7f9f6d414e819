"""The physical labels of a scene: what is broken, how far, and how the machine is run."""

from __future__ import annotations

import math

import numpy as np

from labels.schema import HEALTHY
from physics.angular_speed import in_rpm
from physics.bearing import Bearing
from physics.cage import CagePath
from physics.paths.profile import build_path
from physics.scene import Scene
from physics.spall import Spall, is_extended
from physics.validity import assess

SIZES = ("extent", "extent_mm", "extent_spacing", "depth", "path_depth", "entry_taper", "exit_taper", "roughness")
NO_SPALL: dict[str, object] = dict.fromkeys(SIZES, 0.0) | {"bridged": False, "profile": "none"}
# Of Gauss: they integrate a polynomial of the seventh degree exactly.
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)


def label_values(scene: Scene) -> dict[str, object]:
    """Values of every label whose source is "scene", keyed by its name, in the unit of the schema."""
    bearing, run = scene.rig.bearing, scene.operation
    return {
        "rig": scene.rig.name,
        "bearing": bearing.name,
        **defect_values(scene),
        "speed_rpm": in_rpm(run.shaft_speed),
        "load_n": run.load,
        **slip_values(scene.cage),
        "contact_law": scene.contact_law,
        "balls": bearing.balls,
        "rows": bearing.rows,
        "pitch_diameter": bearing.pitch_diameter,
        "ball_diameter": bearing.ball_diameter,
        "contact_angle": bearing.contact_angle,
        "bpfo": bearing.bpfo,
        "bpfi": bearing.bpfi,
        "bsf": bearing.bsf,
        "ftf": bearing.ftf,
        "validity": "; ".join(assess(scene)),
    }


def largest_spall(scene: Scene) -> Spall | None:
    """The spall of the largest extent, the first of equals; None if there is none."""
    return max(scene.spalls, key=lambda spall: spall.extent, default=None)


def condition(scene: Scene) -> str:
    """ "healthy", "line" or "extended": the last if the largest spall always holds at least one ball."""
    spall = largest_spall(scene)
    if spall is None:
        return HEALTHY
    return spall_condition(spall.extent, scene.rig.bearing)


def spall_condition(extent: float, bearing: Bearing) -> str:
    """ "line" or "extended" for a spall of that `extent` (rad)."""
    return "extended" if is_extended(extent, bearing) else "line"


def defect_values(scene: Scene) -> dict[str, object]:
    """The labels that describe the largest spall; zeros, False and "none" when there is none."""
    spall, bearing = largest_spall(scene), scene.rig.bearing
    common = {"condition": condition(scene), "location": scene.defective_race, "spalls": len(scene.spalls)}
    if spall is None:
        return common | NO_SPALL
    path = build_path(spall, bearing)
    return common | {
        "extent": spall.extent,
        "extent_mm": spall.length(bearing) * 1e3,
        "extent_spacing": spall.extent / bearing.spacing,
        "depth": spall.floor_depth,
        "path_depth": path.largest_depth,
        "bridged": path.bridged,
        "entry_taper": spall.entry_taper,
        "exit_taper": spall.exit_taper,
        "roughness": spall.roughness,
        "profile": spall.profile,
    }


def slip_values(cage: CagePath) -> dict[str, float]:
    """Mean and standard deviation of a cage's slip from t = 0 to the end, as shares of its speed without slip."""
    if not cage.knot_values:
        return {"mean_slip": cage.mean_slip, "slip_deviation": 0.0}
    start, end = cage.angle(np.array([0.0, cage.duration]))
    mean = 1.0 - (end - start) / (cage.duration * cage.nominal_speed)
    # Slip is a cubic between knots, so that four points give its square exactly.
    inner = cage.knot_times[(cage.knot_times > 0.0) & (cage.knot_times < cage.duration)]
    edges = np.concatenate([[0.0], inner, [cage.duration]])
    half = np.diff(edges)[:, None] / 2.0
    slip = 1.0 - cage.speed(edges[:-1, None] + half * (1.0 + POINTS)) / cage.nominal_speed
    variance = float((half * WEIGHTS * (slip - mean) ** 2).sum()) / cage.duration
    return {"mean_slip": float(mean), "slip_deviation": math.sqrt(variance)}
