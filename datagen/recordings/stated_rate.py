"""Whether a sampling rate that the SPEC states is that of the file, where this tells one too: by a number called like a
rate, or by the times of its samples."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from datagen.errors import BadInput
from datagen.formats.csv_file import Columns
from datagen.recordings.sample_times import rate_of
from datagen.recordings.source import Source
from datagen.recordings.values import FromVariable

# What rates and times are called, small letters alone. "rate" is none: MFPT means the speed of the shaft by it.
RATE_NAMES = ("fs", "sr", "fsamp", "samplerate", "samplingrate", "samplefrequency", "samplingfrequency", "samplefreq")
TIME_NAMES = re.compile("t[mun]?s?|time.*|zeit.*|sec.*")
# The first column of a table without header is often a clock.
FIRST_COLUMN = "1"
# How far, as a share, a stated rate may be off the file's: such times may be rounded.
ALIKE = 0.01
ANOTHER = "with another sampling rate in the file than the stated one"


def rate_doubts(source: Source, rate: float, size: int) -> dict[str, str]:
    """Says so, with the figures, if the file tells another rate than the stated `rate`, Hz, of `size` samples; empty if
    not, or if the rate is the file's own.

    The unit is not told with it: kHz, and times in ms, µs or ns, agree too. Times by the number of the sample tell
    nothing.
    """
    if isinstance(source.setting("rate_hz"), FromVariable):
        return {}
    told = ((name, found) for name, found in _told_rates(source, size) if not _agree(found, rate))
    odd = next(told, None)
    return {} if odd is None else {ANOTHER: f"{rate:g} Hz stated, {odd[1]:g} by {odd[0]}"}


def _told_rates(source: Source, size: int) -> Iterator[tuple[str, float]]:
    """Names of variables that tell a rate, and what they tell, without its unit."""
    for name in source.arrays:
        letters = _letters(name)
        if letters in RATE_NAMES:
            found = np.asarray(source.arrays[name])
            if found.size == 1 and found.dtype.kind in "iuf":
                yield name, float(found.ravel()[0])
        elif TIME_NAMES.fullmatch(letters) or (name == FIRST_COLUMN and isinstance(source.arrays, Columns)):
            yield name, _rate_by_times(source, name, size)


@lru_cache(maxsize=1 << 16)  # the names of a file are looked at anew for each recording in it
def _letters(name: str) -> str:
    """The letters of a variable's own name, small, without a unit of Hz."""
    return re.sub("[^a-z]|hz$", "", re.split(r"[.@]", name)[-1].casefold())


def _rate_by_times(source: Source, name: str, size: int) -> float:
    """The rate by a row of `size` times; NaN if the variable is none."""
    times = np.asarray(source.arrays[name]).squeeze()
    if times.shape != (size,) or times.dtype.kind not in "iuf" or not np.isfinite(times).all():
        return math.nan
    try:
        found = rate_of(times.astype(np.float64), source.path, name)
    except BadInput:
        return math.nan
    return math.nan if found == 1.0 else found


def _agree(told: float, rate: float) -> bool:
    """Whether a rate that a file tells is the stated one, in Hz or by a unit a thousand times as large, or none."""
    if not (math.isfinite(told) and told / rate > 0.0):
        return True
    unit = 1000.0 ** min(0, round(math.log(told / rate, 1000.0)))
    return abs(told / unit / rate - 1.0) <= ALIKE
