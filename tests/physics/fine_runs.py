"""The nonlinear model by fine fixed steps, to hold simpler models against."""

from physics.request import FixedSteps
from physics.simulate import simulate
from physics.trace import ACCELERATION_ALONE

RATE = 65536.0


def nonlinear(scene, keep=ACCELERATION_ALONE):
    return simulate(scene, RATE, FixedSteps(2), keep=keep)
