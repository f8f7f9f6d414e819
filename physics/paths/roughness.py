"""The rough floor of a spall: random heights that a rolling element can feel."""

from __future__ import annotations

import math

import numpy as np

from physics.arrays import Array
from physics.bearing import Bearing
from physics.checks import require_not_negative, require_positive, require_up_to

STEPS_PER_WIDTH = 8
FEWEST_STEPS = 16
SMALLEST_RESOLVED_STEP = 1e-5
# A contact of next to no load is a thousandth as wide as one of any use: it would feel millions of steps.
MOST_STEPS = 20_000
PADDING_WIDTHS = 4
# A patch of width w that averages what is under it halves waves of 1.66 w: sin(π w/λ) / (π w/λ) = 1/2.
HALVED_WAVE_WIDTHS = 1.66


def draw_roughness(
    generator: np.random.Generator,
    bearing: Bearing,
    race: str,
    extent: float,
    deviation: float,
    contact_width: float | None,
) -> tuple[float, ...]:
    """Heights (m) at equal steps along a spall of arc `extent` (rad), from entry edge to exit edge [P14 Eq. 17].

    White noise, low-passed with zero phase as a contact of `contact_width` (m) averages what is under it: by a Gaussian
    filter that passes half the amplitude at a wavelength of 1.66 widths. It is tapered to exactly 0 over one width at
    each edge, and brought to zero mean and the standard deviation `deviation` (m) over the spall. Heights are rounded
    to 1e-12 m, so that their decimal text is exact. Steps are an eighth of the contact width or shorter, but no more
    than MOST_STEPS: a narrower contact is taken for one of eight steps of these.

    Without a contact width the noise is not filtered, for a ball that is rolled over it: the step is an eighth of the
    gap that a ball bridges when it sags by `deviation` into it, √(8 Rb `deviation`), but at least 10 µm. No deviation:
    no values. InvalidParameter unless the extent is above 0 and π at most, the deviation not below 0 and the contact
    width above 0.
    """
    require_up_to("extent", extent, math.pi, "rad")
    require_not_negative("deviation", deviation, "m")
    if deviation == 0.0:
        return ()
    length = extent * bearing.raceway_radius(race)
    width = resolved_width(bearing, deviation) if contact_width is None else contact_width
    require_positive("contact_width", width, "m")
    count = max(FEWEST_STEPS, math.ceil(STEPS_PER_WIDTH * length / width))
    if contact_width is not None and count > MOST_STEPS:
        count, width = MOST_STEPS, STEPS_PER_WIDTH * length / MOST_STEPS
    step = length / count
    if contact_width is None:
        noise = generator.uniform(-1.0, 1.0, count + 1)
    else:
        padding = math.ceil(PADDING_WIDTHS * width / step)
        noise = low_passed(generator.uniform(-1.0, 1.0, count + 1 + 2 * padding), step, width)
        noise = noise[padding : padding + count + 1]
    values = _standardised(noise, edge_window(count, step, width)) * deviation
    return tuple((np.round(values, 12) + 0.0).tolist())


def resolved_width(bearing: Bearing, deviation: float) -> float:
    """Width (m) of a gap into which a ball sags by `deviation` (m), or 80 µm if that is more."""
    return max(math.sqrt(8.0 * bearing.ball_radius * deviation), STEPS_PER_WIDTH * SMALLEST_RESOLVED_STEP)


def low_passed(values: Array, step: float, width: float) -> Array:
    """`values` (N,) at equal `step` (m) without what is much shorter than `width` (m), with zero phase, shape (N,).

    The gain is 2^−(1.66 k width)² at the wave number k (1/m): the Gaussian profile filter of surface metrology, with
    the half-amplitude wavelength of a moving average over `width`. The ends wrap around; leave a few widths to cut off.
    """
    wave_number = np.fft.rfftfreq(values.size, step)
    gain = np.exp2(-((HALVED_WAVE_WIDTHS * wave_number * width) ** 2))
    return np.fft.irfft(np.fft.rfft(values) * gain, values.size)


def edge_window(count: int, step: float, width: float) -> Array:
    """Weights (count + 1,) that rise from 0 at each edge to 1 over `width` (m), or over half the spall if shorter."""
    taper = min(width, count * step / 2.0)
    to_edge = step * np.minimum(np.arange(count + 1), np.arange(count, -1, -1))
    return 0.5 - 0.5 * np.cos(np.pi * np.minimum(to_edge / taper, 1.0))


def _standardised(noise: Array, window: Array) -> Array:
    """`noise` under `window`, shifted and scaled to zero mean and unit standard deviation."""
    values = window * (noise - np.sum(window * noise) / np.sum(window))
    return np.asarray(values / np.std(values))
