"""What a recipe may say of frequencies: below half its lowest sampling rate, bands that hold a line, one rate."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from datagen.distributions.kinds import Distribution, Fixed
from datagen.errors import BadInput
from datagen.recipes.background_settings import BackgroundSettings
from datagen.recipes.chain_settings import ChainSettings
from datagen.settings.problems import dotted
from datagen.settings.table import possible_words
from datagen.settings.toml_lines import Location, line_of
from physics.angular_speed import in_hertz
from physics.catalog import RIGS

if TYPE_CHECKING:
    from datagen.recipes.recipe import Recipe

RESONATOR = ("resonator_mass_kg", "outer_mass_kg", "resonator_stiffness_n_per_m", "resonator_frequency_hz")
Frequency = tuple[Location, Distribution, str]


def require_sampled_fast_enough(recipe: Recipe, path: Path, text: str) -> None:
    """Raise BadInput if a stated frequency or band is not below half the sampling rate, or a band or recording does
    not fit.

    `text` is what was read from `path`, for the line of the setting.
    """
    nyquist = recipe.signal.rate_hz.lowest / 2.0

    def refuse(location: Location, problem: str, value: object, allowed: str) -> BadInput:
        line = line_of(text, location)
        return BadInput(problem, f"{path}, line {line}" if line else str(path), dotted(location), value, allowed)

    def require_below(place: Location, frequencies: Iterable[Frequency]) -> None:
        for location, setting, name in frequencies:
            highest = setting.highest
            if highest >= nyquist:
                problem = f"the {name} must lie below half the sampling rate of {2.0 * nyquist:.12g} Hz"
                raise refuse((*place, *location), problem, highest, f"below {nyquist:.12g}")

    if recipe.signal.envelope_band_hz is None:
        require_below((), _resonators(recipe))
        for index, rig, frequency in _catalogue_resonances(recipe):
            if frequency >= nyquist:
                limit = f"half the sampling rate of {2.0 * nyquist:.12g} Hz"
                problem = f"its resonance at {frequency:.0f} Hz must lie below {limit}"
                allowed = f"signal.rate_hz above {2.0 * frequency:.0f}, or a signal.envelope_band_hz of your own"
                raise refuse(("part", index, "machine", "rig"), problem, rig, allowed)
    for place, chain, background in _tables(recipe):
        require_below(place, (*_of_chain(chain), *_of_background(background)))
        band = background.snr_band_hz
        if band is not None and band[1] > nyquist:
            problem = f"the band is not below half the sampling rate of {2.0 * nyquist:.12g} Hz"
            raise refuse((*place, "background", "snr_band_hz"), problem, band, f"0 <= low < high <= {nyquist:.12g}")
        narrow = None if band is None else recipe.signal.too_narrow(band)
        if narrow is not None:
            raise refuse((*place, "background", "snr_band_hz"), narrow[0], band, narrow[1])
        misfit = _misfit(recipe, background)
        if misfit is not None:
            field, problem, value, allowed = misfit
            raise refuse((*place, "background", "recording", field), problem, value, allowed)


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


def _misfit(recipe: Recipe, background: BackgroundSettings) -> tuple[str, str, object, str] | None:
    """Field, problem, value and what is allowed of a recording that the records cannot take stretches of."""
    recording, rate, duration = background.recording, recipe.signal.rate_hz, recipe.signal.duration_s
    if recording is None:
        return None
    if not isinstance(rate, Fixed):
        problem = f"the records' rate is drawn, and {recording.file} is not resampled"
        return "rate_hz", problem, recording.rate_hz, f"signal.rate_hz = {recording.rate_hz:.12g}"
    if rate.value != recording.rate_hz:
        stated = ", ".join(f"{value:.12g}" for value in rate.stated())
        problem = f"{recording.file} is not sampled at the records' rate, and recordings are not resampled"
        return "rate_hz", problem, recording.rate_hz, f"{stated} (signal.rate_hz)"
    longest = duration.highest
    if recording.samples < round(longest * recording.rate_hz):
        seconds = recording.samples / recording.rate_hz
        problem = f"{recording.file} is {seconds:g} s long, a record {longest:g} s, and recordings are not repeated"
        return "file", problem, None, f"a recording of {longest:g} s or more"
    return None
