"""How a response is wanted: the kinds of solution, each with the choices that it has, and the lead-in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from physics.checks import require_between, require_count, require_not_negative, require_one_of
from physics.integrators.method_table import MARCHES
from physics.ladder.model_table import SIMPLER_MODELS
from physics.response.finer_paths import FINENESS
from physics.response.part import LARGEST_ACCURACY, SMALLEST_ACCURACY
from physics.response.stability import MOST_STABLE_SUBSTEPS
from physics.trace import KEEPABLE

USUAL_STEPS = "exponential_rk4"


@dataclass(frozen=True)
class Accurate:
    """The nonlinear model to a stated accuracy, by the modal method, which chooses its own steps.

    It says what error it made: an `error_estimate` above the `accuracy` says that it was not reached, as where edges
    are narrower than the shortest step, or that the response is chaotic. With a lead-in both are of what comes from
    t = 0 on.

    `accuracy`: relative RMS error of the acceleration that is allowed, 1e-6 to 0.1.
    `least_error` (m/s², RMS): an error that is always allowed, as is rounding of forces (physics/response/silence.py).
    `repeat`: whether, where nothing slips and the acceleration alone is kept, it stops when the response repeats itself
        from ball to ball.
    `path_fineness`: how many times as many cells as usual the paths of balls over spalls have, 1 to 16. None: 1, and
        below an accuracy of 1e-4 as many as it needs (physics/response/finer_paths.py), which counts in the estimate.

    Raises InvalidParameter for a value out of range.
    """

    accuracy: float = 1e-3
    least_error: float = 0.0
    repeat: bool = True
    path_fineness: int | None = None
    keeps: ClassVar[tuple[str, ...]] = KEEPABLE

    def __post_init__(self) -> None:
        _require_accuracy(self.accuracy)
        require_not_negative("least_error", self.least_error, "m/s²")
        if self.path_fineness is not None:
            require_count("path_fineness", self.path_fineness, 1, FINENESS[-1])


@dataclass(frozen=True)
class FixedSteps:
    """The nonlinear model by `substeps` steps a sample of a `method` of integrators.method_table.MARCHES.

    `substeps`: 1 to 1024 a sample of the rate that is marched at, which is a multiple of the one asked for where that
    does not hold the resonator; None for the fewest that are stable and resolve the fastest mode.
    `estimate_error`: a second response says what error was made: at half the step or, where balls pass a taper or floor
    within a step, at a shorter one or by `exponential_rk4`.

    Raises InvalidParameter for a number of steps out of range or another method.
    """

    substeps: int | None = None
    method: str = USUAL_STEPS
    estimate_error: bool = False
    keeps: ClassVar[tuple[str, ...]] = KEEPABLE

    def __post_init__(self) -> None:
        if self.substeps is not None:
            require_count("substeps", self.substeps, 1, MOST_STABLE_SUBSTEPS)
        require_one_of("method", self.method, MARCHES)


@dataclass(frozen=True)
class HalvedSteps:
    """The nonlinear model by a `method` of integrators.method_table.MARCHES, to a stated accuracy.

    Steps are halved, down to 32 a sample of the rate that is marched at (see FixedSteps), until the response differs
    from one at half the step by no more than the `accuracy`, a relative RMS error of the acceleration, 1e-6 to 0.1.
    Where a ball passes a taper or the floor of a spall within a step, which halving leaves as it is, they are held
    against shorter steps, up to 256 a sample.

    Raises InvalidParameter for an accuracy out of range or another method.
    """

    accuracy: float = 1e-3
    method: str = USUAL_STEPS
    keeps: ClassVar[tuple[str, ...]] = KEEPABLE

    def __post_init__(self) -> None:
        _require_accuracy(self.accuracy)
        require_one_of("method", self.method, MARCHES)


@dataclass(frozen=True)
class Reference:
    """The nonlinear model by the slow reference method, which follows neither forces nor its own error."""

    keeps: ClassVar[tuple[str, ...]] = ("state",)


@dataclass(frozen=True)
class Simpler:
    """A simpler `model` of ladder.model_table.SIMPLER_MODELS, by its own method.

    Raises InvalidParameter for another model.
    """

    model: str

    def __post_init__(self) -> None:
        require_one_of("model", self.model, SIMPLER_MODELS)

    @property
    def keeps(self) -> tuple[str, ...]:
        """What the model can keep besides acceleration and contact changes: fields of Kept."""
        return SIMPLER_MODELS[self.model].keeps


Solution = Accurate | FixedSteps | HalvedSteps | Reference | Simpler


@dataclass(frozen=True)
class LeadIn:
    """The machine starts `seconds` before t = 0, rounded to whole samples, so that one that runs is recorded and not
    its start; with `kept` the trace has the instants before 0 too.

    Raises InvalidParameter if that is no time.
    """

    seconds: float = 0.0
    kept: bool = False

    def __post_init__(self) -> None:
        require_not_negative("seconds", self.seconds, "s", "lead-in")

    def samples(self, rate: float) -> int:
        """Whole samples of it at `rate` (Hz)."""
        return round(self.seconds * rate)


def _require_accuracy(accuracy: float) -> None:
    require_between("accuracy", accuracy, SMALLEST_ACCURACY, LARGEST_ACCURACY)
