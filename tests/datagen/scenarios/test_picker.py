"""Each setting takes exactly one number of its stream, whether it is drawn, fixed or absent."""

from __future__ import annotations

import numpy as np
import pytest

from datagen.distributions.kinds import Balanced, Distribution, Fixed, Uniform, parse_distribution
from datagen.scenarios.picker import Picker
from datagen.scenarios.turns import Turn, Turns

DRAWN = Uniform(0.0, 1.0)
TURNS = Turns(Turn(0), lambda *_: np.random.default_rng(5))


def picker() -> Picker:
    """Draws from the numbers of one seed as they are."""
    return Picker(lambda: np.random.default_rng(3), lambda _, number: number, TURNS)


def test_a_value_is_the_quantile_of_the_next_number() -> None:
    pick, numbers = picker(), np.random.default_rng(3)
    setting = parse_distribution({"normal": [2.0, 0.5], "low": 1.0, "high": 3.0})
    assert [pick.value(setting) for _ in range(3)] == [setting.quantile(float(numbers.random())) for _ in range(3)]


@pytest.mark.parametrize("other", [Fixed(7.0), None, Balanced(("a", "b"), (1.0, 1.0))])
def test_a_setting_takes_its_number_so_that_fixing_it_moves_no_other(other: Distribution | None) -> None:
    drawn, fixed = picker(), picker()
    first = [drawn.value(DRAWN) for _ in range(4)]
    second = [fixed.value(setting) for setting in (DRAWN, other, other, DRAWN)]
    assert (second[0], second[3]) == (first[0], first[3])


def test_no_stream_is_opened_for_settings_that_leave_nothing_to_chance() -> None:
    def refuse() -> np.random.Generator:
        raise AssertionError("a stream was opened")

    pick = Picker(refuse, lambda _, number: number, TURNS)
    assert [pick.value(Fixed(1.0)), pick.value(None)] == [1.0, None]
