"""Which frequencies a recipe may state: below half its lowest sampling rate, in bands that hold a line of the spectrum.

A recording in the background must fit too: sampled at the rate of the records, and as long as they are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from datagen.distributions.kinds import Distribution, Fixed
from datagen.errors import BadInput, at_line
from datagen.recipes.background_settings import BackgroundSettings
from datagen.recipes.chain_settings import ChainSettings
from datagen.settings.problems import dotted
from datagen.settings.table import possible_words
from datagen.settings.toml_lines import Location, line_of
from labels.envelope import BAND_SHARE
from physics.angular_speed import in_hertz
from physics.catalog import RIGS

if TYPE_CHECKING:
    from datagen.recipes.recipe import Recipe

RESONATOR = ("resonator_mass_kg", "outer_mass_kg", "resonator_stiffness_n_per_m", "resonator_frequency_hz")
# Where a setting is, the setting, and what it is the frequency of.
Frequency = tuple[Location, Distribution, str]


class Refusal(NamedTuple):
    """A setting that does not fit the sampling: where it is, what is wrong with its `value`, and what is allowed."""

    location: Location
    problem: str
    value: object
    allowed: str


def require_sampled_fast_enough(recipe: Recipe, path: Path, text: str) -> None:
    """Raise BadInput if a stated frequency or band is not below half the sampling rate, or a band or recording does
    not fit.

    `text` is what was read from `path`, for the line of the setting.
    """
    refusal = next(_refusals(recipe), None)
    if refusal is not None:
        location, problem, value, allowed = refusal
        raise BadInput(
            problem, file=at_line(path, line_of(text, location)), field=dotted(location), value=value, allowed=allowed
        )


def _refusals(recipe: Recipe) -> Iterator[Refusal]:
    nyquist = recipe.signal.rate_hz.lowest / 2.0
    if recipe.signal.envelope_band_hz is None:
        yield from _too_high((), _resonators(recipe), nyquist)
        yield from _rigs_too_high(recipe, nyquist)
    for place, chain, background in _tables(recipe):
        yield from _too_high(place, (*_of_chain(chain), *_of_background(background)), nyquist)
        yield from _unfit_band(recipe, background, (*place, "background", "snr_band_hz"), nyquist)
        yield from _unfit_recording(recipe, background, (*place, "background", "recording"))


def _too_high(place: Location, frequencies: Iterable[Frequency], nyquist: float) -> Iterator[Refusal]:
    """The settings, by their location below `place`, that may reach half the sampling rate, `nyquist` (Hz)."""
    for location, setting, name in frequencies:
        if setting.highest >= nyquist:
            problem = f"the {name} must lie below half the sampling rate of {2.0 * nyquist:.12g} Hz"
            yield Refusal((*place, *location), problem, setting.highest, f"below {nyquist:.12g}")


def _rigs_too_high(recipe: Recipe, nyquist: float) -> Iterator[Refusal]:
    for index, rig, frequency in _catalogue_resonances(recipe):
        if frequency >= nyquist:
            limit = f"half the sampling rate of {2.0 * nyquist:.12g} Hz"
            problem = f"its resonance at {frequency:.0f} Hz must lie below {limit}"
            lowest = 2.0 * (1.0 + BAND_SHARE) * frequency  # the envelope's band must lie below half of it
            allowed = f"signal.rate_hz above about {math.ceil(lowest)}, or a signal.envelope_band_hz of your own"
            yield Refusal(("part", index, "machine", "rig"), problem, rig, allowed)


def _unfit_band(recipe: Recipe, background: BackgroundSettings, place: Location, nyquist: float) -> Iterator[Refusal]:
    """What is wrong with the band of the signal-to-noise ratio, which is stated at `place`."""
    band = background.snr_band_hz
    if band is None:
        return
    if band[1] > nyquist:
        problem = f"the band is not below half the sampling rate of {2.0 * nyquist:.12g} Hz"
        yield Refusal(place, problem, band, f"0 <= low < high <= {nyquist:.12g}")
    narrow = recipe.signal.too_narrow(band)
    if narrow is not None:
        problem, allowed = narrow
        yield Refusal(place, problem, band, allowed)


def _tables(recipe: Recipe) -> Iterator[tuple[Location, ChainSettings, BackgroundSettings]]:
    """Each pair of tables that are written somewhere, with the place of the table around them."""
    yield (), recipe.chain, recipe.background
    for index, part in enumerate(recipe.part):
        yield ("part", index), part.chain or ChainSettings(), part.background or BackgroundSettings()


def _resonators(recipe: Recipe) -> Iterator[Frequency]:
    """The resonators of drawn rigs, round which the envelope is taken unless the recipe states its band."""
    for index, part in enumerate(recipe.part):
        setting = part.machine.resonator_frequency_hz
        if setting is not None:
            yield ("part", index, "machine", "resonator_frequency_hz"), setting, "resonance"


def _catalogue_resonances(recipe: Recipe) -> Iterator[tuple[int, str, float]]:
    """Part, rig and resonance (Hz) of the rigs of the catalogue whose resonators are used as they are.

    The resonance is that of the resonator on the free outer ring, to which the support and the shaft add little.
    """
    for index, part in enumerate(recipe.part):
        machine, factors = part.machine, part.machine.factors
        said = (*(getattr(machine, name) for name in RESONATOR), factors.resonator_stiffness, factors.resonator_mass)
        if any(setting is not None for setting in said):
            continue
        for name in possible_words(machine.rig):
            if name in RIGS:
                yield index, name, in_hertz(RIGS[name].build(name).free_resonance)


def _of_chain(chain: ChainSettings) -> Iterator[Frequency]:
    for index, modes in enumerate(chain.modes):
        yield ("chain", "modes", index, "frequency_hz"), modes.frequency_hz, "resonance"
    if chain.mounting_cutoff_hz is not None:
        yield ("chain", "mounting_cutoff_hz"), chain.mounting_cutoff_hz, "cutoff"


def _of_background(background: BackgroundSettings) -> Iterator[Frequency]:
    if background.pink is not None:
        yield ("background", "pink", "lowest_hz"), background.pink.lowest_hz, "band of the noise"
    if background.mains_hum is not None:
        yield ("background", "mains_hum", "frequency_hz"), background.mains_hum.frequency_hz, "mains frequency"
    if background.impulses is not None:
        yield ("background", "impulses", "frequency_hz"), background.impulses.frequency_hz, "resonance"


def _unfit_recording(recipe: Recipe, background: BackgroundSettings, place: Location) -> Iterator[Refusal]:
    """Why the records cannot take stretches of the recording whose table is at `place`."""
    recording, rate, longest = background.recording, recipe.signal.rate_hz, recipe.signal.duration_s.highest
    if recording is None:
        return
    if not isinstance(rate, Fixed):
        problem = f"the records' rate is drawn, and {recording.file} is not resampled"
        allowed = f"signal.rate_hz = {recording.rate_hz:.12g}"
        yield Refusal((*place, "rate_hz"), problem, recording.rate_hz, allowed)
    elif rate.value != recording.rate_hz:
        problem = f"{recording.file} is not sampled at the records' rate, and recordings are not resampled"
        yield Refusal((*place, "rate_hz"), problem, recording.rate_hz, f"{rate.value:.12g} (signal.rate_hz)")
    elif recording.samples < round(longest * recording.rate_hz):
        seconds = recording.samples / recording.rate_hz
        problem = f"{recording.file} is {seconds:g} s long, a record {longest:g} s, and recordings are not repeated"
        yield Refusal((*place, "file"), problem, None, f"a recording of {longest:g} s or more")
