"""What a guess makes of what its trees say."""

import math

import numpy as np
import pytest

from labels.spall_size.calibration import SMALLEST_SPREAD, Guess
from labels.spall_size.trees import Trees


def saying(value: float) -> Trees:
    """Trees that say the same of every row."""
    leaf, nowhere = np.full(1, -1, np.int16), np.zeros(1, np.int32)
    nothing = np.zeros(1, np.float32)
    return Trees(leaf, nothing, nowhere, nowhere, nothing, nowhere, value)


@pytest.mark.parametrize(("spread", "expected"), [(0.2, 0.2 + SMALLEST_SPREAD), (-0.5, SMALLEST_SPREAD)])
def test_an_interval_is_never_narrower_than_the_smallest_spread(spread: float, expected: float) -> None:
    factor, reach = Guess(saying(0.1), saying(spread), 2.0).correction(np.zeros(3))
    assert (factor, reach) == (pytest.approx(math.exp(0.1)), pytest.approx(math.exp(2.0 * expected)))
