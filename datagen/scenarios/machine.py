"""Virtual machines: a drawn rig and bearing with their imperfections, measurement chain, background and split."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from datagen.recipes.distributions import Distribution
from datagen.recipes.machine_settings import ImperfectionSettings, MachineSettings, WavinessSettings
from datagen.recipes.recipe import FEWEST_SAMPLES, Part, Recipe, Signal, Split
from datagen.records.background import Background
from datagen.scenarios.backgrounds import draw_background
from datagen.scenarios.chain import draw_chain
from datagen.scenarios.picker import Picker
from datagen.scenarios.redraw import MOST_ATTEMPTS, Redraw, given_up
from datagen.scenarios.streams import stream
from labels.schema import SPLITS
from physics import catalog
from physics.bearing import Bearing
from physics.checks import InvalidParameter, require
from physics.imperfections import Imperfections, Waviness
from physics.rig import Rig
from physics.sensor.chain import SensorChain

DEGREES_PER_RADIAN = math.degrees(1.0)
# (setting, field, how many of the setting's units make one SI unit). Append only: the order is that of the stream.
BEARING_NUMBERS = (
    ("pitch_diameter_mm", "pitch_diameter", 1e3),
    ("ball_diameter_mm", "ball_diameter", 1e3),
    ("contact_angle_deg", "contact_angle", DEGREES_PER_RADIAN),
    ("row_offset_deg", "row_offset", DEGREES_PER_RADIAN),
    ("load_deflection", "load_deflection", 1.0),
    ("exponent", "exponent", 1.0),
    ("clearance_um", "clearance", 1e6),
)
RIG_NUMBERS = (
    ("inner_mass_kg", "inner_mass", 1.0),
    ("outer_mass_kg", "outer_mass", 1.0),
    ("resonator_mass_kg", "resonator_mass", 1.0),
    ("support_stiffness_x_n_per_m", "support_stiffness_x", 1.0),
    ("support_stiffness_y_n_per_m", "support_stiffness_y", 1.0),
    ("resonator_stiffness_n_per_m", "resonator_stiffness", 1.0),
    ("support_damping_x_n_s_per_m", "support_damping_x", 1.0),
    ("support_damping_y_n_s_per_m", "support_damping_y", 1.0),
    ("resonator_damping_n_s_per_m", "resonator_damping", 1.0),
    ("film_damping_n_s_per_m", "film_damping", 1.0),
)


@dataclass(frozen=True)
class Machine:
    """A virtual machine: everything that all its records share.

    `rate` (Hz) and `samples` say how it is recorded; `redraws` lists the impossible draws before this one.
    """

    number: int
    attempt: int
    bearing_id: str
    rig: Rig
    separate_cages: bool
    imperfections: Imperfections
    chain: SensorChain
    background: Background
    split: str
    rate: float
    samples: int
    redraws: tuple[Redraw, ...]


def draw_machine(recipe: Recipe, part: Part, number: int) -> Machine:
    """Virtual machine `number` of the recipe, which belongs to `part`; BadInput if none can be drawn."""
    redraws: list[Redraw] = []
    for attempt in range(MOST_ATTEMPTS):
        try:
            return _draw(recipe, part, number, attempt, tuple(redraws))
        except InvalidParameter as refused:
            redraws.append(Redraw("machine", attempt, refused.field, str(refused)))
    raise given_up(recipe, part, f"machine {number}", redraws)


def _draw(recipe: Recipe, part: Part, number: int, attempt: int, redraws: tuple[Redraw, ...]) -> Machine:
    def open_stream(purpose: str, item: int = 0) -> np.random.Generator:
        return stream(recipe.seed, "machine", number, purpose, attempt, item)

    def picker(purpose: str) -> Picker:
        return Picker.of(open_stream(purpose))

    rig, separate_cages = _draw_rig(part.machine, picker("machine"))
    rate, samples = _draw_signal(recipe.signal, picker("signal"))
    return Machine(
        number=number,
        attempt=attempt,
        bearing_id=f"{recipe.name}-{number:05d}",
        rig=rig,
        separate_cages=separate_cages,
        imperfections=_draw_imperfections(part.imperfections, rig.bearing, picker("imperfections")),
        chain=draw_chain(recipe.chain_of(part), rate, open_stream),
        background=draw_background(recipe.background_of(part), rate, open_stream),
        split=_split(recipe.split, float(stream(recipe.seed, "machine", number, "split").random())),
        rate=rate,
        samples=samples,
        redraws=redraws,
    )


def _draw_rig(settings: MachineSettings, pick: Picker) -> tuple[Rig, bool]:
    rig = catalog.rig(pick.word(settings.rig))
    other = pick.word(settings.bearing or settings.rig)
    bearing = catalog.bearing(other) if settings.bearing is not None else rig.bearing
    bearing = _altered_bearing(bearing, settings, pick)
    changes: dict[str, Any] = dict(_changes(settings, RIG_NUMBERS, pick))
    separate = pick.word(settings.separate_cages) == "True" and bearing.rows > 1
    return replace(rig, bearing=bearing, **changes), separate


def _altered_bearing(bearing: Bearing, settings: MachineSettings, pick: Picker) -> Bearing:
    counts = {"balls": pick.whole(settings.balls), "rows": pick.whole(settings.rows)}
    changes: dict[str, Any] = {name: value for name, value in counts.items() if value is not None}
    changes |= _changes(settings, BEARING_NUMBERS, pick)
    if "balls" in changes:
        changes.setdefault("row_offset", None)
    return replace(bearing, **changes)


def _changes(settings: MachineSettings, numbers: tuple[tuple[str, str, float], ...], pick: Picker) -> dict[str, float]:
    drawn = {field: pick.optional(_setting(settings, name), per_unit) for name, field, per_unit in numbers}
    return {field: value for field, value in drawn.items() if value is not None}


def _setting(settings: MachineSettings, name: str) -> Distribution | None:
    found: Distribution | None = getattr(settings, name)
    return found


def _draw_signal(signal: Signal, pick: Picker) -> tuple[float, int]:
    rate, duration = pick.number(signal.rate_hz), pick.number(signal.duration_s)
    samples = round(rate * duration)
    require(samples >= FEWEST_SAMPLES, f"{duration:g} s at {rate:g} Hz hold only {samples} samples", "duration_s")
    return rate, samples


def _draw_imperfections(settings: ImperfectionSettings, bearing: Bearing, pick: Picker) -> Imperfections:
    deviation = tuple(
        tuple(pick.number(settings.ball_deviation_um, 1e6) for _ in range(bearing.balls)) for _ in range(bearing.rows)
    )
    unequal = any(value != 0.0 for row in deviation for value in row)
    waviness = tuple(wave for entry in settings.waviness for wave in _draw_waviness(entry, pick))
    return Imperfections(waviness=waviness, ball_deviation=deviation if unequal else ())


def _draw_waviness(settings: WavinessSettings, pick: Picker) -> list[Waviness]:
    race, decay = pick.word(settings.race), pick.number(settings.decay)
    first, last = settings.orders
    drawn = [
        (order, pick.number(settings.amplitude_um, 1e6), pick.number(settings.phase_deg, DEGREES_PER_RADIAN))
        for order in range(first, last + 1)
    ]
    return [
        Waviness(race, order, amplitude * (first / order) ** decay, phase)
        for order, amplitude, phase in drawn
        if amplitude > 0.0
    ]


def _split(shares: Split, number: float) -> str:
    edges = (shares.train, shares.train + shares.validation)
    return SPLITS[(number >= edges[0]) + (number >= edges[1])]
