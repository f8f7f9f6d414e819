"""Wave files: linear samples of 8 to 64 bits or floats; whole numbers become shares of full scale."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.formats.arrays import ONLY_NAME

RATE_NAME = "rate_hz"
# What scipy warns of a file that is shorter than its header says; other warnings are of chunks that hold no samples.
EARLY_END = "EOF prematurely"
# What numpy says where the samples of the channels do not come out even.
PART_OF_A_SAMPLE = "cannot reshape array"


class WaveArrays(dict[str, NDArray[Any]]):
    """The arrays of a wave file by name; `shares` says whether its samples are shares of full scale."""

    def __init__(self, samples: NDArray[Any], rate: float) -> None:
        super().__init__({ONLY_NAME: _full_scale(samples), RATE_NAME: np.array(rate)})
        self.shares = samples.dtype.kind != "f"


def read_wav(path: Path) -> WaveArrays:
    """The samples of a wave file as "data" (T,) or (T, C), whole numbers as -1 to 1, and "rate_hz"; raises BadInput."""
    from scipy.io import wavfile

    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", wavfile.WavFileWarning)
            rate, samples = wavfile.read(path)
    except Exception as problem:  # whatever the damaged bytes lead scipy to
        if PART_OF_A_SAMPLE in str(problem):
            raise BadInput("the file is cut off: its last sample lacks channels", file=str(path)) from None
        raise BadInput(
            f"cannot be read as a wave file: {problem}", file=str(path), allowed="linear PCM of 8 to 64 bits, or floats"
        ) from None
    early = next((str(warning.message) for warning in caught if EARLY_END in str(warning.message)), "")
    if early:
        raise BadInput(f"the file is cut off: {early}", file=str(path))
    return WaveArrays(np.asarray(samples), float(rate))


def _full_scale(samples: np.ndarray) -> np.ndarray:
    if samples.dtype.kind == "f":
        return samples
    if samples.dtype.kind == "u":
        return (samples.astype(np.float64) - 128.0) / 128.0
    return samples / -float(np.iinfo(samples.dtype).min)
