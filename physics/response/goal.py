"""What a response is to reach, the tolerance of the steps that lead there, and the error that they leave.

The modal method measures every step by the momentum it may be wrong by. What such a push leaves in the resonator's
acceleration follows from the modes alone. So the accuracy asked for, the size of the signal seen so far and a usual
number of pushes a second give the tolerance. The sum of the errors made gives the estimate of the whole, times what a
pilot shows that this scene makes of them: contact changes can multiply an error.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from physics.integrators.modal.memory import STRIDES, ModalGrid
from physics.integrators.output import LOGGED, Output
from physics.response.modal_case import USUAL_PUSHES, Case, March
from physics.response.silence import largest_forces
from physics.rms import rms
from physics.trace import Kept

GoOn = Callable[[March, ModalGrid], Output]

# Errors are up to this many times what the errors of the steps add up to, or SENSITIVE times what a short pilot made of
# them if that is more: measured on the reference scenes and on scenes of the wide corpus that are not chaotic.
ERROR_FACTOR, SENSITIVE = 3.5, 6.0
# Of the accuracy asked for, what the tolerance aims at before errors are known, and what the estimate then aims at.
AIM, MARGIN = 0.1, 0.75
# No tolerance is below the first share of the acceleration that the load would give the outer ring, nor below the
# second of what the largest forces do in a sample: they are not known better.
SMALLEST_SHARE, ROUND_OFF = 1e-8, 1e-13
# The tolerance of a coarse response, relative.
COARSE = 1e-3
# The size that a signal is said to have counts like that of so many samples: one that is known stays, one that is
# guessed soon gives way to what is seen.
KNOWN, GUESSED = 1e9, 512.0
# A `spending` that no errors use up.
UNLIMITED = 1e9


@dataclass(frozen=True)
class Goal:
    """Responses of a `case` over `samples`, wanted to the relative RMS `accuracy`, or to `least_error` (m/s², RMS) if
    that is more; `keep` is what a March is to keep of them, and `go_on` may end them before all samples."""

    case: Case
    samples: int
    accuracy: float
    least_error: float
    keep: Kept
    go_on: GoOn

    def begin(self) -> March:
        """A march that has not set out."""
        return March(self.case, self.samples, self.keep)

    def anew(self, grid: ModalGrid) -> Output:
        """A response from the start, on `grid`."""
        return self.go_on(self.begin(), grid)

    def coarse(self, size: float) -> Output:
        """A response with several times the tolerance that a signal of this `size` (m/s², RMS) asks for."""
        share = max(COARSE, self.allowed(size) / size) if size > 0.0 else COARSE
        grid = steady(self.case, self.samples, share, size)
        return perturbed_response(self.case, grid, self.go_on)

    def allowed(self, size: float) -> float:
        """The error (m/s², RMS) that is allowed of a signal of this `size` (m/s², RMS)."""
        return max(self.accuracy * size, self.least_error)

    def error(self, output: Output, sensitivity: float) -> float:
        """Estimated error (m/s², RMS) of the `output` of a scene of this sensitivity."""
        return ERROR_FACTOR * safety_factor(sensitivity) * self.case.pushed(output)

    def aimed(self, seen: float, aim: float, sensitivity: float) -> ModalGrid:
        """A grid whose tolerance is this `aim` of the accuracy at first, of a signal whose mean square may be `seen`
        (m²/s⁴), and then what leaves the estimated error within it."""
        spending = 2.0 * USUAL_PUSHES * (MARGIN / (ERROR_FACTOR * safety_factor(sensitivity) * aim)) ** 2
        return _grid(
            self.case,
            self.samples,
            share=aim * self.accuracy,
            least_error=aim * self.least_error,
            seen=seen,
            weight=GUESSED,
            spending=spending,
        )


def steady(case: Case, samples: int, share: float, size: float, spending: float = UNLIMITED) -> ModalGrid:
    """A grid whose tolerance is this `share` of a signal of known `size` (m/s², RMS), whatever errors it leaves.

    As these do not use up an unlimited `spending`, it grows to four times that within 1536 samples (`set_tolerance`).
    """
    return _grid(case, samples, share=share, least_error=0.0, seen=size**2, weight=KNOWN, spending=spending)


def _grid(
    case: Case, samples: int, *, share: float, least_error: float, seen: float, weight: float, spending: float
) -> ModalGrid:
    """A grid for errors of this `share` of the signal, or `least_error` (m/s², RMS) if that is more; `seen` (m²/s⁴) is
    what to take for the signal's mean square, with the `weight` of so many samples, and `spending` as in ModalGrid."""
    floor = share * SMALLEST_SHARE * abs(case.scene.operation.load) / case.scene.rig.outer_mass
    return ModalGrid(
        samples=samples,
        interval=1.0 / case.rate,
        levels=len(STRIDES),
        share=share * case.push * math.sqrt(0.5),
        least=max(case.push * max(least_error, floor), ROUND_OFF * largest_forces(case.scene) / case.rate),
        seen=2.0 * seen,
        seen_samples=weight,
        spending=spending,
    )


def perturbed_response(case: Case, grid: ModalGrid, go_on: GoOn = March.go_on) -> Output:
    """A response on a `steady` grid that starts with a deliberate error, as large as one step may make, and counts it.

    Otherwise two responses that happen to take the same steps make the same errors, and hide how errors grow.
    """
    push = max(grid.least, grid.share * math.sqrt(grid.seen))
    output = go_on(March(case, grid.samples, push=push), grid)
    output.spent[0] += push * push
    return output


def finer(grid: ModalGrid, share: float) -> ModalGrid:
    """A grid with this share of the tolerance."""
    return grid._replace(share=share * grid.share, least=share * grid.least)


def safety_factor(sensitivity: float) -> float:
    """How many times more exact the steps of a scene have to be than those of one that makes nothing of errors."""
    return max(1.0, SENSITIVE * sensitivity / ERROR_FACTOR)


def observed_sensitivity(case: Case, coarse: Output, fine: Output) -> float:
    """The sensitivity that two responses show: how many times the errors of its steps the `coarse` one is apart from
    the `fine` one."""
    pushed = case.pushed(coarse)
    return rms_distance(coarse, fine) / pushed if pushed > 0.0 else 0.0


def rms_distance(one: Output, other: Output, share: float = 1.0) -> float:
    """How far two responses are apart (m/s², RMS) in this share of the samples, as long as both last."""
    both = math.ceil(share * min(one.acceleration.shape[0], other.acceleration.shape[0]))
    return rms(one.acceleration[:both] - other.acceleration[:both])


def fewest_touching(output: Output) -> int:
    """The smallest number of balls that touched at the same time; the rings part where it is 0."""
    made = output.change_made[: output.tally[LOGGED]]
    touching = output.initial.sum() + np.cumsum(np.where(made, 1, -1))
    return int(touching.min(initial=output.initial.sum()))
