"""Words and small numbers that a setting may take, and their shares of all draws."""

from __future__ import annotations

import pytest

from datagen.distributions.kinds import Choice, Fixed
from datagen.settings.table import OneOf, shares_of_words


@pytest.mark.parametrize(
    ("options", "value"), [((1, 2, "both"), True), ((1, 2, "both"), 1.0), ((False, True), 0), ((False, True), "true")]
)
def test_a_value_of_another_type_is_not_the_option_that_equals_it(
    options: tuple[int | str, ...], value: object
) -> None:
    assert all(OneOf(options).accepts(option) for option in options)
    assert not OneOf(options).accepts(value)


def test_a_word_that_is_listed_twice_has_both_shares_and_one_of_weight_0_none() -> None:
    assert shares_of_words(Choice(("line", "healthy", "line"))) == pytest.approx({"line": 2 / 3, "healthy": 1 / 3})
    assert shares_of_words(Choice(("a", "b", "c"), (3.0, 0.0, 1.0))) == {"a": 0.75, "c": 0.25}
    assert shares_of_words(Fixed("a")) == {"a": 1.0}
