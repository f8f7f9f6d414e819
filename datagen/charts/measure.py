"""The measurement behind a chart: every contestant run, timed and scored against the reference on one scene."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.util import find_spec

import numpy as np

from datagen.charts.contestants import Contestant, contestants
from datagen.charts.response import Response, of_trace
from datagen.charts.response_errors import SCORED_FROM, ResponseErrors, response_errors
from datagen.charts.scenes import Subject
from datagen.progress import Say
from datagen.versions import measured_on
from physics.integrators.method import NO_MODES
from physics.integrators.method_table import METHODS, REFERENCE
from physics.ladder.model_table import SIMPLER_MODELS
from physics.outcome import SimulationFailed
from physics.request import FixedSteps, Reference
from physics.response.stability import longest_stable_step
from physics.scene import Scene
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium
from physics.trace import Kept
from physics.warming import warm_up

WARM_UP = 0.004
SMALLEST_ERROR = 1e-300  # of a method that is its own reference
QUICK_DURATION, QUICK_STEPS = 0.2, 32
PART, PART_PASSES = 0.05, 1.1
SLOW_SECONDS = 0.5
# What is fast is repeated for this long (s) at least: other users of a machine slow it for moments.
LEAST_SECONDS = 0.1
TARGET = 1e-3
RIVAL = "numbalsoda"


@dataclass(frozen=True)
class Run:
    """One contestant at one setting: `seconds` of processor for `duration` (s) of signal.

    What takes less than 0.5 s is repeated, and `seconds` is the median. `real_time` is duration over seconds; `failure`
    the sentence with which it gave up, or empty; `substeps` the steps a sample of a method with fixed steps.
    """

    group: str
    name: str
    setting: str
    duration: float
    seconds: float
    real_time: float
    score: ResponseErrors | None
    failure: str
    substeps: int | None = None


@dataclass(frozen=True)
class Chart:
    """All runs on one scene, where each method stops being stable, and with what it was measured.

    `edges`: times real time at which a fixed-step method would be at its longest stable step, by name.
    `best`: times real time at an acceleration error of 1e-3, by name, interpolated; null if not reached.
    `contracts`: what each method and simpler model states of itself, by name.
    """

    subject: str
    title: str
    rate: float
    duration: float
    reference: str
    rounds: int
    runs: tuple[Run, ...]
    edges: dict[str, float]
    best: dict[str, float | None]
    contracts: dict[str, dict[str, object]]
    made_with: dict[str, str]


def measure(subject: Subject, quick: bool, rounds: int, step: Say) -> Chart:
    """Run everything on `subject`; `step` is called with the name of every contestant before it is run.

    Raises SimulationFailed where the scene has no reference, being one that cannot be simulated.
    """
    scene = subject.lasting(min(subject.scene.duration, QUICK_DURATION)) if quick else subject.scene
    step("reference")
    warm_up()
    request = FixedSteps(QUICK_STEPS) if quick else Reference()
    reference = of_trace(simulate(scene, subject.rate, request, keep=Kept(state=True)))
    runs = []
    entered = contestants(scene, quick)
    for number, contestant in enumerate(entered, 1):
        step(f"{number} of {len(entered)}: {contestant.name} {contestant.setting}".rstrip())
        runs.append(_run(contestant, subject, scene, reference, rounds))
    return Chart(
        subject=subject.name,
        title=subject.title,
        rate=subject.rate,
        duration=scene.duration,
        reference=f"exponential_rk4, {QUICK_STEPS} steps a sample" if quick else METHODS[REFERENCE].title,
        rounds=rounds,
        runs=tuple(runs),
        edges=stability_edges(scene, subject.rate, runs),
        best={name: at_error(runs, name, TARGET) for name in dict.fromkeys(run.name for run in runs)},
        contracts=contracts(),
        made_with=made_with(),
    )


def contracts() -> dict[str, dict[str, object]]:
    """The contract of each numerical method and each simpler model (order, stability limit …), by name."""
    stated: Mapping[str, object] = {**METHODS, **SIMPLER_MODELS}
    return {
        name: {key: value for key, value in vars(contract).items() if key not in ("name", "respond")}
        for name, contract in stated.items()
    }


def made_with() -> dict[str, str]:
    """Processor, physics and versions, for the record of a measurement."""
    rival = [RIVAL] if find_spec(RIVAL) else []
    return {RIVAL: "not installed"} | measured_on("numpy", "scipy", "numba", *rival)


def errors_and_speeds(runs: Sequence[Run], name: str) -> list[tuple[float, float]]:
    """Acceleration error and times real time of each run of a contestant that has a finite error."""
    scored = [(run.score.acceleration, run.real_time) for run in runs if run.name == name and run.score is not None]
    return [point for point in scored if math.isfinite(point[0])]


def at_error(runs: Sequence[Run], name: str, error: float) -> float | None:
    """Times real time of a contestant at this acceleration error, interpolated on the logarithms; None if not reached.

    Where even its coarsest run is better, that run counts.
    """
    points = sorted(errors_and_speeds(runs, name))
    reached = [point for point in points if point[0] <= error]
    if not reached:
        return None
    best = max(speed for _, speed in reached)
    beyond = [point for point in points if point[0] > error]
    if not beyond:
        return best
    inside, outside = reached[-1], beyond[0]
    least = max(inside[0], SMALLEST_ERROR)
    share = math.log(error / least) / math.log(outside[0] / least)
    between = math.exp(math.log(inside[1]) + share * math.log(outside[1] / inside[1]))
    return max(best, between)


def _run(contestant: Contestant, subject: Subject, scene: Scene, reference: Response, rounds: int) -> Run:
    if contestant.part:
        passes = PART_PASSES * scene.rig.bearing.spacing / scene.cage.mean_speed
        scene = subject.lasting(min(scene.duration, SCORED_FROM + max(PART, passes)))
    unmeasured = Run(
        group=contestant.group,
        name=contestant.name,
        setting=contestant.setting,
        duration=0.0,
        seconds=math.nan,
        real_time=math.nan,
        score=None,
        failure="",
        substeps=contestant.substeps,
    )
    try:
        contestant.run(subject.lasting(WARM_UP), subject.rate)
        seconds, result = timed(contestant, scene, subject.rate, rounds)
        response = contestant.response(scene, subject.rate, result)
    except SimulationFailed as failure:
        return replace(unmeasured, failure=str(failure))
    return replace(
        unmeasured,
        duration=scene.duration,
        seconds=seconds,
        real_time=scene.duration / seconds,
        score=response_errors(scene, subject.rate, response, reference),
    )


def timed(contestant: Contestant, scene: Scene, rate: float, rounds: int) -> tuple[float, object]:
    """Median processor time (s) of the rounds, or of more where these are short, and the result; what takes half a
    second or longer is run once.

    A first run pays for memory and code that only a whole record needs, so that it does not count where it is short.
    """

    def once() -> tuple[float, object]:
        begin = time.process_time()
        result = contestant.run(scene, rate)
        return time.process_time() - begin, result

    first, result = once()
    if first >= SLOW_SECONDS:
        return first, result
    seconds: list[float] = []
    while len(seconds) < rounds or sum(seconds) < LEAST_SECONDS:
        spent, result = once()
        seconds.append(spent)
    return statistics.median(seconds), result


def stability_edges(scene: Scene, rate: float, runs: list[Run]) -> dict[str, float]:
    """Speed, in times real time, that each method would reach with its longest stable step, by its coarsest run."""
    rest = equilibrium(scene, np.zeros(1))
    edges = {}
    for name, method in METHODS.items():
        coarsest = next((run for run in runs if run.name == name and run.substeps and not run.failure), None)
        if method.limits != NO_MODES and coarsest is not None and coarsest.substeps:
            longest = longest_stable_step(scene.rig, method, rest.stiffness[0], rest.damping[0])
            edges[name] = coarsest.real_time * longest * rate * coarsest.substeps
    return edges
