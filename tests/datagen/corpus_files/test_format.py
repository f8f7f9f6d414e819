from __future__ import annotations

import re
import zlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray

from datagen.corpus_files import format
from datagen.corpus_files.format import VARIABLE, content_hash, format_hash, global_attributes, to_dataset
from datagen.errors import BadInput
from datagen.files.netcdf import COMPRESSIONS, netcdf_bytes
from datagen.inspection.conformity import violations
from datagen.records.profile_grid import profile_grid
from datagen.records.record import Record
from labels.schema import LABELS

Maker = Callable[..., Record]


def stored(dataset: xarray.Dataset, path: Path, compression: str = "zlib") -> Path:
    path.write_bytes(netcdf_bytes(dataset, compression))
    return path


@pytest.fixture
def dataset(make_plain_record: Maker) -> xarray.Dataset:
    return to_dataset([make_plain_record(4, full=True), make_plain_record(9, healthy=True, full=True)], {"title": "t"})


def test_a_shard_opens_with_plain_xarray_to_the_arrays_that_were_put_in(
    dataset: xarray.Dataset, tmp_path: Path
) -> None:
    with xarray.open_dataset(stored(dataset, tmp_path / "a.nc")) as opened:
        assert content_hash(opened.load()) == content_hash(dataset)
        assert opened.attrs["title"] == "t"


def test_each_record_has_its_own_rows_in_the_tables_of_passes_and_defects(make_plain_record: Maker) -> None:
    records = [make_plain_record(4), make_plain_record(9, healthy=True), make_plain_record(7)]
    dataset = to_dataset(records, {})
    for record in records:
        passes, spalls = (dataset[f"{table}_record"].values == record.index for table in ("pass", "defect"))
        for name in ("entry_time", "deepest_time", "exit_time", "release_time"):
            assert np.array_equal(dataset[name].values[passes], getattr(record.passes, name), equal_nan=True)
        assert dataset["defect_angle"].values[spalls].tolist() == [spall.angle for spall in record.spalls]


def test_time_opens_as_floats_of_seconds_that_start_at_zero(dataset: xarray.Dataset, tmp_path: Path) -> None:
    with xarray.open_dataset(stored(dataset, tmp_path / "a.nc")) as opened:
        for name in ("time", "stiffness_time", "entry_time", "regain_time", "duration_s"):
            assert opened[name].dtype == np.float64, name
        assert opened["time"].values[0] == 0.0


@pytest.mark.parametrize(
    ("duration", "rate", "attributes"),
    [(2.0, 12345.678, ("PT2S", "PT0.000081000006642S")), (0.001, 1e7, ("PT0.001S", "PT0.0000001S"))],
)
def test_durations_among_the_attributes_are_those_of_iso_8601_which_knows_no_powers_of_ten(
    duration: float, rate: float, attributes: tuple[str, str]
) -> None:
    found = global_attributes({"duration_s": duration, "rate_hz": rate})
    assert (found["time_coverage_duration"], found["time_coverage_resolution"]) == attributes


def test_rows_and_balls_count_from_1(dataset: xarray.Dataset) -> None:
    rows, balls = (dataset.sizes[name] for name in ("row", "ball"))
    assert dataset["row"].values.tolist() == [1, 2][:rows]
    assert dataset["ball"].values.tolist() == [*range(1, balls + 1)]


def test_texts_are_readable_with_plain_netcdf4(dataset: xarray.Dataset, tmp_path: Path) -> None:
    with netCDF4.Dataset(stored(dataset, tmp_path / "a.nc")) as opened:
        assert opened["scenario"][0] == '{"record": 4, "umlaut": "ü"}'
        assert list(opened["condition"][:]) == ["line", "healthy"]
        assert list(opened["component"][:]) == ["xx", "yy", "xy"]


def test_every_label_and_variable_carries_its_unit_and_a_long_name(dataset: xarray.Dataset) -> None:
    for name, variable in dataset.variables.items():
        assert variable.attrs.get("units", "") == VARIABLE[str(name)].unit
        assert variable.attrs["long_name"]
    assert {label.name for label in LABELS} <= set(dataset.variables)


def test_signals_are_stored_in_one_checksummed_chunk_per_record_and_component(
    dataset: xarray.Dataset, tmp_path: Path
) -> None:
    chunks = {
        "acceleration": [1, 200, 1],
        "envelope": [1, 200],
        "stiffness": [1, 1, 7],
        "contact_force": [1, 200, 1, 1],
        "profile_depth": [1, 1, 64],
    }
    with netCDF4.Dataset(stored(dataset, tmp_path / "a.nc")) as opened:
        for name, expected in chunks.items():
            assert opened[name].chunking() == expected
            filters = opened[name].filters()
            assert (filters["zlib"], filters["shuffle"], filters["fletcher32"], filters["complevel"]) == (True,) * 3 + (
                1,
            )


def stream_length(content: bytes) -> int:
    """Bytes of the zlib stream at the start of `content`, 0 if there is none."""
    stream = zlib.decompressobj()
    try:
        stream.decompress(content)
    except zlib.error:
        return 0
    return len(content) - len(stream.unused_data) if stream.eof else 0


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_a_flipped_bit_in_a_signal_is_noticed_by_any_reader(
    compression: str, dataset: xarray.Dataset, tmp_path: Path
) -> None:
    path = stored(dataset, tmp_path / "a.nc", compression)
    content = bytearray(path.read_bytes())
    if compression == "none":
        start = content.index(dataset["cage_angle"].values[0].tobytes())
    else:
        heads = [match.start() for match in re.finditer(b"\x78[\x01\x5e\x9c\xda]", content)]
        start = max(heads, key=lambda head: stream_length(bytes(content[head:])))
    content[start + 60] ^= 4
    path.write_bytes(content)
    with pytest.raises((OSError, RuntimeError)), xarray.open_dataset(path) as opened:
        opened.load()


def test_a_shard_of_healthy_records_has_empty_tables(make_plain_record: Maker, tmp_path: Path) -> None:
    dataset = to_dataset([make_plain_record(0, healthy=True)], {})
    with xarray.open_dataset(stored(dataset, tmp_path / "a.nc")) as opened:
        assert opened.sizes["ball_pass"] == opened.sizes["defect"] == 0
        assert content_hash(opened.load()) == content_hash(dataset)


def test_the_content_hash_changes_with_any_value_name_or_type(make_plain_record: Maker) -> None:
    record = make_plain_record(1)
    first = content_hash(to_dataset([record], {}))
    envelope = record.envelope.copy()
    envelope[17] = np.nextafter(envelope[17], np.float32(9.0))
    changed = [
        replace(record, envelope=envelope),
        replace(record, scenario=record.scenario + " "),
        replace(record, labels=record.labels | {"bridged": True}),
        replace(record, stiffness=record.stiffness.astype(np.float32) + 8.0),
    ]
    assert content_hash(to_dataset([replace(record)], {"title": "another"})) == first
    assert len({first, *(content_hash(to_dataset([one], {})) for one in changed)}) == 5


def test_a_dataset_made_by_the_format_breaks_none_of_its_rules(dataset: xarray.Dataset) -> None:
    assert list(violations(dataset)) == []


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("acceleration", np.nan, "acceleration has 1 values that are not finite"),
        ("speed_rpm", np.nan, "speed_rpm has 1 values that are not finite"),  # which simulations know
        ("snr_db", np.inf, "snr_db has 1 values that are not finite"),  # which may be NaN
        ("condition", "broken", 'condition has the value "broken"'),
        ("condition", "unknown", 'condition has the value "unknown"'),  # as of recordings alone
        ("condition", "extended", "condition and extent_spacing disagree"),
        ("extent_spacing", 1.0, "condition and extent_spacing disagree"),  # of a line spall
        ("location", "none", "condition and location disagree"),
        ("spalls", 2, "condition and spalls"),
        ("extent", 0.0, "condition and extent disagree"),
        ("envelope_band", 250.0, "envelope_band is not below half the rate"),  # up to 200 Hz
        ("tension_share", 1.5, "tension_share is not a share"),
        ("tension_share", -0.1, "tension_share is not a share"),
        ("record", 9, "a record occurs twice"),
        ("duration_s", 0.3, "duration_s = 0.3 does not fit 200 samples"),  # 0.2 s
        ("defect_record", 9, "the defect table and the label spalls disagree"),  # which is healthy
        ("pass_record", 77, "a ball pass belongs to no record"),
        ("exit_time", 0.0, "not in the order entry, deepest point, exit"),
        ("release_time", 0.039, "a release lies outside its pass"),  # which lasts from 0.04 to 0.06 s
        ("release_time", 0.061, "a release lies outside its pass"),
        ("regain_time", 0.044, "contact is regained before it is lost"),  # at 0.045 s
        ("time", 0.5, "time is not 0"),
    ],
)
def test_one_wrong_value_is_named(dataset: xarray.Dataset, name: str, value: object, sentence: str) -> None:
    values = dataset[name].values.astype(object if isinstance(value, str) else dataset[name].dtype)
    values.flat[0] = value
    if name == "spalls":
        values[:] = (0, 1)
    changed = dataset.assign({name: (dataset[name].dims, values, dataset[name].attrs)})
    assert any(sentence in found for found in violations(changed))


@pytest.mark.parametrize(("high", "named"), [(500.0, False), (500.1, True)])
def test_a_band_may_end_at_half_the_rate_and_not_above(dataset: xarray.Dataset, high: float, named: bool) -> None:
    dataset["envelope_band"][1, 1] = high  # of a rate of 1000 Hz
    sentences = ["envelope_band is not below half the rate in record 9"] if named else []
    assert list(violations(dataset)) == sentences


def test_a_load_that_rises_before_it_falls_is_named(dataset: xarray.Dataset) -> None:
    for fall, rise in ((0.045, 0.055), (0.055, 0.045)):
        times = {"fall_time": fall, "rise_time": rise}
        values = {name: np.full(dataset[name].shape, time) for name, time in times.items()}
        changed = dataset.assign({name: (dataset[name].dims, own, dataset[name].attrs) for name, own in values.items()})
        assert any("load rises before it falls" in found for found in violations(changed)) == (rise < fall)


def test_a_missing_variable_or_unit_is_named(dataset: xarray.Dataset) -> None:
    for name in ("envelope", "time", "rate_hz", "condition", "record", "pass_record", "defect_record"):
        assert list(violations(dataset.drop_vars(name))) == [f"{name} is missing"]
    dataset["stiffness"].attrs["units"] = "N/mm"
    assert any('stiffness has the unit "N/mm"' in found for found in violations(dataset))


def test_axes_in_another_order_and_another_type_are_named(dataset: xarray.Dataset) -> None:
    turned = dataset.assign(envelope=dataset["envelope"].transpose("time", "record"))
    assert list(violations(turned)) == ["envelope has dimensions ('time', 'record'); they must be ('record', 'time')"]
    single = dataset.assign(speed_rpm=dataset["speed_rpm"].astype(np.float32))
    assert list(violations(single)) == ["speed_rpm is of type float32; it must be float64"]


def test_lz4_is_refused_with_its_reason(dataset: xarray.Dataset) -> None:
    with pytest.raises(BadInput, match=r"lz4 filter fails.*zlib, none"):
        netcdf_bytes(dataset, "lz4")


def test_the_profile_grid_runs_from_minus_pi_to_pi_without_its_end() -> None:
    grid = profile_grid(8)
    assert grid[0] == -np.pi
    assert grid[4] == 0.0
    assert np.allclose(np.diff(grid), np.pi / 4.0, rtol=1e-15)  # rounding of the products


def test_the_format_hash_is_16_hexadecimal_digits_that_change_with_any_label(monkeypatch: pytest.MonkeyPatch) -> None:
    found = {format_hash()}
    assert re.fullmatch("[0-9a-f]{16}", *found)
    for change in ({"unit": "furlong"}, {"name": "other"}, {"sentence": "Something else."}):
        monkeypatch.setattr(format, "LABELS", (*LABELS[:-1], replace(LABELS[-1], **change)))
        found.add(format_hash.__wrapped__())
    monkeypatch.setattr(format, "LABELS", LABELS[:-1])
    assert len(found | {format_hash.__wrapped__()}) == 5


def test_a_shaft_that_stands_still_between_two_samples_is_named(dataset: xarray.Dataset) -> None:
    angle = np.tile(0.1 * np.arange(dataset.sizes["time"]), (dataset.sizes["record"], 1))
    attributes = {"units": "rad", "long_name": "angle of the shaft"}
    for still in (False, True):
        angle[0, 3] = angle[0, 4] if still else angle[0, 3]
        changed = dataset.assign({"shaft_angle": (("record", "time"), angle, attributes)})
        assert any("shaft_angle does not grow" in found for found in violations(changed)) == still
