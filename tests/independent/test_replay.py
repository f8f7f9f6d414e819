"""The independent replay against closed forms and a third implementation; nothing here touches the packages.

The third implementation's numbers stand in tests/authorities/independent_model.toml, too.
"""

import ast
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import replay as script
from reference_scenes import REFERENCE_SCENES, constant_slip, reference_scene_json
from replay import contact_sum, derivative, initial_state, read_machine, replay, static_displacement, tabulate_spall

FINITE_STEP = 1e-13  # m or m/s
STATIC_STEP = 1e-15  # m: shorter still, since two balls at the edge of the load zone gain stiffness as √step


def rms(signal):
    return float(np.sqrt(np.mean(np.square(signal))))


def balls_at_rest(machine, cage_angle, displacement):
    force, state = np.zeros(machine.ball_offset.shape), np.zeros(12)
    state[:2] = displacement
    cage = np.full(force.shape[0], cage_angle)
    net = contact_sum(machine, state, 0.0, cage, np.zeros_like(cage), force)
    return np.array(net), force


def stiffness(machine, cage_angle):
    rest = static_displacement(machine, np.full(machine.ball_offset.shape[0], cage_angle))
    columns = [
        (balls_at_rest(machine, cage_angle, rest + step)[0] - balls_at_rest(machine, cage_angle, rest - step)[0])
        / (2 * STATIC_STEP)
        for step in STATIC_STEP * np.eye(2)
    ]
    return np.array(columns)


def natural_frequencies(scene):
    """Magnitudes of the eigenvalues with the cage at rest, as the paper takes them (Eq. 31)."""
    machine, cage = read_machine(scene), np.zeros(2)
    rest = initial_state(machine, cage)
    up, down, spare = np.empty(12), np.empty(12), np.empty(machine.ball_offset.shape)
    jacobian = np.empty((12, 12))
    for k, step in enumerate(FINITE_STEP * np.eye(12)):
        derivative(machine, rest + step, 0.0, cage, np.zeros(2), spare, up)
        derivative(machine, rest - step, 0.0, cage, np.zeros(2), spare, down)
        jacobian[:, k] = (up - down) / (2 * FINITE_STEP)
    values = np.linalg.eigvals(jacobian)
    return np.sort(np.abs(values[values.imag > 0.0])) / (2 * np.pi)


def deep_gap(race, extent, machine_name):
    scene = reference_scene_json(f"{machine_name}1p")
    _, path, _ = tabulate_spall(scene["defects"][0] | {"race": race, "extent": extent}, scene["parameters"])
    return path


def test_the_scripts_import_nothing_but_the_standard_library_numpy_scipy_and_numba():
    for name in ("replay", "reference_scenes", "sensor"):
        tree = ast.parse(Path(script.__file__).with_name(f"{name}.py").read_text(encoding="utf-8"))
        imported = {node.module.split(".")[0] for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
        imported |= {alias.name.split(".")[0] for n in ast.walk(tree) if isinstance(n, ast.Import) for alias in n.names}
        assert imported - set(sys.stdlib_module_names) <= {"numpy", "scipy", "numba", "replay"}


@pytest.mark.slow
def test_the_script_run_alone_on_a_text_writes_what_the_function_returns(tmp_path):
    scene = reference_scene_json("F1", duration=0.004)
    (tmp_path / "scenario.json").write_text(json.dumps(scene), encoding="utf-8")
    command = [sys.executable, "-I", script.__file__, str(tmp_path / "scenario.json"), str(tmp_path / "out.npz")]
    subprocess.run(command, check=True)
    expected = replay(scene)
    with np.load(tmp_path / "out.npz") as found:
        for key in ("time", "acceleration", "state", "contact_force"):
            np.testing.assert_array_equal(found[key], expected[key])


@pytest.mark.parametrize(("name", "bpfo"), [("G0", 34.283), ("F0", 76.74)])
def test_the_cage_turns_at_the_ball_pass_frequency_of_the_third_implementation(name, bpfo):
    parameters = reference_scene_json(name)["parameters"]
    passes = parameters["Nb"] * constant_slip(parameters)["nominal_speed"] / (2 * np.pi)
    assert passes == pytest.approx(bpfo, abs=5e-3 if name == "F0" else 5e-4)  # printed digits


def test_the_most_loaded_ball_of_the_healthy_gearbox_rig_carries_62_995_n():
    machine = read_machine(reference_scene_json("G0"))
    net, force = balls_at_rest(machine, 0.0, static_displacement(machine, np.zeros(2)))
    assert force.max() == pytest.approx(62.995, abs=5e-4)  # printed digits
    np.testing.assert_allclose(net, [0.0, -346.0], atol=1e-8)  # solver stops at 1e-11 of the load


@pytest.mark.parametrize(("degrees", "kyy", "kxx"), [(0.0, 97.85e6, 61.42e6), (7.5, 97.84e6, 66.35e6)])
def test_the_stiffness_of_the_healthy_gearbox_rig_is_that_of_the_third_implementation(degrees, kyy, kxx):
    k = stiffness(read_machine(reference_scene_json("G0")), np.radians(degrees))
    assert k[1, 1] == pytest.approx(kyy, abs=5e3)  # printed digits
    assert k[0, 0] == pytest.approx(kxx, abs=5e3)  # printed digits
    assert k[0, 1] == pytest.approx(k[1, 0], abs=1e3)  # a potential's stiffness is symmetric; finite differences


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("G0", [199.29, 199.31, 1782.4, 2249.3, 10547.9, 10548.1]),
        ("F0", [464.1, 902.2, 1658.8, 1996.4, 9898.4, 9900.1]),
    ],
)
def test_the_linearised_natural_frequencies_are_those_of_the_third_implementation(name, expected):
    found = natural_frequencies(reference_scene_json(name))
    np.testing.assert_allclose(found, expected, atol=0.051)  # printed to 0.1 Hz (0.01 Hz below 200 Hz)


@pytest.mark.parametrize(
    ("machine", "race", "extent", "drop_um"),
    [
        ("G", "outer", np.radians(2.0), 19.1),
        ("F", "outer", 1.2e-3 / 26.5e-3, 38.5),
        ("F", "inner", 1.2e-3 / 18.5e-3, 55.0),
    ],
)
def test_a_ball_drops_into_a_deep_gap_as_far_as_in_the_third_implementation(machine, race, extent, drop_um):
    found = deep_gap(race, extent, machine).max() * 1e6
    assert found == pytest.approx(drop_um, abs=0.5 if race == "inner" else 0.05)  # printed digits


@pytest.mark.parametrize(("race", "radius", "turn"), [("outer", 26.5e-3, -1.0), ("inner", 18.5e-3, 1.0)])
def test_the_rolled_path_over_a_deep_gap_is_the_closed_form_everywhere(race, radius, turn):
    half = np.radians(1.3)
    path = deep_gap(race, 2 * half, "F")
    cells = int(np.ceil(2 * half * radius / script.SURFACE_STEP))
    beyond = (path.size - 1 - cells) // 2
    psi = np.clip(half - np.abs(np.arange(-beyond, cells + beyond + 1) * 2 * half / cells - half), 0.0, None)
    drop = 4e-3 - np.sqrt((4e-3) ** 2 - (radius * np.sin(psi)) ** 2) + turn * radius * (1 - np.cos(psi))
    np.testing.assert_allclose(path, drop, atol=2e-11)  # a flat race seen at samples 0.5 µm apart


def test_the_ball_rolls_on_the_floor_of_a_shallow_gap():
    scene = reference_scene_json("F1p")
    _, path, _ = tabulate_spall(scene["defects"][0] | {"depth": 10e-6}, scene["parameters"])
    assert path.max() == pytest.approx(10e-6, abs=2e-11)  # a flat floor seen at samples 0.5 µm apart


def test_the_damper_sees_the_total_time_derivative_of_the_compression():
    scene = reference_scene_json("F2")
    scene["defects"][0] |= {"race": "inner", "phi_f": 4.6}
    scene["waviness"] = [{"race": r, "order": 11, "amplitude": 1e-6, "phase": 0.2} for r in ("inner", "outer")]
    machine, step, time, speed = read_machine(scene), 1e-7, 0.01, np.array([35.0, 36.0])
    displaced = np.array([1e-5, -2e-5, 3e-6, 4e-6, 0, 0, 1e-3, -2e-3, 5e-4, 3e-4, 0, 0])

    def compression(shift, law):
        force, state = np.empty((2, 14)), displaced + shift * np.concatenate([displaced[6:], np.zeros(6)])
        contact_sum(machine._replace(**law), state, time + shift, speed * (time + shift), speed, force)
        return force

    only_spring, only_damper = {"K": 1.0, "n": 1.0, "c_d": 0.0}, {"K": 0.0, "c_d": 1.0}
    expected = (compression(step, only_spring) - compression(-step, only_spring)) / (2 * step)
    assert np.count_nonzero(expected) > 10
    np.testing.assert_allclose(compression(0.0, only_damper), expected, atol=1e-9)  # finite differences of 1e-5 m


def test_a_scene_starts_at_rest_in_equilibrium():
    machine = read_machine(reference_scene_json("F1"))
    rates = np.ones(12)
    derivative(machine, initial_state(machine, np.zeros(2)), 0.0, np.zeros(2), np.zeros(2), np.zeros((2, 14)), rates)
    np.testing.assert_allclose(rates, 0.0, atol=1e-8)  # 1e-11 of 100 N on the lightest mass of 0.1 kg


def test_the_healthy_gearbox_rig_vibrates_along_the_load_with_six_millionths_of_a_metre_per_second_squared():
    found = replay(reference_scene_json("G0", duration=0.2), substeps=2)["acceleration"][6554:, 1]
    assert rms(found) == pytest.approx(6e-6, rel=0.1)  # one printed digit


def test_halving_the_step_divides_the_error_by_sixteen_while_all_balls_stay_in_contact():
    scene = reference_scene_json("G0", duration=0.05)
    scene["parameters"]["c"] = -8e-6
    scene["waviness"] = [{"race": "inner", "order": 13, "amplitude": 0.5e-6, "phase": 0.3}]
    runs = [replay(scene, substeps)["acceleration"] for substeps in (4, 8, 32)]
    order = np.log2(rms(runs[0] - runs[2]) / rms(runs[1] - runs[2]))
    assert order == pytest.approx(4.0, abs=0.1)  # the finest run has 1/256 of the smaller error


def test_the_step_of_the_line_spall_scenes_is_fine_enough_for_a_third_of_a_percent():
    for name in ("G1", "F1"):
        coarse, fine = (replay(reference_scene_json(name, duration=0.1), n)["acceleration"] for n in (16, 64))
        assert rms(coarse - fine) < 4e-3 * rms(fine)  # first order: the error at 64 substeps is a quarter of this


def test_every_reference_scene_is_made_and_starts():
    for name in REFERENCE_SCENES:
        scene = json.loads(json.dumps(reference_scene_json(name, duration=0.001)))
        result = replay(scene, substeps=1)
        assert result["acceleration"].shape == (66, 2)
        assert np.all(np.isfinite(result["state"]))


def test_the_roughness_of_the_rough_scenes_is_two_micrometres_deep_and_ends_at_zero():
    for seed in range(10):
        values = np.array(reference_scene_json("G2r", seed=seed)["defects"][0]["roughness_values"])
        assert values.std() == pytest.approx(2e-6, rel=1e-12)  # scaled to it
        assert values[0] == values[-1] == 0.0
