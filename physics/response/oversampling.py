"""How many times a record's rate its simulation runs at, so that what rings is sampled finely enough."""

from __future__ import annotations

import math

from physics.integrators.propagator import fast_periods
from physics.motion import motion_model
from physics.outcome import Outcome, SimulationFailed
from physics.scene import Scene

# Samples of a period of the fastest mode, at least and at a raised rate. Contacts jump, and what that makes above half
# of the raised rate folds into the band that is kept, which at 2 kHz holds a fortieth of the whole: with four samples
# up to 1.5e-2 of that. It falls with the third power of the rate and costs little time, as steps stay as they are.
SAMPLES_PER_FAST_PERIOD, SAMPLES_WHERE_RAISED = 4.0, 10.0
# A path to the sensor follows the outer ring, whose acceleration jumps with every contact: with fewer samples, or a
# smaller multiple of the rate, what the jumps do between samples and above half the rate reaches it.
SAMPLES_PER_PATH_PERIOD, LEAST_WITH_PATH = 14.0, 3
# A mode of at most so many periods a sample lies below half the rate. Where a record with a path holds the machine's
# fastest mode, what folds is small beside that (3e-4 on F1s) without further samples.
HELD_PERIODS = 0.5
# A record's rate may be a sixteenth of the fastest mode's frequency: lower ones keep hardly anything of what rings.
MOST_OVERSAMPLING = round(16.0 * SAMPLES_WHERE_RAISED)


def needed_multiple(scene: Scene, rate: float, fastest_path: float) -> int:
    """Which multiple of `rate` (Hz) holds the fastest linear mode of `scene` with room for the filter.

    And the `fastest_path` (Hz) that the outer ring shakes, if there is one (above 0).
    """
    periods = fast_periods(motion_model(scene), 1.0 / rate)
    factor, raised = (math.ceil(periods * samples) for samples in (SAMPLES_PER_FAST_PERIOD, SAMPLES_WHERE_RAISED))
    if fastest_path > 0.0:
        for_machine = factor if periods <= HELD_PERIODS else raised
        return max(for_machine, LEAST_WITH_PATH, math.ceil(fastest_path / rate * SAMPLES_PER_PATH_PERIOD))
    return raised if factor > 1 else 1


def oversampling(scene: Scene, rate: float, fastest_path: float = 0.0) -> int:
    """The `needed_multiple`; raises SimulationFailed if it is more than is ever made."""
    factor = needed_multiple(scene, rate, fastest_path)
    if factor > MOST_OVERSAMPLING:
        fastest = max(fast_periods(motion_model(scene), 1.0), fastest_path)
        raise SimulationFailed(
            Outcome.UNRESOLVED,
            f"a rate of {rate:.6g} Hz has to be raised {factor} times to hold the fastest mode, {fastest:.4g} Hz; "
            f"at most {MOST_OVERSAMPLING} times are allowed",
        )
    return factor
