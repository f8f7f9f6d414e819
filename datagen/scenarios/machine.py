"""Virtual machines: a drawn rig and bearing with their imperfections, measurement chain, background and split."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache

from datagen.recipes.defect_settings import Combination
from datagen.recipes.recipe import Recipe
from datagen.recipes.signal_settings import FEWEST_STORED_SAMPLES, Signal
from datagen.recipes.split_settings import Split
from datagen.scenarios.background import Background
from datagen.scenarios.chain import draw_chain
from datagen.scenarios.defect import draw_spalls
from datagen.scenarios.draw import Draw
from datagen.scenarios.drawn_background import draw_background
from datagen.scenarios.drawn_rig import draw_rig
from datagen.scenarios.imperfections import draw_imperfections
from datagen.scenarios.picker import Picker
from datagen.scenarios.redraw import MOST_ATTEMPTS, given_up
from datagen.scenarios.refused import Redraw
from datagen.scenarios.turns import Turn
from labels.band import holds_a_line
from labels.envelope import resonance_band
from labels.schema import SPLITS
from physics.checks import InvalidParameter, require
from physics.imperfections import Imperfections
from physics.rig import Rig
from physics.sensor.chain import SensorChain


@dataclass(frozen=True)
class Machine:
    """A virtual machine: everything that all its records share.

    `rate` (Hz) and `samples` say how it is recorded, `settle` (s) how long it runs before each record, `envelope_band`
    (Hz) where its envelope is taken. `redraws` lists the impossible draws before this one, `turn` is its place among
    the machines with the same values of balanced settings, and `kind` is that of its own spalls, None if it has none.
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
    settle: float
    envelope_band: tuple[float, float]
    turn: Turn
    redraws: tuple[Redraw, ...]
    kind: Combination | None = None


def draw_machine(recipe: Recipe, part_index: int, number: int, place: int) -> Machine:
    """Virtual machine `number` of the recipe, the `place`-th (from 0) of the part with that index; raises BadInput if
    every attempt is impossible."""
    return _first_possible(_Wanted(recipe.hash, number, Draw(recipe, part_index, "machine", number, place)))


@dataclass(frozen=True)
class _Wanted:
    """Key of a machine in the cache: recipe hash and number alone tell machines apart; `draw` is what draws it."""

    recipe_hash: str
    number: int
    draw: Draw = field(compare=False)


@lru_cache(maxsize=4)
def _first_possible(wanted: _Wanted) -> Machine:
    """The first attempt that gives a machine; kept, because the records of a machine ask for it one after another."""
    draw, redraws, intended = wanted.draw, list[Redraw](), wanted.draw.intended
    for attempt in range(MOST_ATTEMPTS):
        try:
            return _draw(replace(draw, attempt=attempt), tuple(redraws))
        except InvalidParameter as refused:
            redraws.append(Redraw("machine", attempt, refused.field, str(refused)))
    raise given_up(draw.recipe, draw.part, f"machine {wanted.number}", redraws, intended.kind)


def _draw(draw: Draw, redraws: tuple[Redraw, ...]) -> Machine:
    recipe, part, picker = draw.recipe, draw.recipe.part[draw.part], draw.picker
    rig, separate_cages = draw_rig(part.machine, picker("machine"))
    rate, samples = _draw_signal(recipe.signal, picker("signal"))
    machine = Machine(
        number=draw.number,
        attempt=draw.attempt,
        bearing_id=f"{recipe.name}-{draw.number:05d}",
        rig=rig,
        separate_cages=separate_cages,
        imperfections=draw_imperfections(
            part.imperfections, rig.bearing, picker("imperfections"), picker("imperfections", 1)
        ),
        chain=draw_chain(recipe.chain_of(part), rate, draw),
        background=draw_background(recipe.background_of(part), rate, draw),
        split=_split(recipe.split, replace(draw, attempt=0).picker("split").share()),
        rate=rate,
        samples=samples,
        settle=round(rate * recipe.signal.settle_s) / rate,
        envelope_band=_envelope_band(recipe.signal, rig, rate, samples),
        redraws=redraws,
        turn=draw.turns.turn,
    )
    if part.defect is not None and part.defect.drawn_for == "machine":
        # Its records draw the same spalls again, under their own load; drawing them here shows that they are possible,
        # and of what kind.
        draw_spalls(part.defect, rig.bearing, rig.rated_load, replace(draw, turn=machine.turn))
        machine = replace(machine, kind=draw.intended.kind)
    return machine


def _draw_signal(signal: Signal, pick: Picker) -> tuple[float, int]:
    rate, duration = pick.number(signal.rate_hz), pick.number(signal.duration_s)
    samples = round(rate * duration)
    require(
        samples >= FEWEST_STORED_SAMPLES, f"{duration:g} s at {rate:g} Hz hold only {samples} samples", "duration_s"
    )
    return rate, samples


_resonance_band = lru_cache(maxsize=256)(resonance_band)


def _envelope_band(signal: Signal, rig: Rig, rate: float, samples: int) -> tuple[float, float]:
    """The recipe's band, or that of the rig's resonance, which must then have been recorded, Hz; it holds a line."""
    low, high = signal.envelope_band_hz or _recorded_resonance(rig, rate)
    require(
        holds_a_line((low, high), samples, rate),
        f"the envelope's band, {low:.0f} to {high:.0f} Hz, holds none of the lines in the spectrum of {samples} "
        f"samples at {rate:g} Hz; allowed: longer records, or an envelope_band_hz at least {rate / samples:g} wide",
        "duration_s",
    )
    return low, high


def _recorded_resonance(rig: Rig, rate: float) -> tuple[float, float]:
    low, high = _resonance_band(rig)
    require(
        high < rate / 2.0,
        f"the resonator of rig {rig.name} rings at {(low + high) / 2.0:.0f} Hz, too high for a sampling rate of "
        f"{rate:g} Hz; allowed: rate_hz above {2.0 * high:.0f}, or an envelope_band_hz of your own",
        "resonator_stiffness",
    )
    return low, high


def _split(shares: Split, number: float) -> str:
    edges = (shares.train, shares.train + shares.validation)
    return SPLITS[(number >= edges[0]) + (number >= edges[1])]
