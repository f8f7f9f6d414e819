import tomllib
from pathlib import Path

import pytest

from datagen.paper import published as module
from datagen.paper.chapter import beside, only_ours
from datagen.paper.published import Published, published, published_value

AUTHORITY = tomllib.loads(
    (Path(__file__).parents[2] / "authorities" / "petersen_2014.toml").read_text(encoding="utf-8")
)
TYPED = tomllib.loads(Path(module.__file__).with_suffix(".toml").read_text(encoding="utf-8"))
SENSES = ("equal", "at most", "at least")
SAME = {
    ("figure8", "bpfo"): ("contradicted", "gearbox_bpfo_hz"),
    ("figure8", "sixth_harmonic"): ("contradicted", "gearbox_sixth_harmonic_hz"),
    ("figure10", "resonator_alone"): ("printed", "gearbox_resonator_khz"),
    ("figure10", "damping"): ("contradicted", "gearbox_resonator_damping_percent"),
    ("figure11", "bpfo"): ("printed", "fan_bpfo_hz"),
    ("figure11", "spall_angle"): ("printed", "fan_spall_deg"),
    ("figure11", "lower_mode"): ("printed", "fan_lower_mode_khz"),
    ("figure11", "upper_mode"): ("contradicted", "fan_upper_mode_khz"),
    ("figure11", "resonator_alone"): ("printed", "fan_resonator_khz"),
    ("figure11", "damping"): ("printed", "fan_resonator_damping_percent"),
}


@pytest.mark.parametrize("ours", SAME, ids=".".join)
def test_numbers_typed_for_the_tests_too_are_the_same(ours):
    group, name = SAME[ours]
    other = AUTHORITY[group][name]
    assert (published(*ours).value, published(*ours).tolerance) == (other["value"], other["tolerance"])


def test_every_statement_has_a_place_and_a_number_with_unit_or_words():
    for key in ((chapter, key) for chapter, keys in TYPED.items() for key in keys):
        said = published(*key)
        assert said.where, key
        assert said.sense in SENSES, key
        assert (said.value is None) == bool(said.claim), key
        assert said.value is None or said.unit, key


def test_a_printed_number_is_given_and_words_alone_are_refused():
    assert published_value("figure8", "gear_mesh") == 224.0
    with pytest.raises(ValueError, match="no number for no_sidebands of figure8"):
        published_value("figure8", "no_sidebands")
    with pytest.raises(KeyError):
        published_value("figure8", "gear_mash")


def test_a_number_agrees_within_its_tolerance_and_a_bound_on_its_side():
    assert Published("", 2.6, "°", 0.05).holds(2.55)
    assert not Published("", 2.6, "°", 0.05).holds(2.54)
    assert Published("", 24.0, "N", sense="at most").holds(24.0)
    assert not Published("", 24.0, "N", sense="at most").holds(24.1)
    assert not Published("", -40.0, "N", sense="at least").holds(-41.0)
    assert Published("", claim="words").holds(1.0) is None


def test_a_row_has_a_difference_only_beside_a_number_that_ours_should_equal():
    assert beside("figure11", "bpfo", "BPFO", 76.8).difference == pytest.approx(0.1)
    assert beside("figure7", "net_axis", "net force", 20.0).difference is None
    assert beside("figure7", "after_ball_7", "order", 1.0, agrees=True, unit="s").difference is None
    assert only_ours("something", 1.0, "m").agrees is None
