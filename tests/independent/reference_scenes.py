"""The reference scenes as scenario dictionaries, typed from the paper's tables; imports nothing of ours."""

from __future__ import annotations

from typing import Any

import numpy as np

# Petersen et al. (2014), Table 1 and section 5: Koyo 1205 double-row ball bearing, 7 Hz, 346 N.
GEARBOX: dict[str, Any] = {
    "Nb": 12, "rows": 2, "Dp": 38.75e-3, "Db": 7.12e-3, "alpha": 0.0, "K": 5157e6, "n": 1.5, "c": 0.0,
    "m_i": 0.5134, "m_o": 10.268, "m_r": 0.5, "k_ox": 17.7e6, "k_oy": 17.7e6, "c_ox": 673.8, "c_oy": 673.8,
    "k_r": 2094.0e6, "c_r": 317.3, "c_d": 100.0, "omega_s": 2 * np.pi * 7.0, "W": 346.0,
}  # fmt: skip
# Petersen et al. (2014), Table 2 and section 6: Nachi 2206GK double-row ball bearing, 800 rpm, 100 N, clearance 3 um.
FAN: dict[str, Any] = {
    "Nb": 14, "rows": 2, "Dp": 45e-3, "Db": 8e-3, "alpha": 0.0, "K": 10.1e9, "n": 1.5, "c": 3e-6,
    "m_i": 2.0, "m_o": 2.5, "m_r": 0.1, "k_ox": 262.8e6, "k_oy": 262.8e6, "c_ox": 2050.4, "c_oy": 2050.4,
    "k_r": 371.5e6, "c_r": 365.7, "c_d": 150.0, "omega_s": 2 * np.pi * 800.0 / 60.0, "W": 100.0,
}  # fmt: skip
LINE_EXTENT_DEG = {"G": 2.0, "F": 2.6}
DEEP_GAP_M = 0.3e-3
CUT_OFF_M = 0.2e-3
REFERENCE_SCENES = ("G0", "G1", "G1s", "G1p", "G2", "G2r", "F0", "F1", "F1s", "F1p", "F2", "F2r")


def race_radius(parameters: dict[str, Any], race: str) -> float:
    """Radius of a raceway at the contact, m."""
    shift = parameters["Db"] * np.cos(parameters["alpha"])
    return float((parameters["Dp"] + shift if race == "outer" else parameters["Dp"] - shift) / 2)


def outer_defect(extent_deg: float, depth: float, entry_deg: float, exit_deg: float) -> dict[str, Any]:
    """A Tukey spall on row 1 of the outer race, centred in the load zone."""
    return {
        "race": "outer",
        "row": 1,
        "phi_f": 1.5 * np.pi,
        "extent": np.radians(extent_deg),
        "depth": depth,
        "entry_taper": np.radians(entry_deg),
        "exit_taper": np.radians(exit_deg),
        "profile": "tukey",
        "roughness": 0.0,
        "roughness_values": [],
        "table_angle": [],
        "table_depth": [],
    }


def rough_values(length: float, deviation: float, seed: int) -> list[float]:
    """Heights (m) at equal steps over `length`: random, without waves below CUT_OFF_M, zero at both ends."""
    count = int(np.ceil(length / (CUT_OFF_M / 5))) + 1
    x = np.linspace(0.0, length, count)
    spectrum = np.fft.rfft(np.random.default_rng(seed).uniform(-1.0, 1.0, 4 * count))
    spectrum[np.fft.rfftfreq(4 * count, x[1]) > 1.0 / CUT_OFF_M] = 0.0
    heights = np.fft.irfft(spectrum, 4 * count)[count : 2 * count]
    ramp = np.clip(np.minimum(x, length - x) / CUT_OFF_M, 0.0, 1.0)
    heights = (heights - heights.mean()) * (1.0 - np.cos(np.pi * ramp)) / 2
    return [float(h) for h in heights * deviation / heights.std()]


def reference_defects(name: str, parameters: dict[str, Any], seed: int) -> list[dict[str, Any]]:
    """The spall of a reference scene, or none."""
    extent, kind = LINE_EXTENT_DEG[name[0]], name[1:]
    if kind == "0":
        return []
    if kind in ("1", "1s"):
        entry, leave = (0.3, 0.3) if kind == "1" else (0.9 * extent, 0.1 * extent)
        return [outer_defect(extent, 12e-6, entry, leave)]
    if kind == "1p":
        return [outer_defect(extent, DEEP_GAP_M, 0.0, 0.0) | {"profile": "ball_path"}]
    if kind == "2":
        return [outer_defect(40.0, 4e-6, 1.0, 1.0)]
    values = rough_values(np.radians(40.0) * race_radius(parameters, "outer"), 2e-6, seed)
    return [outer_defect(40.0, 6e-6, 1.0, 1.0) | {"roughness": 2e-6, "roughness_values": values}]


def constant_slip(parameters: dict[str, Any]) -> dict[str, Any]:
    """A cage that turns at its nominal speed."""
    ratio = parameters["Db"] * np.cos(parameters["alpha"]) / parameters["Dp"]
    return {
        "nominal_speed": 0.5 * parameters["omega_s"] * (1.0 - ratio),
        "mean_slip": 0.0,
        "deviation": 0.0,
        "correlation_time_s": 0.0,
        "knot_start_s": 0.0,
        "knot_step_s": 0.0,
        "knots": [],
    }


def random_slip(parameters: dict[str, Any], deviation: float, duration: float, seed: int) -> dict[str, Any]:
    """A cage whose speed wanders with a correlation time of one nominal ball pass."""
    slip = constant_slip(parameters)
    correlation_time = 2 * np.pi / slip["nominal_speed"] / parameters["Nb"]
    step = correlation_time / 4
    count = int(np.ceil(duration / step)) + 6
    noise = np.random.default_rng(seed).standard_normal(count) * deviation
    knots = [noise[0]]
    for value in noise[1:]:
        knots.append(np.exp(-0.25) * knots[-1] + np.sqrt(1 - np.exp(-0.5)) * value)
    chosen = {"deviation": deviation, "correlation_time_s": correlation_time, "knots": [float(k) for k in knots]}
    return slip | chosen | {"knot_start_s": -2 * step, "knot_step_s": step}


def reference_scene_json(
    name: str, duration: float = 0.5, rate: float = 65536.0, seed: int = 0, slip_deviation: float = 0.0
) -> dict[str, Any]:
    """The scenario of a reference scene; `seed` chooses the roughness of G2r and F2r, and the slip if there is any."""
    machine = dict(GEARBOX if name[0] == "G" else FAN)
    defects = reference_defects(name, machine, seed)
    largest = defects[0] if defects else {}
    named = ("phi_f", "extent", "depth", "entry_taper", "exit_taper", "roughness")
    slip = random_slip(machine, slip_deviation, duration, seed) if slip_deviation else constant_slip(machine)
    still = {"unbalance_force": 0.0, "unbalance_phase": 0.0, "load_fluctuation": 0.0, "fluctuation_phase": 0.0}
    turned = {"phi_c0": 0.0, "row_offset": np.pi / machine["Nb"]}
    return {
        "format": "spallgen scenario 1",
        "parameters": machine | turned | {key: largest.get(key, 0.0) for key in named} | still,
        "contact_law": "paper",
        "sampling": {"rate_hz": rate, "duration_s": duration},
        "slip": slip,
        "second_cage": None,
        "defects": defects,
        "waviness": [],
        "ball_deviation": [],
    }
