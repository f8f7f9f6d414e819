"""The JSON text of a scenario: the paper's symbols, SI units, exact floats; enough to make the record again."""

from __future__ import annotations

import json
import zlib
from dataclasses import fields
from typing import Any

from datagen.errors import BadInput
from datagen.scenarios.accuracy import Accuracy
from datagen.scenarios.refused import Redraw
from datagen.scenarios.sampling_text import sampling_data
from datagen.scenarios.scenario import Scenario, Seeds
from datagen.scenarios.sensor_text import background_data, background_of, chain_data, chain_of
from datagen.scenarios.streams import PURPOSES, RULE, SCOPES
from labels.description import largest_spall
from physics.bearing import Bearing
from physics.cage import INTERPOLATION_RULE, CagePath
from physics.imperfections import Imperfections, Waviness
from physics.operation import Operation
from physics.rig import Rig
from physics.scene import Scene
from physics.spall import Spall

# The second is of records that do not begin at rest, so that nobody who knows the first alone replays them wrongly.
FORMATS = AT_REST, SETTLED = "spallgen scenario 1", "spallgen scenario 2"
# Keys of the flat `parameters` and the fields that they hold.
BEARING_KEYS = {
    "Nb": "balls",
    "rows": "rows",
    "Dp": "pitch_diameter",
    "Db": "ball_diameter",
    "alpha": "contact_angle",
    "K": "load_deflection",
    "n": "exponent",
    "c": "clearance",
}
RIG_KEYS = {
    "m_i": "inner_mass",
    "m_o": "outer_mass",
    "m_r": "resonator_mass",
    "k_ox": "support_stiffness_x",
    "k_oy": "support_stiffness_y",
    "c_ox": "support_damping_x",
    "c_oy": "support_damping_y",
    "k_r": "resonator_stiffness",
    "c_r": "resonator_damping",
    "c_d": "film_damping",
}
OPERATION_KEYS = {
    "omega_s": "shaft_speed",
    "W": "load",
    "unbalance_force": "unbalance_force",
    "unbalance_phase": "unbalance_phase",
    "load_fluctuation": "load_fluctuation",
    "fluctuation_phase": "fluctuation_phase",
}
SPALL_KEYS = {
    "phi_f": "angle",
    "extent": "extent",
    "depth": "depth",
    "entry_taper": "entry_taper",
    "exit_taper": "exit_taper",
    "roughness": "roughness",
}
BEARING_DETAILS = ("inner_conformity", "outer_conformity")
RIG_DETAILS = ("rated_speed", "rated_load")
TRAVEL = (
    "u runs in the direction of travel from the entry edge -extent/2 to the exit edge +extent/2: u = phi - phi_f for "
    "an outer spall, which is fixed; u = phi_f(t) - phi for an inner one, with phi_f(t) = phi_f + omega_s t; "
    "both modulo a turn, nearest to 0; "
)
WINDOW = (
    "depth * w(u) + r(u): w rises as (1 - cos(pi (u + extent/2) / entry_taper)) / 2 over the entry taper, is 1, and "
    "falls likewise over the exit taper (a zero taper is a step of no slope: "
    "the film damping c_d feels nothing of it, unlike of ever shorter tapers); r is the natural cubic spline through "
    "roughness_values at equal steps of u over the spall; zero outside the spall"
)
ROLLED = (
    "the path of a ball rolled over the surface s. Outer race: rho(phi) = min over theta of R cos(theta - phi) - "
    "sqrt(Rb^2 - R^2 sin(theta - phi)^2) with R(theta) = Ro + s(theta), path = rho - (Ro - Rb). Inner race: rho(phi) = "
    "max of R cos(theta - phi) + sqrt(Rb^2 - R^2 sin(theta - phi)^2) with R(theta) = Ri - s(theta), "
    "path = Ri + Rb - rho. Ro, Ri = (Dp +- Db cos(alpha)) / 2, Rb = Db / 2. Bumps proud of the race (s below 0) lift "
    "the ball beyond the edges of the spall too. Sought on a grid over a rough surface, the extremum needs steps of "
    "0.3 um along the race: with 1 um the response was 4e-4 of its RMS off; a table of the path that is read linearly "
    "needs nodes 0.1 um apart"
)
RULES = {
    "tukey": f"{TRAVEL}the ball's centre drops by {WINDOW}",
    "ball_path": f"{TRAVEL}the surface drops by {WINDOW}; the ball's centre follows {ROLLED}",
    "table": "the surface drops by table_depth, linear over table_angle, which is measured from phi_f in the direction "
    f"of increasing phi; zero outside; the ball's centre follows {ROLLED}",
}

BALANCE = (
    ": the elastic forces K delta^n alone, without c_d, carry the load; the supports carry it too, with (xo, yo) = "
    "load / (k_ox, k_oy), and the resonator stands where the outer ring does; without load and with clearance, where "
    "nothing holds the shaft, all displacements are zero"
)
SCENE_RULES = {
    "ball_angle": "ball j (from 1) of row r (from 1) is at phi = cage angle + 2 pi (j - 1) / Nb + (r - 1) row_offset; "
    "with separate cages row 2 takes the angle of second_cage, start_angle at t = 0, and keeps its row_offset",
    "compression": "along the contact normal: (dx cos phi + dy sin phi - depth - c) cos(alpha) + "
    "ball_deviation[r - 1][j - 1], with (dx, dy) inner ring minus outer ring; depth is the sum of the drops of all "
    "spalls on the row, each by itself, and of the waviness; the radial force is the normal force times cos(alpha)",
    "contact": "a ball whose compression delta is above 0 presses with the normal force K delta^n + c_d delta', any "
    "other with none; delta' is the total time derivative: (dx, dy), phi with the cage's speed, slip included, and the "
    "depth under the ball as ball and race move all count; by the contact_law paper this force may pull, by no_tension "
    "it is 0 where the sum is negative",
    "motion": "m_i (xi, yi)'' = loads - S with S the sum of radial force times (cos phi, sin phi) over all balls; "
    "m_o (xo, yo)'' = S - (k_ox xo + c_ox xo', k_oy yo + c_oy yo') - L; m_r (xr, yr)'' = L = k_r (xo - xr, yo - yr) + "
    "c_r (xo' - xr', yo' - yr'); the acceleration is (xr, yr)''",
    "waviness": "each adds amplitude cos(order (phi - race angle) + phase) to the depth on every row; race angle is 0 "
    "on the outer race and omega_s t on the inner one",
    "loads": "on the inner ring: -W (1 + load_fluctuation cos(omega_s t + fluctuation_phase)) along y, and "
    "unbalance_force (cos, sin)(omega_s t + unbalance_phase)",
    "start": f"at rest in equilibrium under the load vector of t = 0, velocities zero{BALANCE}",
}
SETTLED_START = (
    f"at rest in equilibrium under the load vector of t = -settle_s, velocities zero{BALANCE}; the modes and the "
    "mounting of the chain are at rest then, too; the simulated instants begin there, and whatever depends on t holds "
    "for negative t too; the record has the samples from t = 0 on"
)


def scenario_json(scenario: Scenario) -> str:
    """One JSON object; the same scenario always gives the same text."""
    return json.dumps(_to_data(scenario), allow_nan=False, separators=(",", ":"))


def scenario_of(text: str) -> Scenario:
    """The scenario of a text written by `scenario_json`; raises BadInput if it is not one."""
    try:
        data = json.loads(text)
        found = data["format"]
        if found not in FORMATS:
            raise BadInput(field="format", value=found, allowed=", ".join(FORMATS))
        return _from_data(data)
    except (KeyError, IndexError, AttributeError, TypeError, ValueError, zlib.error) as error:
        raise BadInput(f"not the text of a scenario ({type(error).__name__}: {error})") from None


def _to_data(scenario: Scenario) -> dict[str, Any]:
    scene = scenario.scene
    bearing, rig = scene.rig.bearing, scene.rig
    return {
        "format": SETTLED if scenario.settle > 0.0 else AT_REST,
        "record": scenario.record,
        "part": scenario.part,
        "split": scenario.split,
        "rig": rig.name,
        "bearing": bearing.name,
        "bearing_id": scenario.bearing_id,
        "condition": scenario.condition,
        "location": scenario.location,
        "parameters": _parameters(scene),
        "bearing_details": {"row_offset_given": bearing.row_offset is not None}
        | {name: getattr(bearing, name) for name in BEARING_DETAILS},
        "rig_details": {name: getattr(rig, name) for name in RIG_DETAILS},
        "contact_law": scene.contact_law,
        "sampling": sampling_data(scenario),
        "accuracy": vars(scenario.accuracy),
        "slip": _slip(scene.cage, scenario),
        "second_cage": scene.second_cage
        and {"start_angle": scene.second_cage.start_angle} | _slip(scene.second_cage, scenario),
        "defects": [_defect(spall) for spall in scene.spalls],
        "waviness": [vars(wave) for wave in scene.imperfections.waviness],
        "ball_deviation": [list(row) for row in scene.imperfections.ball_deviation],
        "chain": chain_data(scenario.chain),
        "background": background_data(scenario),
        "seeds": vars(scenario.seeds) | {"rule": RULE, "scopes": list(SCOPES), "purposes": list(PURPOSES)},
        "redraws": [vars(redraw) for redraw in scenario.redraws],
        "rules": SCENE_RULES | ({"start": SETTLED_START} if scenario.settle > 0.0 else {}),
    }


def _parameters(scene: Scene) -> dict[str, float]:
    spall = largest_spall(scene)
    return (
        _read(scene.rig.bearing, BEARING_KEYS)
        | {"phi_c0": scene.cage.start_angle, "row_offset": scene.rig.bearing.stagger}
        | _read(scene.rig, RIG_KEYS)
        | _read(scene.operation, OPERATION_KEYS)
        | (dict.fromkeys(SPALL_KEYS, 0.0) if spall is None else _read(spall, SPALL_KEYS))
    )


def _read(owner: object, keys: dict[str, str]) -> dict[str, float]:
    return {key: getattr(owner, field) for key, field in keys.items()}


def _slip(cage: CagePath, scenario: Scenario) -> dict[str, Any]:
    return {
        "nominal_speed": cage.nominal_speed,
        "mean_slip": cage.mean_slip,
        "deviation": scenario.slip_deviation,
        "correlation_time_s": scenario.slip_correlation_time,
        "knot_start_s": cage.knot_start,
        "knot_step_s": cage.knot_step,
        "knots": list(cage.knot_values),
        "interpolation": INTERPOLATION_RULE,
    }


def _defect(spall: Spall) -> dict[str, Any]:
    values = {
        "race": spall.race,
        "row": spall.row,
        **_read(spall, SPALL_KEYS),
        "profile": spall.profile,
        "roughness_values": list(spall.roughness_values),
        "table_angle": list(spall.table_angle),
        "table_depth": list(spall.table_depth),
    }
    return values | {"rule": RULES[spall.profile]}


def _from_data(data: dict[str, Any]) -> Scenario:
    slip, sampling = data["slip"], data["sampling"]
    return Scenario(
        scene=_scene(data),
        rate=sampling["rate_hz"],
        settle=sampling.get("settle_s", 0.0),
        seeds=Seeds(**{field.name: data["seeds"][field.name] for field in fields(Seeds)}),
        part=data["part"],
        bearing_id=data["bearing_id"],
        split=data["split"],
        envelope_band=(sampling["envelope_band_hz"][0], sampling["envelope_band_hz"][1]),
        slip_deviation=slip["deviation"],
        slip_correlation_time=slip["correlation_time_s"],
        chain=chain_of(data["chain"]),
        redraws=tuple(Redraw(**redraw) for redraw in data["redraws"]),
        # Texts from before accuracy was a setting mean the usual one.
        accuracy=Accuracy(**data.get("accuracy", {})),
        **background_of(data["background"]),
    )


def _scene(data: dict[str, Any]) -> Scene:
    parameters, second = data["parameters"], data["second_cage"]
    duration = data["sampling"]["duration_s"]
    return Scene(
        rig=_rig(data, parameters),
        operation=Operation(**_fields(parameters, OPERATION_KEYS)),
        cage=_cage(data["slip"], parameters["phi_c0"], duration),
        spalls=tuple(_spall(defect) for defect in data["defects"]),
        imperfections=Imperfections(
            waviness=tuple(Waviness(**wave) for wave in data["waviness"]),
            ball_deviation=tuple(tuple(row) for row in data["ball_deviation"]),
        ),
        contact_law=data["contact_law"],
        second_cage=_cage(second, second["start_angle"], duration) if second else None,
    )


def _fields(values: dict[str, Any], keys: dict[str, str]) -> dict[str, Any]:
    return {field: values[key] for key, field in keys.items()}


def _rig(data: dict[str, Any], parameters: dict[str, Any]) -> Rig:
    details = data["bearing_details"]
    bearing = Bearing(
        name=data["bearing"],
        row_offset=parameters["row_offset"] if details["row_offset_given"] else None,
        **{name: details[name] for name in BEARING_DETAILS},
        **_fields(parameters, BEARING_KEYS),
    )
    numbers = _fields(parameters, RIG_KEYS) | {name: data["rig_details"][name] for name in RIG_DETAILS}
    return Rig(name=data["rig"], bearing=bearing, **numbers)


def _cage(slip: dict[str, Any], start_angle: float, duration: float) -> CagePath:
    return CagePath(
        nominal_speed=slip["nominal_speed"],
        duration=duration,
        start_angle=start_angle,
        mean_slip=slip["mean_slip"],
        knot_step=slip["knot_step_s"],
        knot_start=slip["knot_start_s"],
        knot_values=tuple(slip["knots"]),
    )


def _spall(defect: dict[str, Any]) -> Spall:
    return Spall(
        race=defect["race"],
        row=defect["row"],
        profile=defect["profile"],
        roughness_values=tuple(defect["roughness_values"]),
        table_angle=tuple(defect["table_angle"]),
        table_depth=tuple(defect["table_depth"]),
        **_fields(defect, SPALL_KEYS),
    )
