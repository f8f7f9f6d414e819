import math

import pytest

from labels.schema import CONDITIONS, LABEL, LOCATIONS, MEASURED
from labels.vocabulary import ALIASES, FAULT_TYPE, SEVERITY, common_row

# The terms of bearing-datasets 0.3.0, modules schema and units.
FAULT_TYPES = [
    "normal", "inner", "outer", "rolling_element", "cage", "bearing", "gear", "shaft", "unbalance",
    "misalignment", "looseness", "electrical", "other", "unknown",
]  # fmt: skip
STANDARD_COLUMNS = [
    "recording_id", "signal_id", "native_label", "channel", "sensor_location", "fs", "n_samples", "fault_type",
    "fault_location", "sensor_at_fault", "quantity", "unit", "axis", "sensor_mounting", "speed_rpm",
    "speed_profile", "load", "load_unit", "fault_origin", "fault_size_mm", "fault_severity",
    "fault_severity_level", "bearing_id", "bearing_model", "bpfo", "bpfi", "bsf", "ftf",
]  # fmt: skip
ADELAIDE_COLUMNS = ["defect_depth_um", "defect_length_deg"]


def labels(**changes):
    values = {
        "record": 17, "rate_hz": 65536.0, "duration_s": 0.5, "speed_rpm": 420.0, "load_n": 346.0, "extent_mm": 0.8,
        "depth": 12e-6, "extent": math.radians(2.0), "bearing_id": "gearbox-3", "bearing": "koyo_1205", "bpfo": 4.9,
        "bpfi": 7.1, "bsf": 2.6, "ftf": 0.41, "condition": "line", "location": "outer",
        "recording": "", "channel": "", "model": "contact",
    }  # fmt: skip
    return values | changes


def test_every_alias_names_one_of_our_labels():
    assert {alias.label for alias in ALIASES} <= set(LABEL)


def test_every_location_and_condition_has_a_word_there():
    assert set(FAULT_TYPE) == {*LOCATIONS, *LABEL["location"].imported}
    assert set(FAULT_TYPE.values()) <= set(FAULT_TYPES)
    assert set(SEVERITY) == {*CONDITIONS, *LABEL["condition"].imported}


def test_a_faulty_record_reads_like_one_of_theirs():
    row = common_row(labels(), "y")
    assert set(row) == {*STANDARD_COLUMNS, *ADELAIDE_COLUMNS}
    assert (row["fault_type"], row["fault_location"], row["fault_origin"]) == ("outer", "test_bearing", "artificial")
    assert (row["fault_severity"], row["fault_severity_level"], row["fault_size_mm"]) == ("line", 1, 0.8)
    assert (row["signal_id"], row["recording_id"], row["n_samples"]) == ("17_y", "17", 32768)
    assert (row["unit"], row["load"], row["load_unit"], row["sensor_at_fault"]) == ("m/s^2", 346.0, "N", True)
    assert row["defect_depth_um"] == pytest.approx(12.0)
    assert row["defect_length_deg"] == pytest.approx(2.0)


def test_a_healthy_record_has_no_fault_place_and_no_size():
    row = common_row(labels(condition="healthy", location="none", extent=0.0, extent_mm=0.0, depth=0.0), "x")
    assert (row["fault_type"], row["fault_location"], row["fault_origin"]) == ("normal", "none", "none")
    assert (row["fault_severity"], row["fault_severity_level"], row["fault_size_mm"]) == ("none", 0, 0.0)
    assert (row["native_label"], row["sensor_at_fault"]) == ("healthy", False)


def test_every_column_takes_the_value_of_its_own_label():
    row = common_row(labels(), "y")
    own = {
        "fs": 65536.0, "speed_rpm": 420.0, "load": 346.0, "fault_size_mm": 0.8, "bearing_id": "gearbox-3",
        "bearing_model": "koyo_1205", "bpfo": 4.9, "bpfi": 7.1, "bsf": 2.6, "ftf": 0.41,
    }  # fmt: skip
    assert {column: row[column] for column in own} == own


def test_what_is_not_known_of_a_recording_is_said_to_be_unknown():
    columns = ("sensor_mounting", "speed_profile", "fault_origin")
    simulated, measured = common_row(labels(), "y"), common_row(labels(model=MEASURED, recording="r7"), "y")
    assert [simulated[column] for column in columns] == ["pedestal", "constant", "artificial"]
    assert [measured[column] for column in columns] == ["unknown"] * 3
    assert (measured["recording_id"], measured["signal_id"]) == ("r7", "r7_y")
