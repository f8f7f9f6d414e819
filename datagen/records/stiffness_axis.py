"""How finely in time the quasi-static stiffness is solved and stored: no finer than its accuracy needs.

The accuracy asked for is an error of linear interpolation onto the record's samples of at most 1e-4 of kyy (RMS over
the record, each component). Stiffness has a corner of the form tⁿ⁻¹ (√t for balls) wherever a ball takes or loses its
load, so this error is C d f / rate with d the samples between nodes, f the ball-pass frequency of the outer race and C
a number of the machine. Measured at 65 536 Hz with d = 2, 8 and 32, 0.3 to 3 times rated speed, 0.1 to 5 times rated
load, five rigs, 60 scenes each, C's largest values were:

    healthy, clearance up to twice the compression of the loaded ball: 6.2 Nb^-1.5 / rows (unequal balls alike)
    healthy, more clearance: grows, never faster than in proportion to it
    healthy, a load that turns or swings: as under its smallest magnitude, down to a fortieth of its largest
    healthy, rollers (n = 10/9): 0.7, growing towards small d
    healthy, 0 to 2 µm of waviness in each of 58 orders: 0.9
    spalled: line 1.8, extended 2.4, rough 7 (medians 0.2 to 1.3)

Only the first three leave room at rated speed for a coarser axis (d = 2 on the gearbox rig, 1 on the fan rig); for the
others C d f / rate ≤ 1e-4 would need d < 1, so they are solved at every sample.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from datagen.scenarios.scenario import Scenario
from physics.angular_speed import in_hertz
from physics.scene import Scene
from physics.statics.load_distribution import load_range

ACCURACY = 1e-4
CORNER = 6.3
FREE_CLEARANCE = 2.0
LEAST_SHARE = 0.025
POINT_CONTACT_EXPONENT = 1.4
COARSEST = 64
ShardKey = tuple[float, float, int, int, int]


def stiffness_divisor(scenario: Scenario) -> int:
    """Samples between two nodes of the stiffness axis: a power of two from 1 to 64."""
    scene = scenario.scene
    smooth = scene.rig.bearing.exponent >= POINT_CONTACT_EXPONENT
    if scene.spalls or scene.imperfections.waviness or not smooth or load_range(scene)[1] == 0.0:
        return 1
    bearing = scene.rig.bearing
    passes_per_sample = in_hertz(bearing.bpfo * scene.operation.shaft_speed) / scenario.rate
    allowed = ACCURACY / (_corner(scene) * passes_per_sample)
    return int(2.0 ** math.floor(math.log2(min(max(allowed, 1.0), COARSEST))))


def _corner(scene: Scene) -> float:
    bearing, (smallest_load, largest_load) = scene.rig.bearing, load_range(scene)
    # A load that all but vanishes turns around in a moment, and the stiffness with it.
    if smallest_load < LEAST_SHARE * largest_load:
        return math.inf
    compression = bearing.compression(bearing.stribeck_peak_load(smallest_load))
    looseness = bearing.clearance / (FREE_CLEARANCE * compression)
    return CORNER * bearing.balls**-1.5 * bearing.rows**-1.0 * max(1.0, looseness)


def stiffness_axis(scenario: Scenario) -> NDArray[np.float64]:
    """Times (S,) at which the stiffness is solved, s: every d-th sample from 0 to the last sample or just beyond."""
    divisor = stiffness_divisor(scenario)
    nodes = -(-(scenario.samples - 1) // divisor) + 1
    return np.arange(nodes) * divisor / scenario.rate


def interpolation_error(scenario: Scenario, stiffness: NDArray[np.float64]) -> float:
    """Estimated RMS error of interpolating a stored trace (3, S) onto the samples, over the mean of kyy; 0 at d = 1.

    The worst component's error at each node if it were left out, halved, as the error is in proportion to d. A corner
    √t leaves three quarters of that on average in a cell; the rest covers the scatter with the corners' places.
    """
    if stiffness_divisor(scenario) == 1 or stiffness.shape[1] < 3:
        return 0.0
    missed = stiffness[:, 1:-1] - 0.5 * (stiffness[:, :-2] + stiffness[:, 2:])
    return float(0.5 * np.sqrt(np.mean(missed**2, axis=1)).max() / stiffness[1].mean())


def shard_key(scenario: Scenario) -> ShardKey:
    """What the records of one shard have in common: rate, duration, balls, rows and samples between stiffness nodes."""
    bearing = scenario.scene.rig.bearing
    return (scenario.rate, scenario.duration, bearing.balls, bearing.rows, stiffness_divisor(scenario))
