"""The corners where methods fail: each ends with a trace that a finer run confirms, or with a typed outcome."""

import math

import numpy as np
import pytest
from variants import changed

from physics.cage import CagePath
from physics.imperfections import Imperfections, Waviness
from physics.integrators.method import NO_MODES
from physics.integrators.method_table import MARCHES, METHODS
from physics.integrators.output import Grid
from physics.motion import motion_model, starting_state
from physics.outcome import Outcome, SimulationFailed
from physics.request import Accurate, FixedSteps, HalvedSteps, Reference
from physics.response.single_march import respond
from physics.response.stability import limiting_modes, longest_stable_step, stable_substeps
from physics.rms import relative_error, rms
from physics.simulate import simulate
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium
from physics.trace import Kept

RATE = 65536.0
# Steps a sample at which each method is within its tolerance below on ordinary scenes.
STEPS = {
    "exponential_rk4": 1,
    "runge_kutta4": 4,
    "dormand_prince": 4,
    "generalised_alpha": 24,
    "exponential_adams2": 32,
    "exponential_adams3": 4,
    "exponential_adams4": 2,
}
TOLERANCE = {"exponential_rk4": 3e-3, "runge_kutta4": 3e-3, "dormand_prince": 3e-3, "generalised_alpha": 3e-2}
TOLERANCE |= dict.fromkeys(("exponential_adams2", "exponential_adams3", "exponential_adams4"), 3e-3)


def tiny_fast_spall(scene):
    extent = math.radians(0.05)
    fast = scene("F1", 0.03, speed_factor=10.0)
    return changed(fast, spall={"extent": extent, "entry_taper": 0.2 * extent, "exit_taper": 0.2 * extent})


CORNERS = {
    "every loaded ball inside an extended spall": lambda scene: changed(
        scene("F1", 0.03), spall={"extent": math.pi, "depth": 20e-6}
    ),
    "clearance with one ball loaded": lambda scene: changed(scene("F1", 0.03), bearing={"clearance": 200e-6}),
    "reversed load, the spall opposite": lambda scene: changed(
        scene("F1", 0.03), operation={"load": -100.0}, spall={"angle": math.pi / 2.0}
    ),
    "a spall shorter than one step at high speed": tiny_fast_spall,
    "edges that are almost rectangular": lambda scene: changed(
        scene("F1", 0.03), spall={"entry_taper": 1e-7, "exit_taper": 1e-7}
    ),
    "rollers": lambda scene: changed(scene("F1", 0.03), bearing={"exponent": 10.0 / 9.0, "load_deflection": 1e8}),
    "ten times the rated speed": lambda scene: scene("F1", 0.03, speed_factor=10.0),
    "a soft resonator": lambda scene: changed(scene("F1", 0.03), rig={"resonator_stiffness": 3.7e4}),
}
RATTLING = {"rig": {"film_damping": 0.0}, "operation": {"load": 0.5, "unbalance_force": 5.0}}
DEFAULT_CORNERS = CORNERS | {
    "a stiff resonator": lambda scene: changed(scene("F1", 0.03), rig={"resonator_stiffness": 3.7e9}),
    "balls that rattle": lambda scene: changed(scene("F1", 0.03), **RATTLING),
}


@pytest.mark.parametrize("corner", CORNERS)
@pytest.mark.parametrize("method", MARCHES)
def test_in_every_corner_every_method_agrees_with_a_finer_run(method, corner, reference_scene):
    scene = CORNERS[corner](reference_scene)
    exact = simulate(scene, RATE, FixedSteps(16)).acceleration
    trace = simulate(scene, RATE, FixedSteps(STEPS[method], method))
    assert trace.unlocated_changes == 0
    # Coarser than the goal of rated speed: edges here last a fraction of a step.
    assert rms(trace.acceleration - exact) < TOLERANCE[method] * rms(exact)


@pytest.mark.parametrize("corner", DEFAULT_CORNERS)
def test_in_every_corner_the_default_keeps_the_accuracy_asked_for(corner, reference_scene):
    scene = DEFAULT_CORNERS[corner](reference_scene)
    exact = simulate(scene, RATE, FixedSteps(32)).acceleration
    trace = simulate(scene, RATE)
    assert not trace.chaotic
    assert rms(trace.acceleration - exact) < 1e-3 * rms(exact)


def test_no_change_of_contact_is_lost_at_a_spall_as_narrow_as_a_tenth_of_a_milliradian(reference_scene):
    """Its ball changes sides at 67 m/s of compression, where one digit of time is more than a step may be wrong by."""
    scene = reference_scene("F1", 0.05, speed_factor=3.0, slip_seed=1)
    narrow = changed(scene, spall={"extent": 1e-4, "depth": 3e-6, "entry_taper": 3e-5, "exit_taper": 3e-5})
    exact = simulate(narrow, RATE, Reference())
    trace = simulate(narrow, RATE, Accurate(1e-6))
    assert trace.unlocated_changes == 0
    assert trace.changes.time.size == exact.changes.time.size
    assert rms(trace.acceleration - exact.acceleration) < 1e-4 * rms(exact.acceleration)


@pytest.mark.parametrize(("speed", "longer", "seed"), [(1.0, 3.0, 3), (2.0, 2.0, 1)])
def test_contact_that_is_made_at_a_vertical_wall_is_located_and_logged(speed, longer, seed, reference_scene):
    scene = reference_scene("F1", 0.2, speed_factor=speed, slip_seed=seed)
    wall = changed(scene, spall={"extent": longer * scene.spalls[0].extent, "exit_taper": 0.0})
    trace = simulate(wall, RATE)
    assert trace.unlocated_changes == 0
    assert trace.changes.made.any()
    for row, ball in set(zip(trace.changes.row.tolist(), trace.changes.ball.tolist(), strict=True)):
        made = trace.changes.made[(trace.changes.row == row) & (trace.changes.ball == ball)]
        assert made[0] != trace.changes.initial[row - 1, ball - 1]
        assert np.all(made[1:] != made[:-1])


def test_what_the_film_does_before_a_vertical_wall_is_no_error_behind_it(reference_scene):
    wall = changed(reference_scene("F1", 1.0, slip_seed=1), spall={"exit_taper": 0.0})
    exact = simulate(wall, RATE, FixedSteps(8)).acceleration
    trace = simulate(wall, RATE)
    assert rms(trace.acceleration - exact) < trace.error_estimate * rms(exact) < 1e-3 * rms(exact)


@pytest.mark.parametrize("speed", [1.0, 4.5, 6.0])
def test_a_free_ball_that_touches_the_lip_of_a_measured_spall_within_a_step_is_not_missed(speed, reference_scene):
    lip = {"table_angle": (-0.005, -0.002, 0.001, 0.005), "table_depth": (3e-5, 3e-5, -1e-6, 3e-5)}
    spall = Spall("inner", 1, 0.0, 0.012, 3e-5, profile="table", **lip)
    scene = changed(reference_scene("F0", 0.13, speed_factor=speed, slip_seed=1), spalls=(spall,))
    exact = simulate(scene, RATE, FixedSteps(64))
    trace = simulate(scene, RATE)
    assert trace.changes.time.size == exact.changes.time.size > 40
    assert rms(trace.acceleration - exact.acceleration) < trace.error_estimate * rms(exact.acceleration)


def test_a_ball_that_is_pressed_and_let_go_of_within_a_step_is_not_missed(reference_scene):
    """Without tension: a free ball meets the end of the exit taper, and the film lets go of it at once."""
    spall = Spall("inner", 1, 0.0, 0.040385, 19e-6, 0.004038, 0.003444)
    scene = reference_scene("F0", 0.1, speed_factor=5.5, slip_seed=1)
    scene = changed(scene, operation={"load": 60.5}, spalls=(spall,), contact_law="no_tension")
    exact = simulate(scene, RATE, FixedSteps(64))
    trace = simulate(scene, RATE)
    assert trace.changes.time.size == exact.changes.time.size > 100
    # The fixed steps are right to 1e-5; the estimate must say so.
    assert rms(trace.acceleration - exact.acceleration) < trace.error_estimate * rms(exact.acceleration)


def test_a_ball_that_meets_a_wall_just_behind_the_release_of_another_is_not_met_late(reference_scene):
    """Releases whose film force is small are put on the grid, here half a microsecond late: behind the landing."""
    narrow = {"extent": 6e-4, "entry_taper": 2.4e-4, "exit_taper": 2.4e-4}  # passed in two samples
    scene = reference_scene("G1", 0.35)
    cage = CagePath(scene.cage.nominal_speed, 0.35, scene.cage.start_angle, 0.004)
    scene = changed(scene, cage=cage, spall=narrow)
    exact, trace = simulate(scene, RATE, FixedSteps(32)), simulate(scene, RATE)
    # The fixed steps are right to 1e-6; the estimate must say so.
    assert rms(trace.acceleration - exact.acceleration) < trace.error_estimate * rms(exact.acceleration)


RIDGES = {
    "between a wall and a taper": (
        ("G0", 4.2, 0, 16.2),
        Spall("outer", 1, 4.712, 0.053031, 6e-6, 0.010606, 0.0),
        Spall("outer", 1, 4.7422265, 0.007422, 7e-6, 0.001484, 0.001484),
    ),
    "between a rolled path and a taper": (
        ("F0", 7.0, 3, 11.4),
        Spall("inner", 1, 0.0, 0.147828, 5e-6, 0.007391, 0.029566, profile="ball_path"),
        Spall("inner", 1, 0.1037335, 0.059639, 18e-6, 0.011928, 0.0),
    ),
    "between two walls": (
        ("F0", 7.5, 3, 45.2),
        Spall("inner", 1, 0.0, 0.041728, 20e-6),
        Spall("inner", 1, 0.0460535, 0.049379, 11e-6),
    ),
}


@pytest.mark.parametrize("place", RIDGES)
def test_a_free_ball_that_touches_a_ridge_between_two_spalls_within_a_step_is_not_missed(place, reference_scene):
    (name, speed, seed, load), *spalls = RIDGES[place]
    scene = reference_scene(name, 0.1, speed_factor=speed, slip_seed=seed)
    scene = changed(scene, operation={"load": load}, spalls=tuple(spalls))
    exact = simulate(scene, RATE, FixedSteps(64))
    trace = simulate(scene, RATE)
    assert trace.changes.time.size == exact.changes.time.size > 100
    # The fixed steps are right to 1e-5; the estimate must say so.
    assert rms(trace.acceleration - exact.acceleration) < trace.error_estimate * rms(exact.acceleration)


def test_fixed_steps_end_at_both_edges_of_a_ridge_too(reference_scene):
    (name, speed, seed, load), *spalls = RIDGES["between two walls"]
    scene = reference_scene(name, 0.1, speed_factor=speed, slip_seed=seed)
    scene = changed(scene, operation={"load": load}, spalls=tuple(spalls))
    exact, trace = simulate(scene, RATE, FixedSteps(16)), simulate(scene, RATE, FixedSteps(1))
    assert trace.changes.time.size == exact.changes.time.size > 300
    # A step that runs over the ridge misses 36 changes and is wrong by 2e-2.
    assert rms(trace.acceleration - exact.acceleration) < 1e-5 * rms(exact.acceleration)


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_a_ball_that_rolls_slowly_over_a_taper_meets_no_jump_of_its_path(race, reference_scene):
    speed, scene = 90.0 * math.pi / 30.0, reference_scene("G0", 0.12)
    spall = Spall(race, 1, 4.712, 0.017, 36e-6, 0.0017, 0.0037, profile="ball_path")
    cage = CagePath(scene.rig.bearing.cage_speed(speed), 0.12, 0.1)
    scene = changed(scene, operation={"shaft_speed": speed, "load": 90.0}, cage=cage, spalls=(spall,))
    exact, trace = simulate(scene, RATE, Accurate(1e-6)), simulate(scene, RATE)
    assert rms(trace.acceleration - exact.acceleration) < trace.error_estimate * rms(exact.acceleration)


@pytest.mark.parametrize(("rpm", "race"), [(163.0, "outer"), (114.0, "inner")])
def test_the_tables_of_waves_ring_no_mode(rpm, race, reference_scene):
    """At these speeds 64 times the frequency of 28 waves meets a mode."""
    speed, scene = rpm * math.pi / 30.0, reference_scene("F0", 0.05)
    waves = Imperfections((Waviness(race, 28, 1e-6, 0.3),))
    cage = CagePath(scene.rig.bearing.cage_speed(speed), 0.05, 0.1)
    scene = changed(scene, operation={"shaft_speed": speed}, cage=cage, imperfections=waves)
    exact, trace = simulate(scene, RATE, Reference()), simulate(scene, RATE, Accurate(1e-4))
    assert rms(trace.acceleration - exact.acceleration) < trace.error_estimate * rms(exact.acceleration)
    assert trace.error_estimate < 1e-4


@pytest.mark.parametrize("seed", [0, 3, 4])
def test_errors_that_grow_from_impact_to_impact_after_a_quiet_beginning_are_seen(seed, reference_scene):
    """A light load, 36.4 N at 4009.5 rpm, over a shallow spall: errors grow a thousandfold within 0.4 s."""
    spall = Spall("outer", 1, 4.712, 0.083, 10e-6, 0.0166, 0.0166)
    scene = reference_scene("F0", 0.4, speed_factor=4009.5 / 800.0, slip_seed=seed)
    scene = changed(scene, operation={"load": 36.4}, spalls=(spall,))
    trace, finer = simulate(scene, RATE), simulate(scene, RATE, Accurate(1e-6, path_fineness=1))  # of the same path
    assert trace.chaotic or rms(trace.acceleration - finer.acceleration) < 1e-3 * rms(finer.acceleration)
    assert trace.sensitivity > 10.0


@pytest.mark.parametrize("method", MARCHES)
def test_without_load_nothing_moves_by_any_method(method, reference_scene):
    scene = changed(reference_scene("F1", 0.02), operation={"load": 0.0})
    trace = simulate(scene, RATE, FixedSteps(2, method))
    assert np.all(trace.acceleration == 0.0)


@pytest.mark.parametrize("method", MARCHES)
def test_balls_that_rattle_in_a_bearing_without_damping_stay_finite_and_bounded(method, reference_scene):
    """A shaft thrown about by an unbalance of ten times its load touches and leaves most balls."""
    scene = changed(reference_scene("F1", 0.05), **RATTLING)
    trace = simulate(scene, RATE, FixedSteps(2, method), keep=Kept(state=True))
    assert np.all(np.isfinite(trace.state))
    assert trace.changes.time.size > 20
    assert rms(trace.acceleration) < 100.0  # m/s²; 5.5 N on 2.5 kg make 2


@pytest.mark.parametrize("method", MARCHES)
def test_no_method_hangs_where_a_strong_film_makes_contact_chatter(method, reference_scene):
    """Film forces of hundreds of times the load switch on and off with each other's changes of contact: 133 of them in
    20 ms, of which seven in one sample. Methods whose steps are not stable say so."""
    scene = changed(reference_scene("F1", 0.02), rig={"film_damping": 1e6}, contact_law="no_tension")
    steps = 8
    if METHODS[method].limits != NO_MODES:
        with pytest.raises(SimulationFailed) as failure:
            simulate(scene, RATE, FixedSteps(steps, method))
        assert failure.value.outcome is Outcome.UNSTABLE_STEP
        steps = 256
    trace = simulate(scene, RATE, FixedSteps(steps, method))
    assert np.all(np.isfinite(trace.acceleration))
    assert trace.changes.time.size > 100
    assert np.bincount((trace.changes.time * RATE).astype(int)).max() >= 7


def test_steps_that_are_stable_while_one_ball_is_loaded_are_refused_if_two_are_later(reference_scene):
    """A load of 0.03 N on a strong film: at t = 0 one ball of a row carries it, half a spacing later two do, and their
    films are twice as strong. Steps that only the first position allowed gave five times the acceleration."""
    scene = changed(reference_scene("F1", 0.02), rig={"film_damping": 1e6}, operation={"load": 0.03})
    at_start = stable_substeps(scene, METHODS["runge_kutta4"], equilibrium(scene, np.zeros(1)), RATE)
    with pytest.raises(SimulationFailed) as failure:
        simulate(scene, RATE, FixedSteps(at_start, "runge_kutta4"))
    assert failure.value.outcome is Outcome.UNSTABLE_STEP
    later = equilibrium(scene, np.array([math.pi / scene.rig.bearing.balls / scene.cage.mean_speed]))
    allowed = stable_substeps(scene, METHODS["runge_kutta4"], later, RATE)
    exact = simulate(scene, RATE, Accurate(1e-5)).acceleration
    just_stable = simulate(scene, RATE, FixedSteps(allowed, "runge_kutta4")).acceleration
    assert relative_error(just_stable, exact) < 0.2


@pytest.mark.parametrize("mass", [1e-4, 1e-9])
def test_a_resonator_too_light_for_the_rate_is_refused_before_anything_is_made(mass, reference_scene):
    scene = changed(reference_scene("F1", 0.02), rig={"resonator_mass": mass, "resonator_damping": 0.0})
    with pytest.raises(SimulationFailed, match="has to be raised") as failure:
        simulate(scene, 4096.0)
    assert failure.value.outcome is Outcome.UNRESOLVED


def test_a_resonator_just_light_enough_is_simulated_at_a_multiple_of_the_rate(reference_scene):
    scene = changed(reference_scene("F1", 0.02), rig={"resonator_mass": 1e-3, "resonator_damping": 5.0})
    once = simulate(scene, RATE, FixedSteps()).acceleration
    often = simulate(scene, RATE, FixedSteps(16)).acceleration
    assert rms(once - often) < 3e-3 * rms(often)  # contact changes an order n + 1 below the smooth error


# A little damping lengthens stable steps; nearly without it the limit is sharp, and growth beyond it slow.
THIN = {"film_damping": 1.0}


def stiffened(scene, method, steps):
    """`scene` with contacts so stiff that the longest stable step of `method` is `steps` samples."""
    low, high = 0.0, 20.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        stiff = changed(
            scene, bearing={"load_deflection": math.exp(middle) * scene.rig.bearing.load_deflection}, rig=THIN
        )
        if longest(stiff, method) * RATE > steps:
            low = middle
        else:
            high = middle
    return stiff


def longest(scene, method):
    rest = equilibrium(scene, np.zeros(1))
    return longest_stable_step(scene.rig, METHODS[method], rest.stiffness[0], rest.damping[0])


def unchecked(scene, method, samples):
    """Acceleration at one step a sample, stable or not, from a push of 1 µm/s that a decaying mode forgets."""
    rest = equilibrium(scene, np.zeros(1))
    start = starting_state(motion_model(scene), rest.displacement[0])
    start[7] += 1e-6
    return respond(scene, start, Grid(samples, 1, 1.0 / RATE), method).acceleration


LIMITED = sorted(name for name in MARCHES if math.isfinite(METHODS[name].stability_limit))
SECOND = round(RATE)


def quarters(response):
    """RMS of the first and the last quarter of a response."""
    quarter = response.shape[0] // 4
    return rms(response[:quarter]), rms(response[-quarter:])


@pytest.mark.parametrize("method", LIMITED)
def test_just_inside_the_stability_limit_a_push_dies_away(method, reference_scene):
    scene = stiffened(reference_scene("G0", 1.0), method, 1.06)
    simulate(scene, RATE, FixedSteps(1, method))
    first, last = quarters(unchecked(scene, method, SECOND))
    assert last < first


@pytest.mark.parametrize("method", LIMITED)
def test_just_outside_the_stability_limit_the_step_is_refused_and_would_have_run_away(method, reference_scene):
    scene = stiffened(reference_scene("G0", 1.0), method, 0.7)  # nearer, the last damping still holds it for a while
    with pytest.raises(SimulationFailed, match=f"{method} is stable up to") as failure:
        simulate(scene, RATE, FixedSteps(1, method))
    assert failure.value.outcome is Outcome.UNSTABLE_STEP
    assert ran_away(lambda: unchecked(scene, method, SECOND))


def ran_away(run):
    """Whether a response ended with an outcome of runaway, or three times larger than it began."""
    try:
        first, last = quarters(run())
    except SimulationFailed as failure:
        return failure.outcome in (Outcome.NOT_FINITE, Outcome.TOO_MANY_CHANGES)
    return last > 3.0 * first


@pytest.mark.parametrize("speed", [math.nan, 1e11])  # m/s
@pytest.mark.parametrize("method", MARCHES)
def test_a_response_that_is_no_number_or_beyond_any_machine_is_refused(method, speed, reference_scene):
    scene = reference_scene("G0", 0.01)
    start = starting_state(motion_model(scene), equilibrium(scene, np.zeros(1)).displacement[0])
    start[7] = speed
    with pytest.raises(SimulationFailed, match=r"stopped being finite with steps of 1\.53e-05 s") as failure:
        respond(scene, start, Grid(300, 1, 1.0 / RATE), method)
    assert failure.value.outcome is Outcome.NOT_FINITE


@pytest.mark.parametrize("method", LIMITED)
def test_without_steps_given_the_method_takes_as_many_as_it_is_stable_with(method, reference_scene):
    scene = stiffened(reference_scene("G0", 0.02), method, 0.3)
    trace = simulate(scene, RATE, FixedSteps(method=method))
    rest = equilibrium(scene, np.zeros(1))
    least = math.ceil(1.0 / (RATE * longest(scene, method)))
    assert round(1.0 / (RATE * trace.step)) == stable_substeps(scene, METHODS[method], rest, RATE) == least > 2
    assert np.all(np.isfinite(trace.acceleration))


def test_contacts_far_too_stiff_for_an_explicit_method_are_refused_and_named(reference_scene):
    scene = changed(reference_scene("G0", 0.02), bearing={"load_deflection": 1e24})
    with pytest.raises(SimulationFailed, match="of the contact modes") as failure:
        simulate(scene, RATE, HalvedSteps())
    assert failure.value.outcome is Outcome.UNSTABLE_STEP


def test_the_limiting_modes_of_a_lightly_damped_rig_are_its_fastest(gearbox, reference_scene):
    rest = equilibrium(reference_scene("G0", 0.02), np.zeros(1))
    rate = np.abs(limiting_modes(gearbox, "every mode", rest.stiffness[0], rest.damping[0])).max()
    assert rate == pytest.approx(2.0 * math.pi * 10548.1, rel=1e-4)  # undamped mode of an independent model


def test_the_limiting_contact_modes_are_the_roots_of_their_quadratic(gearbox):
    def fastest(k, c):
        return np.abs(limiting_modes(gearbox, "the contact modes", k, c)).max()

    inverse = 1.0 / gearbox.inner_mass + 1.0 / gearbox.outer_mass
    k, c = np.array([1e8, 2e8, 0.0]), np.array([0.0, 0.0, 0.0])
    assert fastest(k, c) == pytest.approx(math.sqrt(2e8 * inverse), rel=1e-9)
    overdamped = np.array([0.0, 1e6, 0.0])
    roots = np.roots([1.0, 1e6 * inverse, 2e8 * inverse])
    assert fastest(k, overdamped) == pytest.approx(np.abs(roots).max(), rel=1e-9)
    assert limiting_modes(gearbox, "none", k, c).size == 0


def test_the_longest_step_is_that_of_the_mode_which_limits_it_most_and_not_of_the_fastest(gearbox):
    """Along x a mode is four fifths as fast as along y, but undamped, and the method holds it a tenth as far."""
    method = METHODS["exponential_adams3"]
    inverse = 1.0 / gearbox.inner_mass + 1.0 / gearbox.outer_mass
    slow, fast = 8e3, 1e4  # rad/s
    k = np.array([slow**2, fast**2, 0.0]) / inverse
    c = np.array([0.0, 2.0 * 0.05 * fast, 0.0]) / inverse
    assert longest_stable_step(gearbox, method, k, c) == pytest.approx(method.stability_limit / slow, rel=1e-9)
