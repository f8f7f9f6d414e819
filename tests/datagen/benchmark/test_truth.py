"""The class and location of a record by its labels, for training and scoring."""

from __future__ import annotations

import pandas
import pytest

from datagen.benchmark.truth import true_classes, true_locations


@pytest.mark.parametrize(
    ("condition", "location", "known_class", "known_location"),
    [
        ("healthy", "none", "healthy", "none"),
        ("line", "outer", "line outer", "outer"),
        ("unknown", "outer", "unknown", "outer"),
        ("unknown", "ball", "unknown", "unknown"),
    ],
)
def test_what_is_no_class_of_ours_is_unknown_and_not_scored(
    condition: str, location: str, known_class: str, known_location: str
) -> None:
    table = pandas.DataFrame({"condition": [condition], "location": [location]})
    assert (true_classes(table).tolist(), true_locations(table).tolist()) == ([known_class], [known_location])


def test_a_table_gives_those_of_its_records_in_order_and_an_empty_one_none() -> None:
    table = pandas.DataFrame({"condition": ["extended", "unknown"], "location": ["inner", "ball"]}, index=[7, 3])
    assert true_classes(table).tolist() == ["extended inner", "unknown"]
    assert true_locations(table).tolist() == ["inner", "unknown"]
    assert true_classes(table[:0]).size == true_locations(table[:0]).size == 0
