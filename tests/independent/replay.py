"""Simulate a stored record again from its scenario text alone, with numpy, scipy and numba only.

    python replay.py SCENARIO.json OUT.npz

Nothing of the generating packages is imported: this is an independent reading of the model and shows how to read a
`scenario`. All numbers are SI; angles run counter-clockwise from +x, the static load points along -y, and displacements
are (xi, yi, xo, yo, xr, yr). OUT.npz holds `time` (T,), `acceleration` (T, 2) of the resonator, `state` (T, 12) and
`contact_force` (T, rows, balls). The method is the plainest: ball-by-ball sums, Runge-Kutta of order 4, many steps.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]
Defect = dict[str, Any]

SUBSTEPS = 64
SAMPLES_PER_BLOCK = 256
SURFACE_STEP = 0.5e-6  # m along the race between samples of a rolled surface
PATH_STEP = 0.25e-6  # m along the race between samples of a hand-set path
REACH = 0.5e-3  # m beyond the edges where a bump in the spall can still lift the ball
NUMBERS = ("K", "n", "c", "c_d", "m_i", "m_o", "m_r", "k_ox", "k_oy", "c_ox", "c_oy", "k_r", "c_r", "omega_s", "W")
LOADS = ("unbalance_force", "unbalance_phase", "load_fluctuation", "fluctuation_phase")


class Machine(NamedTuple):
    """What the equations of motion need: numbers under the scenario's own keys, and arrays."""

    K: float
    n: float
    c: float
    c_d: float
    m_i: float
    m_o: float
    m_r: float
    k_ox: float
    k_oy: float
    c_ox: float
    c_oy: float
    k_r: float
    c_r: float
    omega_s: float
    W: float
    unbalance_force: float
    unbalance_phase: float
    load_fluctuation: float
    fluctuation_phase: float
    cos_alpha: float
    may_pull: bool
    ball_offset: Array  # (rows, balls) angle of each ball ahead of its cage
    ball_deviation: Array  # (rows, balls) diameter minus nominal
    spall: Array  # (spalls, 5) row index, centre at t = 0, travel sign, first u of its table, step of u
    spall_start: NDArray[np.int64]  # (spalls + 1,) where the samples of each spall begin in the two arrays below
    path: Array  # depth of the ball's path over u, all spalls one after the other
    slope: Array  # its derivative by u
    waviness: Array  # (terms, 4) 1 if inner, order, amplitude, phase


def read_machine(scenario: dict[str, Any]) -> Machine:
    """Everything but the cage's path, from a parsed scenario."""
    p = scenario["parameters"]
    shape = rows, balls = int(p["rows"]), int(p["Nb"])
    tables = [tabulate_spall(defect, p) for defect in scenario["defects"]]
    waves = [(w["race"] == "inner", w["order"], w["amplitude"], w["phase"]) for w in scenario["waviness"]]
    return Machine(
        **{key: float(p[key]) for key in NUMBERS + LOADS},
        cos_alpha=float(np.cos(p["alpha"])),
        may_pull={"paper": True, "no_tension": False}[scenario["contact_law"]],
        ball_offset=2 * np.pi * np.arange(balls)[None, :] / balls + p["row_offset"] * np.arange(rows)[:, None],
        ball_deviation=np.array(scenario["ball_deviation"] or np.zeros(shape), dtype=float),
        spall=np.array([place for place, _, _ in tables], dtype=float).reshape(-1, 5),
        spall_start=np.cumsum([0] + [path.size for _, path, _ in tables]),
        path=np.concatenate([np.zeros(0)] + [path for _, path, _ in tables]),
        slope=np.concatenate([np.zeros(0)] + [slope for _, _, slope in tables]),
        waviness=np.array(waves, dtype=float).reshape(-1, 4),
    )


def cage_path(slip: dict[str, Any], start_angle: float) -> tuple[Any, Any]:
    """Functions angle(t) and speed(t) of a cage: nominal speed times (1 - mean slip + spline through the knots), whose
    last value goes on behind it."""
    nominal, knots = slip["nominal_speed"], np.array(slip["knots"], dtype=float)
    mean = nominal * (1.0 - slip["mean_slip"])
    if knots.size == 0:
        return lambda t: start_angle + mean * t, lambda t: np.full_like(t, mean)
    spline = CubicSpline(slip["knot_start_s"] + slip["knot_step_s"] * np.arange(knots.size), knots, bc_type="natural")
    slipped, last = spline.antiderivative(), spline.x[-1]

    def slip_until(t: Array) -> Any:
        known = np.minimum(t, last)
        return slipped(known) + spline(last) * (t - known)

    return (
        lambda t: start_angle + mean * t + nominal * (slip_until(t) - slip_until(np.zeros(()))),
        lambda t: mean + nominal * spline(np.minimum(t, last)),
    )


def tabulate_spall(defect: Defect, p: dict[str, Any]) -> tuple[list[float], Array, Array]:
    """Place, path and slope of one spall over u, the angle in the direction of travel measured from its centre."""
    outer, rolled, half = defect["race"] == "outer", defect["profile"] != "tukey", defect["extent"] / 2
    race_radius = (p["Dp"] + (1.0 if outer else -1.0) * p["Db"] * np.cos(p["alpha"])) / 2
    cells = int(np.ceil(2 * half * race_radius / (SURFACE_STEP if rolled else PATH_STEP)))
    step = 2 * half / cells
    beyond = int(np.ceil(REACH / race_radius / step)) if rolled else 0
    u = step * np.arange(-beyond, cells + beyond + 1) - half
    depth, slope = designed_depth(u, defect, half)
    if defect["profile"] == "table":
        depth = np.interp(u if outer else -u, defect["table_angle"], defect["table_depth"], left=0.0, right=0.0)
    if rolled:  # at a step the sound side carries the ball, hence the zero at and beyond both edges
        surface = np.where(np.abs(u) < half * (1 - 1e-12), depth, 0.0)
        depth = roll_ball(u, surface, race_radius, p["Db"] / 2, outer)
        slope = np.gradient(depth, step)
    return [defect["row"] - 1, defect["phi_f"], 1.0 if outer else -1.0, u[0], step], depth, slope


def designed_depth(u: Array, defect: Defect, half: float) -> tuple[Array, Array]:
    """Tapered window of height `depth` plus roughness, and the slope; a zero taper is a step without slope."""
    depth, slope = np.full(u.shape, float(defect["depth"])), np.zeros(u.shape)
    for taper, from_edge, sign in ((defect["entry_taper"], u + half, 1.0), (defect["exit_taper"], half - u, -1.0)):
        if taper > 0.0:
            on = from_edge < taper
            phase = np.pi * from_edge[on] / taper
            depth[on] = defect["depth"] * (1 - np.cos(phase)) / 2
            slope[on] = sign * defect["depth"] * np.pi / taper * np.sin(phase) / 2
    if len(defect["roughness_values"]):
        knots = np.linspace(-half, half, len(defect["roughness_values"]))
        spline = CubicSpline(knots, defect["roughness_values"], bc_type="natural")
        depth, slope = depth + spline(u), slope + spline(u, 1)
    return depth, slope


@njit
def roll_ball(u: Array, surface: Array, race_radius: float, ball_radius: float, outer: bool) -> Array:
    """Depth of the path of the centre of a ball rolled over the sampled surface: every sample holds the ball off."""
    inward = 1.0 if outer else -1.0
    path = np.zeros(u.size)
    range_of_depth = surface.max() - min(surface.min(), 0.0)
    width = int(3 * np.sqrt(ball_radius * range_of_depth) / race_radius / (u[1] - u[0])) + 2
    for i in range(u.size):
        smallest = surface[i]
        for k in range(max(0, i - width), min(u.size, i + width + 1)):
            radius = race_radius + inward * surface[k]
            across = radius * np.sin(u[k] - u[i])
            if abs(across) < ball_radius:
                height = np.sqrt(ball_radius**2 - across**2)
                centre = radius * np.cos(u[k] - u[i]) - inward * height
                smallest = min(smallest, inward * (centre - race_radius) + ball_radius)
        path[i] = smallest
    return path


@njit(inline="always")
def relief(m: Machine, row: int, phi: float, phi_speed: float, t: float) -> tuple[float, float]:
    """Radial depth met by a ball at angle phi of a row, and its rate of change as the ball and the race move."""
    depth, rate = 0.0, 0.0
    for s in range(m.spall.shape[0]):
        if m.spall[s, 0] != row:
            continue
        sign = m.spall[s, 2]
        race_speed = 0.0 if sign > 0.0 else m.omega_s
        u = sign * (phi - m.spall[s, 1] - race_speed * t)
        u -= 2 * np.pi * np.floor(u / (2 * np.pi) + 0.5)
        place = (u - m.spall[s, 3]) / m.spall[s, 4]
        if 0.0 <= place < m.spall_start[s + 1] - m.spall_start[s] - 1:
            part = place - int(place)
            k = m.spall_start[s] + int(place)
            depth += m.path[k] + part * (m.path[k + 1] - m.path[k])
            rate += (m.slope[k] + part * (m.slope[k + 1] - m.slope[k])) * sign * (phi_speed - race_speed)
    for w in range(m.waviness.shape[0]):
        race_speed = m.waviness[w, 0] * m.omega_s
        order, amplitude = m.waviness[w, 1], m.waviness[w, 2]
        phase = order * (phi - race_speed * t) + m.waviness[w, 3]
        depth += amplitude * np.cos(phase)
        rate -= amplitude * order * np.sin(phase) * (phi_speed - race_speed)
    return depth, rate


@njit
def contact_sum(m: Machine, z: Array, t: float, cage: Array, speed: Array, force: Array) -> tuple[float, float]:
    """Net force of the balls on the outer ring along x and y; the normal force of each ball goes into `force`."""
    dx, dy, vx, vy = z[0] - z[2], z[1] - z[3], z[6] - z[8], z[7] - z[9]
    sum_x, sum_y = 0.0, 0.0
    for row in range(m.ball_offset.shape[0]):
        for ball in range(m.ball_offset.shape[1]):
            phi = cage[row] + m.ball_offset[row, ball]
            cos, sin = np.cos(phi), np.sin(phi)
            depth, rate = relief(m, row, phi, speed[row], t)
            delta = (dx * cos + dy * sin - depth - m.c) * m.cos_alpha + m.ball_deviation[row, ball]
            force[row, ball] = 0.0
            if delta > 0.0:
                closing = (vx * cos + vy * sin + speed[row] * (dy * cos - dx * sin) - rate) * m.cos_alpha
                spring = delta * np.sqrt(delta) if m.n == 1.5 else delta**m.n
                normal = m.K * spring + m.c_d * closing
                if m.may_pull or normal > 0.0:
                    force[row, ball] = normal
                    sum_x += normal * m.cos_alpha * cos
                    sum_y += normal * m.cos_alpha * sin
    return sum_x, sum_y


@njit
def external_load(m: Machine, t: float) -> tuple[float, float]:
    """Force on the inner ring along x and y: static load with its fluctuation, and unbalance."""
    weight = m.W * (1.0 + m.load_fluctuation * np.cos(m.omega_s * t + m.fluctuation_phase))
    turned = m.omega_s * t + m.unbalance_phase
    return m.unbalance_force * np.cos(turned), m.unbalance_force * np.sin(turned) - weight


@njit
def derivative(m: Machine, z: Array, t: float, cage: Array, speed: Array, force: Array, out: Array) -> None:
    """Time derivative of the state: six velocities, six accelerations."""
    contact, load = contact_sum(m, z, t, cage, speed, force), external_load(m, t)
    ground, out[:6] = (m.k_ox * z[2] + m.c_ox * z[8], m.k_oy * z[3] + m.c_oy * z[9]), z[6:]
    for axis in range(2):
        link = m.k_r * (z[2 + axis] - z[4 + axis]) + m.c_r * (z[8 + axis] - z[10 + axis])
        out[6 + axis] = (load[axis] - contact[axis]) / m.m_i
        out[8 + axis] = (contact[axis] - ground[axis] - link) / m.m_o
        out[10 + axis] = link / m.m_r


@njit
def runge_kutta(
    m: Machine, z: Array, first: float, h: float, cage: Array, speed: Array, states: Array, forces: Array
) -> None:
    """Carry z on from `first` in steps of h, noting z and forces; cage and speed (2 steps + 1, rows) at half steps."""
    k1, k2, k3, k4 = np.empty(12), np.empty(12), np.empty(12), np.empty(12)
    spare, substeps = np.empty_like(m.ball_offset), cage.shape[0] // 2 // states.shape[0]
    for step in range(cage.shape[0] // 2):
        t, a, b, c = first + step * h, 2 * step, 2 * step + 1, 2 * step + 2
        derivative(m, z, t, cage[a], speed[a], spare, k1)
        if step % substeps == 0:
            states[step // substeps], forces[step // substeps] = z, spare
        derivative(m, z + 0.5 * h * k1, t + 0.5 * h, cage[b], speed[b], spare, k2)
        derivative(m, z + 0.5 * h * k2, t + 0.5 * h, cage[b], speed[b], spare, k3)
        derivative(m, z + h * k3, t + h, cage[c], speed[c], spare, k4)
        z += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def static_displacement(m: Machine, cage: Array, t: float = 0.0) -> Array:
    """Displacement (2,) of the inner against the outer ring where the contacts carry the load of time t at rest.

    The energy of the contacts is convex, so damped Newton steps that lower it end at the equilibrium.
    """
    phi = m.ball_offset + cage[:, None]
    normal = np.stack([np.cos(phi), np.sin(phi)], axis=-1) * m.cos_alpha
    depth = [[relief(m, r, phi[r, j], 0.0, t)[0] for j in range(phi.shape[1])] for r in range(phi.shape[0])]
    free = (np.array(depth) + m.c) * m.cos_alpha - m.ball_deviation
    load = np.array(external_load(m, t))
    size = max(float(np.hypot(*load)), 1e-300)

    def energy(d: Array) -> float:
        return float((m.K / (m.n + 1) * np.maximum(normal @ d - free, 0.0) ** (m.n + 1)).sum() - load @ d)

    d = load / size * (max(free.max(), 0.0) / m.cos_alpha + (size / m.K) ** (1 / m.n))
    for _ in range(200):
        pressed = np.maximum(normal @ d - free, 0.0)
        residual = np.einsum("rj,rjk->k", m.K * pressed**m.n, normal) - load
        if np.hypot(*residual) <= 1e-11 * size:
            break
        hessian = np.einsum("rj,rjk,rjl->kl", m.n * m.K * pressed ** (m.n - 1), normal, normal)
        move = -np.linalg.solve(hessian + 1e-9 * np.trace(hessian) * np.eye(2), residual)
        while energy(d + move) > energy(d) and np.hypot(*move) > 1e-18:
            move = move / 2
        d = d + move
    return d


def initial_state(m: Machine, cage: Array, t: float = 0.0) -> Array:
    """State (12,) at rest at time t: the supports carry the load, the resonator sits still on the outer ring."""
    outer = np.array(external_load(m, t)) / [m.k_ox, m.k_oy]
    return np.concatenate([outer + static_displacement(m, cage, t), outer, outer, np.zeros(6)])


def replay(scenario: dict[str, Any], substeps: int = SUBSTEPS) -> dict[str, Array]:
    """Time, resonator acceleration, state and contact forces of the record that a parsed scenario describes."""
    factor = scenario["sampling"].get("oversampling", 1)
    run = march(scenario, factor, -(-substeps // factor))
    acceleration = lowered(run["acceleration"], scenario)
    lower = {key: run[key][::factor][: acceleration.shape[0]] for key in run} | {"acceleration": acceleration}
    return {key: recorded(lower[key], scenario) for key in lower}


def recorded(signal: Array, scenario: dict[str, Any]) -> Array:
    """What the record has of a `signal` at its rate: nothing from before t = 0."""
    return signal[round(scenario["sampling"].get("settle_s", 0.0) * scenario["sampling"]["rate_hz"]) :]


def lowered(signal: Array, scenario: dict[str, Any]) -> Array:
    """The record's samples of a `signal` (T oversampling + half_length, 2): as it is where the rate was not raised."""
    rule, factor = scenario["sampling"].get("lowering"), scenario["sampling"].get("oversampling", 1)
    if rule is None:
        return signal
    reach = rule["half_length"]
    n = np.arange(-reach, reach + 1)
    taps = np.sinc(rule["cutoff"] * n) * np.i0(rule["kaiser_beta"] * np.sqrt(1.0 - (n / reach) ** 2))
    held = np.concatenate([np.repeat(signal[:1], reach, axis=0), signal])
    windows = [held[first : first + n.size] for first in range(0, signal.shape[0] - reach, factor)]
    return np.array([taps @ window for window in windows]) / taps.sum()


def march(scenario: dict[str, Any], factor: int, substeps: int) -> dict[str, Array]:
    """What `replay` gives, at `factor` times the record's rate, before it is lowered, and from t = -settle_s on to
    where the low-pass looks."""
    m, second = read_machine(scenario), scenario.get("second_cage")
    paths = [cage_path(scenario["slip"], scenario["parameters"]["phi_c0"])] * m.ball_offset.shape[0]
    if second:
        paths[1] = cage_path(second, second["start_angle"])
    rate = factor * scenario["sampling"]["rate_hz"]
    settle = scenario["sampling"].get("settle_s", 0.0)
    samples = factor * round(rate / factor * (scenario["sampling"]["duration_s"] + settle))
    if scenario["sampling"].get("lowering"):
        samples += scenario["sampling"]["lowering"]["half_length"] * factor // scenario["sampling"]["oversampling"]
    z, h = (
        initial_state(m, np.array([float(angle(np.array(-settle))) for angle, _ in paths]), -settle),
        1.0 / rate / substeps,
    )
    states, forces = np.empty((samples, 12)), np.empty((samples, *m.ball_offset.shape))
    for first in range(0, samples, SAMPLES_PER_BLOCK):
        last = min(first + SAMPLES_PER_BLOCK, samples)
        begin = first / rate - settle
        times = begin + 0.5 * h * np.arange(2 * substeps * (last - first) + 1)
        cage = np.stack([angle(times) for angle, _ in paths], axis=-1)
        speed = np.stack([speed(times) for _, speed in paths], axis=-1)
        runge_kutta(m, z, begin, h, cage, speed, states[first:last], forces[first:last])
    link = m.k_r * (states[:, 2:4] - states[:, 4:6]) + m.c_r * (states[:, 8:10] - states[:, 10:12])
    time = np.arange(samples) / rate - settle
    return {"time": time, "acceleration": link / m.m_r, "state": states, "contact_force": forces}


if __name__ == "__main__":
    np.savez(sys.argv[2], **replay(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))))  # type: ignore[arg-type]
