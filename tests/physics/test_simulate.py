"""What `simulate` refuses and how it says so, and what its options give back."""

import dataclasses
import math

import numpy as np
import pytest

from physics.cage import CagePath
from physics.checks import InvalidParameter
from physics.operation import Operation
from physics.outcome import Outcome, SimulationFailed
from physics.request import Accurate, FixedSteps, HalvedSteps, LeadIn, Reference
from physics.response.oversampling import oversampling
from physics.rms import rms
from physics.simulate import simulate
from physics.trace import Kept

RATE = 65536.0


def with_rig(scene, **changes):
    return dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, **changes))


def with_bearing(scene, **changes):
    return with_rig(scene, bearing=dataclasses.replace(scene.rig.bearing, **changes))


@pytest.mark.parametrize(
    ("kind", "choice", "message"),
    [
        (FixedSteps, {"method": "euler"}, 'method = "euler"; allowed: exponential_rk4, '),
        (FixedSteps, {"method": "modal"}, 'method = "modal"; allowed: exponential_rk4, '),
        (FixedSteps, {"substeps": 0}, "substeps = 0; allowed: whole numbers 1 to 1024"),
        (FixedSteps, {"substeps": -3}, "substeps = -3; allowed"),
        (FixedSteps, {"substeps": 1.5}, r"substeps = 1\.5; allowed"),
        (FixedSteps, {"substeps": math.nan}, "substeps = nan; allowed"),
        (HalvedSteps, {"method": "reference"}, 'method = "reference"; allowed: exponential_rk4, '),
        (HalvedSteps, {"accuracy": 0.2}, r"accuracy = 0\.2; allowed: 1e-06 to 0\.1"),
        (Accurate, {"accuracy": 0.0}, r"accuracy = 0\.0; allowed: 1e-06 to 0\.1"),
        (Accurate, {"accuracy": 1e-7}, "accuracy = 1e-07; allowed"),
        (Accurate, {"accuracy": 0.2}, r"accuracy = 0\.2; allowed"),
        (Accurate, {"accuracy": math.nan}, "accuracy = nan; allowed"),
        (Accurate, {"least_error": math.nan}, r"least_error = nan m/s²; it must not be below 0"),
        (Accurate, {"least_error": -1.0}, r"least_error = -1\.0 m/s²"),
        (Accurate, {"least_error": math.inf}, r"least_error = inf m/s²"),
        (Kept, {"fastest_path": math.nan}, r"fastest_path = nan Hz; it must not be below 0"),
        (Kept, {"fastest_path": 9000.0}, r"fastest_path = 9000\.0 Hz; without the outer ring's motion nothing"),
        (LeadIn, {"seconds": -0.1}, r"lead-in = -0\.1 s; it must not be below 0"),
        (LeadIn, {"seconds": math.nan}, "lead-in = nan s"),
        (LeadIn, {"seconds": math.inf}, "lead-in = inf s"),
    ],
)
def test_a_choice_out_of_range_is_refused_with_its_value(kind, choice, message):
    with pytest.raises(InvalidParameter, match=message):
        kind(**choice)


@pytest.mark.parametrize("rate", [0.0, -5.0, math.nan, math.inf])
def test_a_rate_that_is_none_is_refused(rate, reference_scene):
    with pytest.raises(InvalidParameter, match=f"rate = {rate} Hz; it must be above 0"):
        simulate(reference_scene("G1", 0.02), rate)


def test_a_scene_without_a_sample_is_refused_with_duration_and_rate(reference_scene):
    with pytest.raises(SimulationFailed, match=r"a duration of 0\.02 s holds no sample at 10 Hz") as caught:
        simulate(reference_scene("G1", 0.02), 10.0)
    assert caught.value.outcome is Outcome.BAD_REQUEST
    assert str(caught.value).endswith(Outcome.BAD_REQUEST.value)


def test_a_load_that_no_position_carries_is_told_with_the_load(reference_scene):
    soft = with_bearing(reference_scene("G0", 0.02), load_deflection=1e5)
    scene = dataclasses.replace(soft, operation=Operation(44.0, 1e7))
    with pytest.raises(
        SimulationFailed, match=r"at t = 0 s no position of the shaft carries the load of 1e\+07 N"
    ) as caught:
        simulate(scene, RATE)
    assert caught.value.outcome is Outcome.NO_START


@pytest.mark.parametrize("absurd", [{"film_damping": 1e6}, {"inner_mass": 1e-5}])
def test_a_step_that_would_blow_up_is_refused_with_the_one_it_takes(absurd, reference_scene):
    with pytest.raises(SimulationFailed, match=r"stable up to .* takes \d+ steps a sample") as caught:
        simulate(with_rig(reference_scene("G1", 0.05), **absurd), RATE, FixedSteps(1))
    assert caught.value.outcome is Outcome.UNSTABLE_STEP


@pytest.mark.parametrize("solution", [Accurate(), FixedSteps(1)])
def test_more_contact_changes_than_can_be_logged_are_told(solution, reference_scene, monkeypatch):
    monkeypatch.setattr("physics.response.change_log.FIRST_ROOM", 4)
    monkeypatch.setattr("physics.response.change_log.LARGEST_ROOM", 32)
    with pytest.raises(SimulationFailed, match=r"more than 32 changes of contact in 0\.5 s") as caught:
        simulate(reference_scene("G1", 0.5), RATE, solution)
    assert caught.value.outcome is Outcome.TOO_MANY_CHANGES


def test_a_log_that_was_too_short_at_first_changes_nothing(reference_scene, reference_trace, monkeypatch):
    once = reference_trace("G1", 0.5)
    chosen = simulate(reference_scene("G1", 0.5), RATE)
    monkeypatch.setattr("physics.response.change_log.FIRST_ROOM", 4)
    again = simulate(reference_scene("G1", 0.5), RATE, FixedSteps(1))
    assert np.array_equal(again.acceleration, once.acceleration)
    assert np.array_equal(again.changes.time, once.changes.time)
    assert np.array_equal(simulate(reference_scene("G1", 0.5), RATE).acceleration, chosen.acceleration)


def test_states_and_forces_are_kept_only_when_asked_for_and_do_not_touch_the_response(reference_scene):
    scene = reference_scene("F1", 0.03)
    bare = simulate(scene, RATE)
    full = simulate(scene, RATE, keep=Kept(state=True, force=True))
    samples = round(0.03 * RATE)
    assert bare.state is None
    assert bare.contact_force is None
    assert bare.acceleration.shape == (samples, 2)
    assert full.state.shape == (samples, 12)
    assert full.contact_force.shape == (samples, 2, 14)
    assert np.array_equal(bare.acceleration, full.acceleration)
    assert np.array_equal(bare.time, np.arange(samples) / RATE)


def test_the_same_scene_gives_the_same_bits_again(reference_scene):
    scene = reference_scene("G2r", 0.05, slip_seed=3)
    first, second = simulate(scene, RATE), simulate(scene, RATE)
    assert np.array_equal(first.acceleration, second.acceleration)
    assert first.error_estimate == second.error_estimate


@pytest.mark.parametrize("name", ["G1", "F1s"])
def test_the_start_is_at_rest_in_static_equilibrium(name, reference_scene):
    scene = reference_scene(name, 0.001)
    trace = simulate(scene, RATE, keep=Kept(state=True, force=True))
    assert np.all(np.abs(trace.state[0, 6:]) < 1e-18)  # m/s: the sum of the modes' round-off
    assert np.all(np.abs(trace.acceleration[0]) < 1e-9)  # m/s²: round-off of two springs' forces
    support = scene.rig.support_stiffness_y * trace.state[0, 3]
    assert support == pytest.approx(-scene.operation.load, rel=1e-12)  # a single spring carries the load
    # The film adds forces because the balls roll into and out of their load at once: a few hundredths of a newton.
    angle = 2.0 * np.pi * np.arange(scene.rig.bearing.balls) / scene.rig.bearing.balls
    rows = np.array([angle, angle + np.pi / scene.rig.bearing.balls])
    assert np.sum(trace.contact_force[0] * np.sin(rows)) == pytest.approx(-scene.operation.load, rel=1e-3)


@pytest.mark.parametrize("solution", [Accurate(), FixedSteps(1)])
def test_with_a_contact_angle_the_radial_share_of_the_normal_forces_carries_the_load(solution, reference_scene):
    scene = with_rig(with_bearing(reference_scene("G0", 0.001), contact_angle=0.4), film_damping=0.0)
    trace = simulate(scene, RATE, solution, keep=Kept(force=True))
    angle = 2.0 * np.pi * np.arange(12) / 12.0
    rows = np.array([angle, angle + np.pi / 12.0])
    assert np.sum(trace.contact_force[0] * np.sin(rows)) * math.cos(0.4) == pytest.approx(-346.0, rel=1e-6)


def test_a_low_rate_is_simulated_at_a_higher_one_and_lowered_without_aliasing(reference_scene, reference_trace):
    high = reference_trace("G1", 0.5).acceleration[:, 1]
    low_rate = RATE / 8.0
    low = simulate(reference_scene("G1", 0.5), low_rate).acceleration[:, 1]
    assert low.size == high.size // 8
    # Both records keep what lies below 3 kHz; the resonator at 10.5 kHz, far stronger, would alias to 2.3 kHz.
    spectra = [np.fft.rfft(signal * np.hanning(signal.size)) / signal.size for signal in (high, low)]
    below = np.fft.rfftfreq(low.size, 1.0 / low_rate) < 3000.0
    error = np.abs(spectra[0][: below.size][below] - spectra[1][below])
    assert rms(error) < 1e-3 * rms(np.abs(spectra[0][: below.size][below]))  # the filter's ripple of -80 dB


def test_a_low_rate_gives_the_states_and_forces_of_its_own_instants(reference_scene):
    scene = reference_scene("G1", 0.0625)
    low = simulate(scene, RATE / 4.0, keep=Kept(state=True, force=True))
    high = simulate(scene, RATE, keep=Kept(state=True, force=True))
    assert np.array_equal(low.time, high.time[::4])
    for kept in ("state", "contact_force"):
        here, there = getattr(low, kept), getattr(high, kept)[::4]
        assert here.shape == there.shape
        error = np.abs(here - there).reshape(here.shape[0], -1).max(axis=0)
        assert np.all(error <= 5e-3 * np.abs(there).reshape(here.shape[0], -1).max(axis=0))  # two errors of one step


def test_without_a_number_of_steps_they_are_doubled_until_the_response_meets_the_accuracy(reference_scene):
    scene = reference_scene("F1", 0.1)
    fixed = simulate(scene, RATE, FixedSteps(1, estimate_error=True))
    free = simulate(scene, RATE, HalvedSteps(1e-5))
    truth = simulate(scene, RATE, FixedSteps(64)).acceleration
    assert fixed.step == 1.0 / RATE
    assert fixed.error_estimate > 1e-5
    assert free.step < fixed.step
    assert free.error_estimate < 1e-5
    assert rms(free.acceleration - truth) < 5e-5 * rms(truth)  # the factor of five that an estimate is allowed


def test_the_outer_rings_motion_is_kept_on_request_at_the_raised_rate(reference_scene):
    scene = reference_scene("G1", 0.125)
    low, high = (simulate(scene, rate, keep=Kept(outer=True)) for rate in (16384.0, 114688.0))
    assert simulate(scene, RATE).outer is None
    assert (low.rate, low.outer.rate, high.outer.rate) == (16384.0, 114688.0, 114688.0)
    as_long = low.outer.acceleration[: high.outer.acceleration.shape[0]]
    assert rms(as_long - high.outer.acceleration) < 1e-3 * rms(high.outer.acceleration)
    # The low-pass behind it looks 24 samples ahead.
    assert low.outer.velocity.shape == low.outer.displacement.shape == (7 * (low.acceleration.shape[0] + 24), 2)


@pytest.mark.parametrize(
    ("rate", "path", "factor"),
    [
        (RATE, 0.0, 1),  # its fastest mode, 10.4 kHz, is sampled 6.3 times a period
        (25600.0, 0.0, 5),  # a raised rate has ten samples: 104 kHz, 4.1 times
        (RATE, 500.0, 3),  # whatever is shaken by the outer ring is followed at three times the rate or more
        (RATE, 20000.0, 5),  # 14 samples of 20 kHz are 280 kHz: 4.3 times
        (25600.0, 12000.0, 7),  # 168 kHz: 6.6 times
        (25600.0, 500.0, 3),  # this rate holds the machine's fastest mode
        (6400.0, 500.0, 17),  # and this does not: ten samples of it, 104 kHz, 16.3 times
        (17580.0, 500.0, 6),  # nor does this: its half is 8.79 kHz, and ten samples are 5.9 times
    ],
)
def test_the_rate_is_raised_for_machine_and_sensor_path(reference_scene, rate, path, factor):
    for solution in (Accurate(), FixedSteps(1)):
        trace = simulate(reference_scene("G0", 0.01), rate, solution, keep=Kept(outer=True, fastest_path=path))
        assert trace.outer.rate == factor * rate
        assert trace.outer.velocity.shape[0] == factor * (trace.acceleration.shape[0] + (24 if factor > 1 else 0))


def test_a_rate_that_holds_hardly_anything_of_what_rings_is_refused(reference_scene):
    scene = reference_scene("G0", 0.1)
    assert oversampling(scene, 700.0) == 151  # ten samples of 10.55 kHz
    with pytest.raises(SimulationFailed, match=r"600 Hz has to be raised 176 times .* at most 160 times") as caught:
        simulate(scene, 600.0)
    assert caught.value.outcome is Outcome.UNRESOLVED


@pytest.mark.parametrize("keep", [Kept(), Kept(outer=True, fastest_path=800.0)], ids=["alone", "with a path"])
@pytest.mark.parametrize("name", ["G1", "F1"])
def test_a_low_rate_takes_in_nothing_of_what_lies_above_it(reference_scene, name, keep):
    """Spectra below 0.4 of 2 kHz, where a fortieth of the response lies, beside those of 128 times the rate."""
    scene, rate, times = reference_scene(name, 0.4, slip_seed=1), 2000.0, 128
    low = simulate(scene, rate, Accurate(1e-5), keep=keep).acceleration[:, 1]
    high = simulate(scene, times * rate, Accurate(1e-5)).acceleration[:, 1]
    spectra = [np.fft.rfft(np.hanning(signal.size + 1)[:-1] * signal) for signal in (low, high)]
    kept = np.arange(round(0.4 * 0.4 * rate))
    apart = spectra[0][kept] - spectra[1][kept] / times
    assert np.linalg.norm(apart) < 1.5e-3 * np.linalg.norm(spectra[0][kept])  # four samples a period: 1.5e-2 on F1


@pytest.mark.parametrize("solution", [Accurate(1e-4), FixedSteps(4)])
@pytest.mark.parametrize("rate", [2000.0, 12800.0])
def test_a_record_at_a_low_rate_is_the_beginning_of_a_longer_one(reference_scene, rate, solution):
    longer = reference_scene("F1", 0.25, slip_seed=3)
    scene = dataclasses.replace(longer, cage=dataclasses.replace(longer.cage, duration=0.2))
    found, whole = simulate(scene, rate, solution), simulate(longer, rate, solution)
    beginning = whole.acceleration[: found.acceleration.shape[0]]
    assert np.abs(found.acceleration - beginning).max() < 2e-3 * rms(beginning)
    assert found.changes.time.size == (whole.changes.time < 0.2).sum()


def test_a_record_of_two_cages_at_a_low_rate_is_the_beginning_of_a_longer_one(reference_scene):
    longer, rate = reference_scene("F1", 0.25, slip_seed=3), 12800.0
    longer = dataclasses.replace(longer, second_cage=CagePath(0.97 * longer.cage.nominal_speed, 0.25, 0.1))
    cages = {"cage": longer.cage, "second_cage": longer.second_cage}
    shorter = {name: dataclasses.replace(cage, duration=0.2) for name, cage in cages.items()}
    found, whole = (simulate(scene, rate) for scene in (dataclasses.replace(longer, **shorter), longer))
    beginning = whole.acceleration[: found.acceleration.shape[0]]
    assert found.acceleration.shape == (2560, 2)
    assert np.abs(found.acceleration - beginning).max() < 0.01 * rms(beginning)  # each is off by 1e-3 (RMS)


@pytest.mark.parametrize("what", ["force", "outer"])
def test_the_reference_method_refuses_to_keep_what_it_does_not_follow(what, reference_scene):
    with pytest.raises(InvalidParameter, match=rf"keep\.{what} = True; Reference\(\) keeps state alone"):
        simulate(reference_scene("G0", 0.02), RATE, Reference(), keep=Kept(**{what: True}))
