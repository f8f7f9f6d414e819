"""What a march has written, as a trace: forces that a law allows."""

from dataclasses import replace

import numpy as np
import pytest

from physics.assembly import assemble
from physics.integrators.output import PULLED, TOUCHED, UNLOCATED, Grid
from physics.response.march_output import empty_output, trace_of
from physics.trace import Kept


@pytest.mark.parametrize(("law", "lowest"), [("paper", -1e-6), ("no_tension", 0.0)])
def test_a_force_below_zero_by_what_a_step_is_wrong_is_kept_only_where_contacts_may_pull(law, lowest, reference_scene):
    scene = replace(reference_scene("G0", 0.01), contact_law=law)
    output = empty_output(assemble(scene), 2, 1, Kept(force=True))
    output.force[:] = np.array([[-1e-6], [5.0]])
    force = trace_of(scene, Grid(2, 1, 1e-5), output, "by hand").contact_force
    assert force[0] == pytest.approx(np.full(force[0].shape, lowest), rel=1e-12)  # its contact angle is zero
    assert force[1] == pytest.approx(np.full(force[1].shape, 5.0), rel=1e-12)


def test_what_a_march_counted_is_told(reference_scene):
    scene = reference_scene("G0", 0.01)
    output = empty_output(assemble(scene), 3, 1, Kept())
    output.tally[UNLOCATED] = 3
    output.touched[[TOUCHED, PULLED]] = 4.0, 1.0
    trace = trace_of(scene, Grid(3, 4, 1e-5), output, "by hand")
    assert (trace.unlocated_changes, trace.tension_share) == (3, 0.25)
    assert (trace.rate, trace.step) == (pytest.approx(25000.0), 1e-5)  # four steps a sample
    assert trace.time == pytest.approx([0.0, 4e-5, 8e-5])
