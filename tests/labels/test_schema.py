import re

import pytest

from labels.schema import BAND_EDGES, LABEL, LABELS
from labels.variables import COORDINATES, PASSES, SIGNALS, VARIABLES
from physics.spall import PROFILES

PROMISED_LABELS = [
    "condition", "location", "extent", "extent_mm", "extent_spacing", "depth", "bridged", "entry_taper",
    "exit_taper", "roughness", "speed_rpm", "load_n", "rig", "bearing", "bearing_id", "split", "snr_db",
    "envelope_band", "validity", "tension_share", "error_estimate", "model", "method", "step",
]  # fmt: skip
PROMISED_VARIABLES = [
    "acceleration", "envelope", "stiffness", "acceleration_clean", "cage_angle", "profile_depth",
    "contact_force", "scenario", "time", "pass_record", "pass_row", "pass_ball", "pass_defect", "entry_time",
    "deepest_time", "exit_time", "release_time", "regain_time", "loaded", "complete", "defect_record",
    "defect_race", "defect_row", "defect_angle", "defect_extent", "defect_depth",
]  # fmt: skip
TEXT_OR_TRUTH = ("str", "bool")
ALL = [*LABELS, *VARIABLES]


def test_every_promised_label_and_variable_is_in_the_tables():
    assert set(PROMISED_LABELS) <= set(LABEL)
    assert set(PROMISED_VARIABLES) <= {variable.name for variable in VARIABLES}


def test_no_name_is_used_twice():
    columns = [column for label in LABELS for column in label.columns]
    assert len(set(columns)) == len(columns)
    names = [variable.name for variable in VARIABLES]
    assert len(set(names)) == len(names)
    assert set(columns) & set(names) == {"record"}


@pytest.mark.parametrize("entry", ALL, ids=lambda entry: entry.name)
def test_each_entry_has_a_name_a_type_a_unit_and_a_sentence(entry):
    assert re.fullmatch(r"[a-z][a-z0-9_]*", entry.name)
    assert entry.dtype in ("str", "bool", "int16", "int64", "float32", "float64")
    assert bool(entry.unit) == (entry.dtype not in TEXT_OR_TRUTH)
    assert entry.sentence.endswith(".")
    assert not entry.missing or entry.dtype.startswith("float")
    assert entry.values is None or entry.dtype == "str"


@pytest.mark.parametrize("label", LABELS, ids=lambda label: label.name)
def test_a_label_whose_name_ends_in_a_unit_has_that_unit(label):
    units = {"mm": "mm", "rpm": "rpm", "n": "N", "hz": "Hz", "s": "s", "db": "dB"}
    ending = label.name.rpartition("_")[2] if "_" in label.name else ""
    if ending in units:
        assert label.unit == units[ending]
    else:
        assert label.unit in ("", "1", "rad", "m", "N", "Hz", "s", "m s-2")
    assert label.source in ("scene", "run", "record", "recording")


def test_no_time_is_in_seconds_by_name_which_readers_turn_into_durations():
    assert all(entry.unit != "seconds" for entry in ALL)


def test_the_kinds_of_profile_are_those_of_the_physics():
    assert LABEL["profile"].values == ("none", *PROFILES)


def test_every_dimension_of_a_signal_has_a_coordinate():
    known = {variable.name for variable in COORDINATES}
    assert {dim for signal in SIGNALS for dim in signal.dims} <= known
    assert {variable.dims for variable in PASSES} == {("ball_pass",)}


def test_a_label_of_several_components_becomes_as_many_columns():
    assert LABEL["envelope_band"].columns == ("envelope_band_low", "envelope_band_high")
    assert LABEL["envelope_band"].components == BAND_EDGES
    assert LABEL["depth"].columns == ("depth",)


def test_every_list_of_components_is_a_dimension_of_the_format():
    coordinates = {variable.values for variable in COORDINATES if variable.values}
    assert {label.components for label in LABELS if label.components} <= coordinates


def test_only_what_happens_to_its_load_may_be_missing_from_a_pass():
    assert [variable.name for variable in PASSES if variable.missing] == [
        "release_time",
        "regain_time",
        "fall_time",
        "rise_time",
    ]
