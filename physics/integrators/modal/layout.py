"""Where the weights of a step, and of a sample inside a step, lie in their row of numbers."""

from __future__ import annotations

from physics.integrators.modal.flow import OUTER, OUTER_ACCELERATION, OUTER_SPEED, OUTPUT, PAIRS, PER_AXIS

# The contact force of a step is a polynomial in the share of the step, of this many powers.
POWERS = 5
# Weights of a step along x; those along y follow at OTHER. The shares of the six amplitudes at its beginning in
# displacement and velocity in the middle and at the end; the free turn, four numbers a pair; what a force of 1, s, s² …
# adds to displacement and velocity in the middle and at the end, and all powers to each of the six amplitudes.
# In the middle a power less is read. MOTION_READINGS: displacement and velocity.
HALF_POWERS = 4
TURN_NUMBERS, MOTION_READINGS = 4, 2
HALF, END = 0, MOTION_READINGS * PER_AXIS
TURN = END + MOTION_READINGS * PER_AXIS
AT_HALF = TURN + TURN_NUMBERS * PAIRS
AT_END = AT_HALF + MOTION_READINGS * HALF_POWERS
KICKS = AT_END + MOTION_READINGS * POWERS
OTHER = KICKS + PER_AXIS * POWERS
STEP_WEIGHTS = 2 * OTHER
# Weights of a sample inside a step along x; those along y follow at INSIDE_OTHER. Each of its readings has a SECTION:
# the shares of the amplitudes at the beginning of the step, and from POWERS_AT on those of the powers of the contact
# force. Then the free turn up to the sample, and the amplitudes that each of the powers adds by then.
INSIDE_READINGS = (OUTPUT, OUTER, OUTER_SPEED, OUTER_ACCELERATION)
POWERS_AT, SECTION = PER_AXIS, PER_AXIS + POWERS
RING_PUSHED = SECTION * INSIDE_READINGS.index(OUTER_ACCELERATION) + POWERS_AT
INSIDE_TURN = SECTION * len(INSIDE_READINGS)
INSIDE_KICKS = INSIDE_TURN + TURN_NUMBERS * PAIRS
INSIDE_OTHER = INSIDE_KICKS + PER_AXIS * POWERS
INSIDE_WEIGHTS = 2 * INSIDE_OTHER
