"""Words and small numbers that a setting may take, and their shares of all draws."""

from __future__ import annotations

import pytest
from pydantic_core import PydanticCustomError

from datagen.distributions.kinds import Choice, Fixed
from datagen.settings.table import Between, OneOf, prose, rising, shares_of_words


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


def test_a_whole_number_is_the_number_that_it_stands_for_alone_and_in_a_list() -> None:
    for value in (2, {"choice": [1, 2]}):
        assert {type(stated) for stated in Between().parse(value).stated()} == {float}


def test_a_truth_value_in_quotes_is_told_to_lose_them_however_it_is_written() -> None:
    with pytest.raises(PydanticCustomError, match=r"did you mean true, without quotes\?"):
        OneOf((False, True)).parse("True")


def test_texts_may_have_lines_and_tabulators() -> None:
    assert prose("a\tb\nc") == "a\tb\nc"


def test_two_orders_may_be_the_same() -> None:
    assert rising((2, 2)) == (2, 2)
