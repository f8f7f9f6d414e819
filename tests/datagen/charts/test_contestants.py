"""Who takes part in a chart: our methods and their rivals, which reach the same response."""

import numpy as np
import pytest

from datagen.charts import contestants as entrants
from datagen.charts.response import of_states, of_trace
from datagen.charts.response_errors import response_errors
from datagen.drawing.work_precision import (
    RIVAL_COLOURS,
    RIVAL_STYLES,
)
from physics.integrators.rivals.general_purpose import (
    BALL_BY_BALL,
    CONTACT_KERNEL,
    PAIRS,
    integrate_by_fixed_steps,
    integrate_compiled,
)
from physics.reference_scenes import reference_scene
from physics.request import FixedSteps
from physics.rms import relative_error
from physics.simulate import simulate
from physics.trace import Kept

RATE = 65536.0


@pytest.mark.parametrize("kind_of_slope", [BALL_BY_BALL, CONTACT_KERNEL])
@pytest.mark.parametrize("pair", PAIRS)
def test_the_compiled_rivals_reach_the_same_response_without_locating_anything(pair, kind_of_slope):
    scene = reference_scene("F1", 0.03)
    exact = simulate(scene, RATE, FixedSteps(16))
    samples = exact.time.size
    start = entrants.start_of(scene)
    states, evaluations = integrate_compiled(scene, pair, kind_of_slope, start, RATE, samples, 1e-8)
    found = of_states(scene, RATE, states)
    assert relative_error(found.acceleration, exact.acceleration) < 1e-3  # steps over jumps of force
    assert evaluations > 8 * samples  # a dozen stages for a step of about a sample
    loose, fewer = integrate_compiled(scene, pair, kind_of_slope, start, RATE, samples, 1e-4)
    assert fewer < evaluations
    assert not np.array_equal(loose, states)


@pytest.mark.parametrize("kind_of_slope", [BALL_BY_BALL, CONTACT_KERNEL])
def test_fixed_steps_through_changes_of_contact_reach_the_same_response_slowly(kind_of_slope):
    scene = reference_scene("F1", 0.03)
    exact = simulate(scene, RATE, FixedSteps(16))
    start = entrants.start_of(scene)

    def error(substeps):
        states = integrate_by_fixed_steps(scene, kind_of_slope, start, RATE, exact.time.size, substeps)
        return relative_error(of_states(scene, RATE, states).acceleration, exact.acceleration)

    coarse, fine = error(16), error(64)
    # Over a jump of force any method is of order 1: a quarter of the step, a quarter of the error, or a little less.
    assert coarse / 16.0 < fine < coarse / 2.5
    assert fine < 1e-3


def test_every_rival_has_a_colour_and_a_style():
    for one in entrants.contestants(reference_scene("F1", 0.03), quick=False):
        if one.group in (entrants.COMPILED, entrants.SCIPY):
            kind, solver = one.name.split(",")[0].split()
            assert solver in RIVAL_COLOURS
            assert kind in RIVAL_STYLES


@pytest.mark.parametrize("kind_of_slope", [BALL_BY_BALL, CONTACT_KERNEL])
@pytest.mark.parametrize("solver", entrants.NUMBALSODA)
def test_numbalsoda_reaches_the_same_response_where_it_is_installed(solver, kind_of_slope):
    pytest.importorskip("numbalsoda", reason="numbalsoda needs a Fortran compiler to install")
    scene = reference_scene("F1", 0.03)
    exact = simulate(scene, RATE, FixedSteps(16))
    name = f"numbalsoda {solver}, {kind_of_slope}"
    finest = [one for one in entrants.contestants(scene, quick=False) if one.name == name][-1]
    found = finest.read(scene, RATE, finest.run(scene, RATE))
    assert relative_error(found.acceleration, exact.acceleration) < 1e-3  # steps over jumps of force


def test_numbalsoda_takes_part_only_where_it_is_installed(monkeypatch):
    monkeypatch.setattr(entrants, "find_spec", lambda name: None)
    names = {one.name for one in entrants.contestants(reference_scene("F1", 0.03), quick=True)}
    assert not any("numbalsoda" in name for name in names)
    assert f"compiled DOP853, {CONTACT_KERNEL}" in names


def test_the_default_has_an_error_of_its_stiffness_and_is_timed_without_keeping_its_state():
    scene = reference_scene("F1", 0.2)
    exact = of_trace(simulate(scene, RATE, FixedSteps(4), keep=Kept(state=True)))
    chosen = [one for one in entrants.contestants(scene, quick=True) if one.name.startswith("modal")]
    for one in chosen:
        result = one.run(scene, RATE)
        assert one.read(scene, RATE, result).displacement is None
        assert 0.0 < response_errors(scene, RATE, one.response(scene, RATE, result), exact).stiffness < 0.01
    assert chosen
