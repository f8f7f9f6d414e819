"""The simpler models: what they give and refuse."""

import dataclasses
import math

import numpy as np
import pytest

from physics.checks import InvalidParameter
from physics.ladder.model_table import SIMPLER_MODELS
from physics.outcome import Outcome, SimulationFailed
from physics.request import Simpler
from physics.rms import rms
from physics.simulate import simulate
from physics.trace import ACCELERATION_ALONE, KEEPABLE, Kept

RATE = 65536.0


@pytest.mark.parametrize("name", SIMPLER_MODELS)
def test_every_model_gives_a_trace_of_the_same_shape_and_says_which_it_is(name, reference_scene):
    trace = simulate(reference_scene("G1", 0.05), RATE, Simpler(name))
    assert trace.model == name
    assert trace.acceleration.shape == (round(0.05 * RATE), 2)
    assert np.all(np.isfinite(trace.acceleration))
    assert math.isnan(trace.error_estimate)
    assert trace.changes.initial.shape == (2, 12)


def test_an_unknown_model_is_refused_with_the_known_ones():
    with pytest.raises(InvalidParameter, match='model = "spice"; allowed: impulse train, quasi-static, linear'):
        Simpler("spice")


@pytest.mark.parametrize("name", SIMPLER_MODELS)
@pytest.mark.parametrize("what", KEEPABLE)
def test_what_a_model_does_not_know_is_refused_and_what_it_knows_is_there(name, what, reference_scene):
    scene, keep = reference_scene("G1", 0.01), Kept(**{what: True})
    if what in SIMPLER_MODELS[name].keeps:
        trace = simulate(scene, RATE, Simpler(name), keep=keep)
        assert (trace.state if what == "state" else trace.contact_force).shape[0] == trace.time.size
    else:
        with pytest.raises(InvalidParameter, match=rf"keep\.{what} = True; Simpler\(model='{name}'\) keeps "):
            simulate(scene, RATE, Simpler(name), keep=keep)


@pytest.mark.parametrize("rate", [1000.0, 6000.0, 16384.0])
def test_models_that_ring_keep_their_size_at_rates_too_low_for_their_modes(rate, reference_scene):
    scene = reference_scene("G1", 0.3)
    for name in ("linear time-varying", "impulse train"):
        low, high = simulate(scene, rate, Simpler(name)), simulate(scene, RATE, Simpler(name))
        assert low.acceleration.shape == (round(0.3 * rate), 2)
        below = np.abs(np.fft.rfft(high.acceleration[:, 1]))[: round(0.4 * 0.3 * rate)] / RATE
        kept = np.abs(np.fft.rfft(low.acceleration[:, 1]))[: below.size] / rate
        assert rms(kept) == pytest.approx(rms(below), rel=0.02)  # ripple of the filter, and the ends of the record


@pytest.mark.parametrize("name", SIMPLER_MODELS)
def test_no_model_gives_a_trace_where_no_position_carries_the_load(name, reference_scene):
    scene = reference_scene("G1", 0.02)
    soft = dataclasses.replace(scene.rig, bearing=dataclasses.replace(scene.rig.bearing, load_deflection=1e5))
    crushed = dataclasses.replace(scene, rig=soft, operation=dataclasses.replace(scene.operation, load=1e7))
    with pytest.raises(SimulationFailed, match=r"of 1e\+07 N") as failure:
        simulate(crushed, RATE, Simpler(name))
    assert failure.value.outcome is Outcome.NO_START


@pytest.mark.parametrize("name", ["G1", "F1p", "F2r"])
def test_contact_changes_alone_are_those_of_balls_whose_force_was_kept(name, reference_scene):
    scene, model = reference_scene(name, 0.1, slip_seed=2), Simpler("quasi-static")
    alone, kept = (simulate(scene, RATE, model, keep=keep) for keep in (ACCELERATION_ALONE, Kept(force=True)))
    assert (alone.state, alone.contact_force) == (None, None)
    touching, changes = kept.contact_force > 0.0, alone.changes
    sample, row, ball = np.nonzero(touching[1:] != touching[:-1])  # in the order of time
    assert changes.time == pytest.approx((sample + 0.5) / RATE, rel=1e-12)
    assert (changes.row - 1).tolist() == row.tolist()
    assert (changes.ball - 1).tolist() == ball.tolist()
    assert changes.made.tolist() == touching[sample + 1, row, ball].tolist()
    assert np.array_equal(changes.initial, touching[0])
    assert changes.time.size > 10
