"""What a recipe may say of frequencies: nothing at or above half its lowest sampling rate, and no other rate."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from datagen.errors import BadInput
from datagen.recipes.background_settings import BackgroundSettings
from datagen.recipes.chain_settings import ChainSettings
from datagen.recipes.distributions import Distribution, Fixed
from datagen.recipes.recipe_errors import dotted
from datagen.recipes.toml_lines import Location, line_of

if TYPE_CHECKING:
    from datagen.recipes.recipe import Recipe

Frequency = tuple[Location, Distribution, str]


def require_sampled_fast_enough(recipe: Recipe, path: Path, text: str) -> None:
    """Raise BadInput if a stated frequency or band is not below half the sampling rate, or a recording does not fit.

    `text` is what was read from `path`, for the line of the setting.
    """
    nyquist = min(recipe.signal.rate_hz.stated()) / 2.0

    def refuse(location: Location, problem: str, value: object, allowed: str) -> BadInput:
        line = line_of(text, location)
        return BadInput(problem, f"{path}, line {line}" if line else str(path), dotted(location), value, allowed)

    for place, chain, background in _tables(recipe):
        for location, setting, name in (*_of_chain(chain), *_of_background(background)):
            highest = max(setting.stated())
            if highest >= nyquist:
                problem = f"the {name} must lie below half the sampling rate of {2.0 * nyquist:g} Hz"
                raise refuse((*place, *location), problem, highest, f"below {nyquist:g}")
        band = background.snr_band_hz
        if band is not None and band[1] > nyquist:
            problem = f"the band is not below half the sampling rate of {2.0 * nyquist:g} Hz"
            raise refuse((*place, "background", "snr_band_hz"), problem, band, f"0 <= low < high <= {nyquist:g}")
        misfit = _misfit(recipe, background)
        if misfit is not None:
            field, problem, value, allowed = misfit
            raise refuse((*place, "background", "recording", field), problem, value, allowed)


def _tables(recipe: Recipe) -> Iterator[tuple[Location, ChainSettings, BackgroundSettings]]:
    """Each pair of tables that are written somewhere, with the place of the table around them."""
    yield (), recipe.chain, recipe.background
    for index, part in enumerate(recipe.part):
        yield ("part", index), part.chain or ChainSettings(), part.background or BackgroundSettings()


def _of_chain(chain: ChainSettings) -> Iterator[Frequency]:
    for index, modes in enumerate(chain.modes):
        yield ("chain", "modes", index, "frequency_hz"), modes.frequency_hz, "resonance"
    if chain.mounting_cutoff_hz is not None:
        yield ("chain", "mounting_cutoff_hz"), chain.mounting_cutoff_hz, "cutoff"


def _of_background(background: BackgroundSettings) -> Iterator[Frequency]:
    if background.pink is not None:
        yield ("background", "pink", "lowest_hz"), background.pink.lowest_hz, "band of the noise"
    if background.impulses is not None:
        yield ("background", "impulses", "frequency_hz"), background.impulses.frequency_hz, "resonance"


def _misfit(recipe: Recipe, background: BackgroundSettings) -> tuple[str, str, object, str] | None:
    """Field, problem, value and what is allowed of a recording that the records cannot take stretches of."""
    recording, rate, duration = background.recording, recipe.signal.rate_hz, recipe.signal.duration_s
    if recording is None:
        return None
    if not isinstance(rate, Fixed) or rate.value != recording.rate_hz:
        stated = ", ".join(f"{value:g}" for value in rate.stated())
        problem = f"{recording.file} is not sampled at the records' rate, and recordings are not resampled"
        return "rate_hz", problem, recording.rate_hz, f"{stated} (signal.rate_hz)"
    longest = max(duration.stated())
    if recording.samples < round(longest * recording.rate_hz):
        seconds = recording.samples / recording.rate_hz
        problem = f"{recording.file} is {seconds:g} s long, a record {longest:g} s, and recordings are not repeated"
        return "file", problem, None, f"a recording of {longest:g} s or more"
    return None
