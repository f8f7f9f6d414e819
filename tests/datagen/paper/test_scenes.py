import math

import numpy as np
import pytest

from datagen.paper.scenes import (
    DEEPEST,
    bpfo_hz,
    ftf_hz,
    machine,
    reference_extended_spall,
    scene,
    shaft_hz,
    waved_extended_spall,
    wavy_extended_spall,
)
from physics.paths.profile import race_depth
from physics.reference_scenes import gap_line_spall, line_spall

FLOOR = np.radians(np.linspace(249.0, 291.0, 20001))


def depth(spall):
    return race_depth(scene("gearbox", spall), 1, FLOOR)


@pytest.mark.parametrize("seed", range(4))
def test_wavy_profiles_stay_between_the_race_and_15_um_below_it(seed):
    found = depth(wavy_extended_spall(seed))
    # The spline through the cut waves swings past the cut by little more than 0.1 um.
    assert found.max() <= DEEPEST + 0.1e-6
    assert found.min() > -0.15e-6


def test_one_wave_along_the_spall_has_its_length():
    found = depth(waved_extended_spall(7e-6, 3e-6, math.radians(5.0), 0.0))
    inner = np.abs(FLOOR - math.radians(270.0)) < math.radians(17.0)
    level = found[inner] - 7e-6
    crossings = np.count_nonzero(np.diff(np.sign(level)) != 0)
    assert crossings in (13, 14)  # 34 degrees hold 6.8 waves of two crossings each
    assert np.abs(level).max() == pytest.approx(3e-6, rel=0.01)  # nodes of the spline miss a crest by less


def test_the_reference_spalls_are_those_of_the_reference_scenes():
    line, gap, extended = line_spall("fan"), gap_line_spall("gearbox"), reference_extended_spall(0)
    assert (line.depth, line.entry_taper, line.exit_taper) == (12e-6, math.radians(0.3), math.radians(0.3))
    assert (line.extent, gap.extent) == (math.radians(2.6), math.radians(2.0))
    assert gap.profile == "ball_path"
    assert (extended.extent, extended.depth, extended.roughness) == (math.radians(40.0), 6e-6, 2e-6)
    assert np.std(extended.roughness_values) == pytest.approx(2e-6, rel=1e-6)  # values are rounded to 1e-12 m


def test_frequencies_are_those_of_the_printed_geometry():
    assert bpfo_hz("gearbox") == pytest.approx(34.283, abs=0.0005)
    assert bpfo_hz("fan") == pytest.approx(76.74, abs=0.005)
    assert bpfo_hz("gearbox") == pytest.approx(12.0 * ftf_hz("gearbox"))
    assert shaft_hz("gearbox") == pytest.approx(7.0)


def test_without_slip_the_cage_is_steady_and_a_seed_makes_it_wander():
    assert scene("fan").cage.knot_values == ()
    slipping = scene("fan", slip_seed=1, slip=0.02).cage
    assert np.std(slipping.knot_values) == pytest.approx(0.02, rel=0.3)  # a hundred or so correlation times
    assert machine("fan").bearing.balls == 14
