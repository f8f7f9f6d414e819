"""The word that somebody probably meant."""

import pytest

from physics.catalog import rig
from physics.checks import InvalidParameter
from physics.spelling import nearest, suggestion

NAMES = ("gearbox", "fan", "cwru")


def test_the_nearest_word_is_named_and_nothing_where_none_is_near():
    assert suggestion("gear_box", NAMES) == '; did you mean "gearbox"?'
    assert nearest("grb", NAMES) == "gearbox"
    assert nearest("gb", NAMES) is None  # two letters of nine in common
    assert suggestion("gb", NAMES) == ""


def test_the_catalogue_takes_the_same_words_for_near():
    with pytest.raises(InvalidParameter, match='did you mean "gearbox"'):
        rig("grb")
    with pytest.raises(InvalidParameter, match=r"ims$"):
        rig("gb")
