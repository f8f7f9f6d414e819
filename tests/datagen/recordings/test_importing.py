from __future__ import annotations

import errno
import json
import os
import socket
import subprocess
import sys
import wave
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray
from command_line import run
from imports import Bring, Mat, noise
from scipy.io import wavfile

from datagen.corpus import Corpus
from datagen.drawing.preview import draw_preview
from datagen.errors import BadInput
from datagen.files import places
from datagen.files.digest import file_hash
from datagen.inspection.check import check_corpus
from datagen.inspection.conformity import violations
from datagen.inspection.info import corpus_info
from datagen.recordings.importing import import_recordings
from datagen.recordings.listing import Request
from datagen.recordings.recorded import Recorded, read_recording
from datagen.recordings.spec import load_spec
from datagen.recordings.staging import staged
from labels.envelope import band_envelope
from labels.schema import LABEL

G = 9.80665


def as_stored(samples: np.ndarray, factor: float) -> np.ndarray:
    """What float64 numbers times their scale are as stored: float32, shown as float64."""
    return (samples * factor).astype(np.float32).astype(np.float64)


def test_counts_of_a_packed_file_come_back_in_m_s2_with_each_records_own_scale(bring: Bring, tmp_path: Path) -> None:
    counts = {f"{k}_DE": np.random.default_rng(k).integers(-3000, 3000, 500 + k).astype(np.int16) for k in (1, 2)}
    np.savez(tmp_path / "pack.npz", **counts)
    (tmp_path / "rows.csv").write_text(
        "file,recording,y,scale,location,extent_mm,speed_rpm,nominal_speed_rpm,bearing_id,hp\n"
        "pack.npz,one,1_DE,0.00016243512974051903,inner,0.178,1796.5,1797,IR007,0\n"
        "pack.npz,two,2_DE,0.00020861538461538508,none,,,1772,normal,1\n"
    )
    corpus = bring(
        '[defaults]\nunit = "g"\nrate_hz = 12000\nbearing = "skf_6205"\n'
        '[[recording]]\nname = "all"\ntable = "rows.csv"\nnote_columns = ["hp"]\n'
    )
    assert np.array_equal(corpus.signal(0), as_stored(counts["1_DE"] * 0.00016243512974051903, G))
    assert np.array_equal(corpus.signal(1), as_stored(counts["2_DE"] * 0.00020861538461538508, G))
    table = corpus.labels
    assert table["recording"].tolist() == ["one", "two"]
    assert table["speed_rpm"].tolist() == [1796.5, 1772.0]
    assert table["speed_basis"].tolist() == ["measured", "nominal"]
    assert table["condition"].tolist() == ["line", "healthy"]
    # The inner raceway's radius is (39.04 - 7.94) / 2 mm.
    assert table["extent"][0] == pytest.approx(0.178 / 15.55, rel=1e-12)
    assert table["extent_spacing"][0] == pytest.approx(0.178 / 15.55 * 9.0 / (2.0 * np.pi), rel=1e-12)
    assert np.isnan(table["spalls"][0])
    assert table["spalls"][1] == 0.0
    assert json.loads(corpus.waveform(1, "provenance"))["notes"] == {"hp": 1}
    assert json.loads(corpus.waveform(0, "provenance"))["m_s2_per_number"] == 0.00016243512974051903 * G
    assert check_corpus(tmp_path / "corpus").problems == ()


def test_tables_of_one_name_in_two_folders_are_both_told_of(bring: Bring, tmp_path: Path) -> None:
    text = '[defaults]\nunit = "g"\nrate_hz = 12000\ny = "data"\n'
    for name, samples in {"a": 400, "b": 401}.items():
        (tmp_path / name).mkdir()
        np.save(tmp_path / name / f"{name}.npy", noise(samples))
        (tmp_path / name / "t.csv").write_text(f"file,location\n{name}/{name}.npy,inner\n")
        text += f'[[recording]]\nname = "{name}"\ntable = "{name}/t.csv"\n'
    assert set(bring(text).manifest.recipe["tables"]) == {"a/t.csv", "b/t.csv"}


@pytest.mark.parametrize("quote", ["", '"'])
@pytest.mark.parametrize(("sign", "encoding"), [(";", "utf-8-sig"), ("\t", "utf-8")])
def test_a_label_table_with_decimal_commas_says_the_same(
    sign: str, encoding: str, quote: str, bring: Bring, tmp_path: Path
) -> None:
    np.save(tmp_path / "a.npy", noise(400).reshape(200, 2))
    (tmp_path / "t.csv").write_text(
        sign.join(f"{quote}{name}{quote}" for name in ("file", "y", "extent_mm", "location", "speed_rpm", "hp"))
        + "\r\n" + sign.join(("a.npy", "data[:,1]", "0,178", "inner", "1796,5", "1,5")),
        encoding=encoding, newline="",
    )  # fmt: skip
    corpus = bring(
        '[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 12000\nbearing = "skf_6205"\n'
        'note_columns = ["hp"]\n'
    )
    assert np.array_equal(corpus.signal(0), as_stored(noise(400).reshape(200, 2)[:, 1], G))
    assert corpus.labels["speed_rpm"].tolist() == [1796.5]
    assert corpus.labels["extent"][0] == pytest.approx(0.178 / 15.55, rel=1e-12)
    assert json.loads(corpus.waveform(0, "provenance"))["notes"] == {"hp": 1.5}


def test_a_name_whose_figures_are_joined_is_no_number(bring: Bring, tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", noise(400))
    (tmp_path / "t.csv").write_text("file,y,code,count\na.npy,data,105_2,1052\n")
    corpus = bring(
        '[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 12000\nspeed_rpm = 1800\n'
        'bearing = "skf_6205"\nnote_columns = ["code", "count"]\n'
    )
    assert '"notes": {"code": "105_2", "count": 1052}' in corpus.waveform(0, "provenance")


def test_two_axes_and_two_channels_become_records_of_their_own(bring: Bring, tmp_path: Path) -> None:
    samples = noise(1200).reshape(300, 4)
    np.save(tmp_path / "a.npy", samples)
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "*.npy"\nunit = "m/s2"\nscale = 2\nrate_hz = 1000\nchannel = ['
        '{name = "near", x = "data[:,0]", y = "data[:,1]"}, {name = "far", y = "data[:,3]"}]\n'
    )
    assert corpus.labels["recording"].tolist() == ["a near", "a far"]
    assert np.array_equal(corpus.signal(0, "x"), as_stored(samples[:, 0], 2.0))
    assert np.array_equal(corpus.signal(0, "y"), as_stored(samples[:, 1], 2.0))
    assert np.array_equal(corpus.signal(1), as_stored(samples[:, 3], 2.0))
    assert corpus.waveform(1).shape == (300, 1)
    along = corpus.signal(0, "y").astype(np.float32).astype(np.float64)  # and not across
    band = corpus.labels.loc[0, ["envelope_band_low", "envelope_band_high"]]
    envelope = band_envelope(along, 1000.0, tuple(band.astype(float)))
    assert corpus.waveform(0, "envelope") == pytest.approx(envelope, rel=1e-6)  # float32
    assert corpus.labels["shard"].nunique() == 2


def test_text_wave_and_netcdf_files_come_in_side_by_side(bring: Bring, tmp_path: Path) -> None:
    values = noise(64)
    text = "t;a\n" + "".join(f"{k};{value!r}\n" for k, value in enumerate(values.tolist()))
    (tmp_path / "a.csv").write_text(text)
    counts = np.random.default_rng(3).integers(-32768, 32767, 64).astype("<i2")
    with wave.open(str(tmp_path / "b.wav"), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(4000)
        file.writeframes(counts.tobytes())
    with netCDF4.Dataset(tmp_path / "c.nc", "w") as opened:
        opened.createDimension("n", 64)
        opened.createVariable("acc", "f4", ("n",))[...] = values
        opened.createVariable("fs", "f8", ())[...] = 3000.0
    corpus = bring(
        '[defaults]\nunit = "m/s2"\n'
        '[[recording]]\nname = "text"\nfiles = "a.csv"\ny = "a"\nrate_hz = 2000\ncsv = {delimiter = ";"}\n'
        '[[recording]]\nname = "wave"\nfiles = "*.wav"\ny = "data"\nscale = 500\n'
        '[[recording]]\nname = "netcdf"\nfiles = "*.nc"\ny = "acc"\nrate_hz = {variable = "fs"}\n'
    )
    assert corpus.labels["rate_hz"].tolist() == [2000.0, 4000.0, 3000.0]
    assert np.array_equal(corpus.signal(0), as_stored(values, 1.0))
    assert np.array_equal(corpus.signal(1), as_stored(counts / 32768.0, 500.0))
    assert np.array_equal(corpus.signal(2), values.astype(np.float32).astype(np.float64))


def test_what_is_not_said_is_unknown_and_absent(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    corpus = bring('[[recording]]\nname = "all"\nfiles = "a.mat"\nx = "sig"\nunit = "g"\nrate_hz = 5000\n')
    row = corpus.labels.iloc[0]
    for name in ("condition", "location", "split", "rig", "bearing", "bearing_id", "contact_law", "speed_basis"):
        assert row[name] == "unknown", name
        assert LABEL[name].values is None or "unknown" in LABEL[name].imported
    for name in ("speed_rpm", "load_n", "extent_mm", "bpfo", "balls", "bridged", "envelope_band_low", "snr_db"):
        assert np.isnan(row[name]), name
    assert corpus_info(corpus.folder).bearings_text == "unknown"
    with xarray.open_dataset(next((tmp_path / "corpus" / "shards").glob("*.nc"))) as shard:
        held = set(shard.variables)
        assert shard["axis"].values.tolist() == ["x"]
    absent = {"envelope", "stiffness", "scenario", "balls", "bridged", "pass_record", "defect_record"}
    assert not held & absent
    assert check_corpus(tmp_path / "corpus").sound


def test_a_shard_of_recordings_may_leave_labels_open_and_nothing_else(bring: Bring, mat: Mat) -> None:
    mat("a.mat")
    corpus = bring('[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n')
    with xarray.open_dataset(corpus.folder / "shards" / "shard_000000.nc") as opened:
        dataset = opened.load()
    assert dataset.attrs["title"] == "mine"  # the name, as there is no title
    assert not {"license", "references"} & set(dataset.attrs)  # of which nothing is said
    assert "spalls" not in dataset
    assert np.isnan(dataset["speed_rpm"].values).all()
    assert dataset["speed_rpm"].attrs["missing"] == "NaN where it is unknown"
    assert dataset["slip_deviation"].attrs["missing"] == "NaN where it is unknown"
    noise = "the record has no background, or its sensor no signal"
    assert dataset["snr_db"].attrs["missing"] == f"NaN where {noise}, or it is unknown"
    assert "missing" not in dataset["acceleration"].attrs
    assert list(violations(dataset)) == []
    for name in ("speed_rpm", "location", "acceleration", "provenance"):
        assert f"{name} is missing" in list(violations(dataset.drop_vars(name)))
    for name, value in (("speed_rpm", np.inf), ("acceleration", np.nan)):
        changed = dataset.copy(deep=True)
        changed[name].values.flat[0] = value
        assert list(violations(changed)) == [f"{name} has 1 values that are not finite"]


@pytest.mark.parametrize(
    ("law", "parameters"),
    [
        ("", {}),
        (", load_deflection_n_per_m_to_n = 4e8, exponent = 1.11", {"K": 4e8, "n": 1.11}),
        (", load_deflection_n_per_m_to_n = 5e9", {"K": 5e9, "n": 1.5}),
    ],
)
def test_the_contact_law_that_the_spec_states_is_kept_with_the_record(
    law: str, parameters: dict[str, float], bring: Bring, mat: Mat
) -> None:
    mat("a.mat")
    bearing = f"bearing = {{balls = 12, rows = 2, pitch_diameter_mm = 38.75, ball_diameter_mm = 7.12{law}}}\n"
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    corpus = bring(spec + bearing)
    assert json.loads(corpus.waveform(0, "provenance"))["parameters"] == parameters
    assert corpus.labels[["balls", "rows"]].to_numpy().tolist() == [[12, 2]]


def test_load_and_signal_to_noise_ratio_are_stored_as_they_are_said(bring: Bring, mat: Mat) -> None:
    mat("a.mat")
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    labels = bring(spec + "load_n = 250\nsnr_db = -4\n").labels
    assert labels[["load_n", "snr_db"]].to_numpy().tolist() == [[250.0, -4.0]]


def test_a_speed_comes_from_a_variable_a_tach_or_a_nominal_value(bring: Bring, mat: Mat) -> None:
    time = np.arange(5000) / 5000.0
    mat("a.mat", noise(5000), rps=24.5, tacho=(np.sin(2.0 * np.pi * 60.0 * time - 0.3) > 0.0).astype(float))
    common = 'files = "a.mat"\nunit = "g"\nrate_hz = 5000\ny = "sig"\n'
    nominal = 'speed_rpm = {variable = "rpm"}\nnominal_speed_rpm = 1500\n'
    corpus = bring(
        'same_samples = "keep"\n'
        f'[[recording]]\nname = "a"\nrecording = "a"\n{common}speed_hz = {{variable = "rps"}}\n'
        f'[[recording]]\nname = "b"\nrecording = "b"\n{common}tach = {{variable = "tacho", pulses_per_rev = 2}}\n'
        f'[[recording]]\nname = "c"\nrecording = "c"\n{common}{nominal}'
    )
    assert corpus.labels["speed_basis"].tolist() == ["measured", "tach", "nominal"]
    # Edges of a switched signal are known to a sample of 0.2 ms at either end of a second.
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([1470.0, 1800.0, 1500.0], rel=4e-4)


def test_a_long_recording_is_cut_into_whole_pieces_each_with_its_own_speed(bring: Bring, mat: Mat) -> None:
    pulses = np.concatenate([np.tile([0, 0, 0, 0, 1], 200), np.tile([0, 0, 0, 1], 275)]).astype(float)
    samples = mat("a.mat", noise(2100), tacho=pulses)
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "m/s2"\nrate_hz = 1000\ny = "sig"\ncut_s = 1\n'
        'tach = {variable = "tacho"}\n'
    )
    assert corpus.labels["recording"].tolist() == ["a#0", "a#1"]
    assert np.array_equal(corpus.signal(1), as_stored(samples[1000:2000], 1.0))
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([12000.0, 15000.0], rel=1e-9)
    origins = [json.loads(corpus.waveform(record, "provenance")) for record in (0, 1)]
    assert [(origin["first_sample"], origin["samples"]) for origin in origins] == [(0, 1000), (1000, 1000)]


def test_a_tach_may_have_a_rate_of_its_own(bring: Bring, mat: Mat) -> None:
    pulses = np.tile([0.0, 0.0, 0.0, 0.0, 1.0], 100)  # 50 a second at 250 Hz
    mat("a.mat", noise(2000), tacho=pulses)
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "m/s2"\nrate_hz = 1000\ny = "sig"\n'
        'tach = {variable = "tacho", rate_hz = 250}\n'
    )
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([3000.0], rel=1e-9)


def test_one_shard_holds_one_rate_and_length(bring: Bring, mat: Mat) -> None:
    for name, size in (("a", 300), ("b", 400), ("c", 300)):
        mat(f"{name}.mat", noise(size, seed=size + ord(name)))
    corpus = bring('[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n')
    assert corpus.labels.groupby("shard")["duration_s"].nunique().tolist() == [1, 1]
    assert corpus.labels["duration_s"].tolist() == [0.3, 0.4, 0.3]


def test_records_of_which_more_is_known_keep_it_beside_those_of_which_less_is(bring: Bring, mat: Mat) -> None:
    for name in "abc":
        mat(f"{name}.mat")
    known = '[[recording.override]]\nfiles = "b.mat"\nbearing = "skf_6205"\nlocation = "outer"\nspalls = 2\n'
    labels = bring(
        f'[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n{known}'
    ).labels
    for name, number in (("balls", 9), ("rows", 1), ("spalls", 2)):
        assert labels[name].isna().tolist() == [True, False, True]
        assert labels.loc[1, name] == number


def test_a_defect_as_long_as_the_ball_spacing_is_extended(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    arcs = {"a": 39.9, "b": 40, "c": 40.1}  # nine balls are 40 degrees apart
    for name in arcs:
        mat(f"{name}.mat")
    rows = "".join(f"{name}.mat,{arc}\n" for name, arc in arcs.items())
    (tmp_path / "t.csv").write_text(f"file,extent_deg\n{rows}")
    known = 'unit = "g"\nrate_hz = 1000\ny = "sig"\nbearing = "skf_6205"\nlocation = "outer"\n'
    labels = bring(f'[[recording]]\nname = "all"\ntable = "t.csv"\n{known}').labels
    assert labels["condition"].tolist() == ["line", "extended", "extended"]


@pytest.mark.parametrize(
    ("said", "condition"),
    [
        ('condition = "extended"', "extended"),
        ('condition = "line"\nextent_mm = 1', "line"),  # of unknown spacing
        ('condition = "line"\nextent_mm = 1\nbearing = "skf_6205"', "line"),
        ('extent_mm = 1\nbearing = "skf_6205"', "line"),
        ("extent_mm = 1", "unknown"),
    ],
)
def test_a_stated_condition_stands_where_no_extent_tells_it(said: str, condition: str, bring: Bring, mat: Mat) -> None:
    mat("a.mat")
    labels = bring(f'{SPEC}location = "outer"\n{said}\n').labels
    assert labels[["condition", "location"]].to_numpy().tolist() == [[condition, "outer"]]


def test_another_table_of_labels_makes_another_corpus(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    found = []
    for load in (100, 200):
        (tmp_path / "t.csv").write_text(f"file,load_n\na.mat,{load}\n")
        found.append(
            bring('[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n', str(load))
        )
        assert found[-1].manifest.recipe["tables"] == {"t.csv": file_hash(tmp_path / "t.csv")}
    one, other = (corpus.manifest.identity.recipe_hash for corpus in found)
    assert one != other


def test_overrides_go_before_tables_and_tables_before_the_rest(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("r1.mat", "sub/r2.mat", "sub/r3.mat"):
        mat(name)
    (tmp_path / "t.csv").write_text("file,location,bearing_id\nr1.mat,outer,x\nsub/r2.mat,,y\nr3.mat,ball,\n")
    corpus = bring(
        '[defaults]\nunit = "g"\nrate_hz = 1000\nrig = "mill"\n'
        '[[recording]]\nname = "all"\nfiles = "**/*.mat"\ntable = "t.csv"\ny = "sig"\nlocation = "inner"\n'
        'override = [{files = "sub/*", rig = "fan"}, {files = ["r3.mat"], notes = {odd = true}}]\n'
    )
    table = corpus.labels
    assert table["location"].tolist() == ["outer", "inner", "ball"]
    assert table["rig"].tolist() == ["mill", "fan", "fan"]
    assert table["bearing_id"].tolist() == ["x", "y", "unknown"]
    assert corpus_info(corpus.folder).bearings_text == "2 (unknown 2); 1 record of unknown ones"
    assert json.loads(corpus.waveform(2, "provenance"))["notes"] == {"odd": True}


def test_a_label_table_may_hold_the_numbers_of_every_bearing(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("a.mat", "b.mat"):
        mat(name, slow=np.full((50, 1), 600.0))
    (tmp_path / "t.csv").write_text(
        "file,bearing,speed_rpm,y\n"
        'a.mat,"{balls = 9, ball_diameter_mm = 7.94, pitch_diameter_mm = 39.04}",{variable = "slow"},sig\n'
        "b.mat,skf_6205,1797,sig\n"
    )
    labels = bring('[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\n').labels
    assert labels["balls"].tolist() == [9, 9]
    assert labels["ball_diameter"][0] == pytest.approx(7.94e-3)
    assert labels["speed_rpm"].tolist() == [600.0, 1797.0]


def test_an_override_of_one_axis_leaves_the_other(bring: Bring, mat: Mat) -> None:
    for name in ("a.mat", "b.mat"):
        mat(name, other=noise(seed=5)[:, None], third=noise(seed=6)[:, None])
    corpus = bring(
        '[defaults]\nunit = "g"\nrate_hz = 1000\n[[recording]]\nname = "all"\nfiles = "*.mat"\nx = "sig"\ny = "other"\n'
        'override = [{files = "b*", y = "third"}]\n'
    )
    assert [corpus.waveform(record, "acceleration").shape[-1] for record in (0, 1)] == [2, 2]
    plain, changed = (corpus.waveform(record, "acceleration")[:, 1] for record in (0, 1))
    assert np.corrcoef(plain, noise(seed=5))[0, 1] == pytest.approx(1.0)
    assert np.corrcoef(changed, noise(seed=6))[0, 1] == pytest.approx(1.0)


@pytest.mark.parametrize("column", ["speed_rpm", "file", "location"])
def test_no_column_that_says_something_else_is_a_note(column: str, bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    (tmp_path / "t.csv").write_text("file,speed_rpm,location\na.mat,3000,outer\n")
    with pytest.raises(BadInput, match=f'"{column}" is a column that says something else, and is never a note'):
        bring(
            '[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
            f'note_columns = ["{column}"]\n'
        )


def test_a_root_that_is_not_there_is_blamed_on_who_named_it(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    text = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    with pytest.raises(BadInput, match=r'spec\.toml: root = ".*nowhere": no such folder'):
        bring('root = "nowhere"\n' + text)
    with pytest.raises(BadInput, match=r'^--root = "elsewhere": no such folder; allowed: the folder of the recordings'):
        import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "out", "elsewhere")


def test_an_import_that_fails_leaves_no_folder(mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mat("a.mat")
    text = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    (tmp_path / "spec.toml").write_text('name = "mine"\n' + text)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("datagen.recordings.importing.write_shard", full)
    with pytest.raises(BadInput, match="cannot write here: No space left on device"):
        import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "new" / "deep" / "corpus")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mat", "spec.toml"]


def test_the_current_folder_is_refused_before_anything_is_read(
    mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mat("a.mat")
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    (tmp_path / "spec.toml").write_text(
        'name = "set"\n[[recording]]\nname = "all"\nfiles = "absent.mat"\ny = "sig"\nunit = "g"\n'
    )
    code, _, message = run("import", tmp_path / "spec.toml", "--out", ".")
    assert code == 2
    assert "the current one cannot be replaced; allowed: another folder, new or empty" in message
    assert list(here.iterdir()) == []


@pytest.mark.parametrize("cause", ["mounted", "parent"])
def test_a_folder_that_cannot_be_replaced_is_refused_before_anything_is_read(
    cause: str, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mat("a.mat")
    parent = tmp_path / "parent"
    out = parent / "out"
    out.mkdir(parents=True)
    if cause == "mounted":
        monkeypatch.setattr(Path, "is_mount", lambda path: path == out)
    else:
        monkeypatch.setattr(places, "is_writable", lambda folder: folder != parent)
    (tmp_path / "spec.toml").write_text(
        'name = "set"\n[[recording]]\nname = "all"\nfiles = "absent.mat"\ny = "sig"\nunit = "g"\n'
    )
    code, _, message = run("import", tmp_path / "spec.toml", "--out", out)
    assert code == 2
    assert {"mounted": "mounted on cannot be replaced", "parent": f"cannot write into {parent}"}[cause] in message


def test_a_relative_folder_is_put_where_it_says(mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mat("a.mat")
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    text = 'name = "set"\n[[recording]]\nname = "all"\nfiles = "a.mat"\ny = "sig"\nunit = "g"\nrate_hz = 5000\n'
    (tmp_path / "spec.toml").write_text(text)
    assert run("import", tmp_path / "spec.toml", "--out", "../out")[0] == 0
    assert run("check", tmp_path / "out")[0] == 0


def test_geometry_and_size_are_stored_in_si_units_and_give_the_published_orders(bring: Bring, mat: Mat) -> None:
    mat("a.mat")
    labels = bring(
        '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 6000\ny = "sig"\nspeed_rpm = 2000\n'
        "bearing = {balls = 16, pitch_diameter_mm = 71.5, ball_diameter_mm = 8.407, contact_angle_deg = 15.17}\n"
        'location = "inner"\nextent_deg = 6\ndepth_um = 12\n'
    ).labels.iloc[0]
    stored = labels[["pitch_diameter", "ball_diameter", "contact_angle", "depth", "extent", "extent_spacing"]].tolist()
    # Radians of 15.17 and of 6 degrees; 6 degrees of 360 / 16.
    assert stored == pytest.approx([0.0715, 0.008407, 0.264766, 12e-6, 0.1047198, 6.0 / 22.5], rel=2e-6)
    # Along an inner race of (71.5 - 8.407 cos 15.17°) / 2 = 31.693 mm.
    assert labels["extent_mm"] == pytest.approx(31.693 * 0.1047198, rel=2e-5)
    # Published with the ZA-2115 of IMS at 2000 rpm, Hz; without its contact angle BPFO would be 235.3 Hz.
    assert labels["bpfo"] * 2000.0 / 60.0 == pytest.approx(236.4, abs=0.05)
    assert labels["bpfi"] * 2000.0 / 60.0 == pytest.approx(296.9, abs=0.05)


def test_everything_that_reads_a_corpus_reads_an_imported_one(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("a.mat", "b.mat"):
        mat(name, noise(3000, seed=ord(name[0])))
    corpus = bring(
        'title = "Two"\n[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 6000\ny = "sig"\n'
        "bearing = {balls = 8, pitch_diameter_mm = 40, ball_diameter_mm = 8}\nspeed_rpm = 3000\n"
    )
    assert corpus.to_numpy().shape == (2, 3000, 1)
    assert corpus[1][1]["recording"] == "b"
    info = corpus_info(tmp_path / "corpus")
    assert (info.title, info.records, info.counts["location"]) == ("Two", 2, {"unknown": 2})
    drawn = draw_preview(tmp_path / "corpus", 1, tmp_path / "b.png")
    # 8 balls of a fifth of the pitch diameter: BPFO = 8 (1 - 0.2) / 2 = 3.2 orders of 50 Hz.
    assert drawn["frequencies_hz"]["BPFO"] == pytest.approx(160.0, rel=1e-12)
    assert (tmp_path / "b.png").read_bytes().startswith(b"\x89PNG")


def test_a_changed_file_of_an_imported_corpus_is_found(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    bring('[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 6000\ny = "sig"\n')
    manifest = tmp_path / "corpus" / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"rate_hz": 6000.0', '"rate_hz": 6001.0'))
    assert check_corpus(tmp_path / "corpus").problems == (
        "manifest.json: its SPEC and files do not have the hash that it states",
    )


def test_the_name_of_the_channel_alone_does_not_replace_its_variable(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    samples = mat("a.mat")
    (tmp_path / "t.csv").write_text("file,channel_name\na.mat,DE\n")
    corpus = bring('[[recording]]\nname = "all"\nunit = "m/s2"\nrate_hz = 1000\ny = "sig"\ntable = "t.csv"\n')
    assert corpus.labels["recording"].tolist() == ["a DE"]
    assert np.array_equal(corpus.signal(0), as_stored(samples, 1.0))


def test_a_tach_beside_the_vibration_of_a_wave_file_is_timed_by_the_files_rate(bring: Bring, tmp_path: Path) -> None:
    pulses = np.tile(np.repeat([0, 8000], [60, 20]), 50)
    frames = np.stack([np.random.default_rng(0).integers(-9000, 9000, pulses.size), pulses], axis=1)
    with wave.open(str(tmp_path / "a.sound"), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(4000)
        file.writeframes(frames.astype("<i2").tobytes())
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "*.sound"\nformat = "wav"\nunit = "g"\ny = "data[:,0]"\n'
        'tach = {variable = "data[:,1]"}\n'
    )
    assert corpus.labels["rate_hz"][0] == 4000.0
    assert corpus.labels["speed_rpm"][0] == pytest.approx(60.0 * 4000.0 / 80.0, rel=1e-12)


def test_a_table_may_name_a_file_outside_the_root(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    samples = mat("elsewhere/a.mat")
    (tmp_path / "inside").mkdir()
    (tmp_path / "t.csv").write_text(f"file\n{tmp_path}/elsewhere/a.mat\n")
    corpus = bring(
        'root = "inside"\n[[recording]]\nname = "all"\nunit = "m/s2"\nrate_hz = 1000\ny = "sig"\ntable = "t.csv"\n'
    )
    assert corpus.labels["source_file"][0] == f"{tmp_path}/elsewhere/a.mat"
    assert np.array_equal(corpus.signal(0), as_stored(samples, 1.0))


def test_a_dead_sensor_comes_in_with_a_warning(mat: Mat, tmp_path: Path) -> None:
    for name in ("dead.mat", "gone.mat"):
        mat(name, np.full(400, 2.5), other=np.zeros(400))
    mat("half.mat", other=np.zeros(400))
    (tmp_path / "spec.toml").write_text(
        'name = "mine"\n[[recording]]\nname = "all"\nfiles = "*.mat"\nrate_hz = 1000\nunit = "g"\n'
        'x = "other"\ny = "sig"\n'
    )
    code, shown, message = run("import", tmp_path / "spec.toml", "--out", tmp_path / "out", "--json", tmp_path / "j")
    assert code == 0
    assert ": 3 records of 3 files (" in shown
    names = ["dead (x, y)", "gone (x, y)", "half (x)"]
    assert message == f"3 without a signal, as if the sensor were not connected: {', '.join(names)}\n"
    assert json.loads((tmp_path / "j").read_text())["dead"] == names
    with Corpus(tmp_path / "out") as corpus:
        stored = [json.loads(str(corpus.waveform(record, "provenance"))).get("no_signal") for record in range(3)]
    assert stored == [["x", "y"], ["x", "y"], ["x"]]
    assert run("check", tmp_path / "out")[0] == 0


@pytest.mark.parametrize(
    ("said", "lines"),
    [
        ('bearing = "skf_6205"\nspeed_rpm = 1797', []),
        ("bpfo = 3.58\nbpfi = 5.42\nspeed_rpm = 1797", []),
        ("bpfo = 3.58\nspeed_rpm = 1797", ["`classify` will reject 2 of them: geometry unknown"]),
        ('bearing = "skf_6205"', ["`classify` will reject 2 of them: speed unknown"]),
        (
            'speed_rpm = 0\n[[recording.override]]\nfiles = "b.mat"\nspeed_rpm = 1797',
            [
                "`classify` will reject 1 of them: speed not above 0",
                "`classify` will reject 1 of them: geometry unknown",
            ],
        ),
    ],
)
def test_records_that_say_too_little_to_be_judged_are_counted(
    said: str, lines: list[str], mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    mat("b.mat")
    (tmp_path / "spec.toml").write_text(f'{DOUBTED}files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{said}\n')
    code, shown, _ = run("import", tmp_path / "spec.toml", "--out", tmp_path / "out")
    assert code == 0
    assert shown.splitlines()[1:] == lines


DOUBTED = 'name = "mine"\n[[recording]]\nname = "all"\nunit = "g"\n'


def told_of(settings: str, tmp_path: Path) -> str:
    """What the import of recordings with these settings says on standard error."""
    (tmp_path / "spec.toml").write_text(DOUBTED + settings)
    code, _, message = run("import", tmp_path / "spec.toml", "--out", tmp_path / "out")
    assert code == 0
    assert run("check", tmp_path / "out")[0] == 0
    return message


@pytest.mark.parametrize(
    ("level", "mean", "message"),
    [
        (659.0, 0.0, "1 louder than machines are, as if `scale` or `unit` were wrong: a (y 659 g RMS)\n"),
        (99.0, 0.0, ""),
        (65.0, -80.0, "1 louder than machines are, as if `scale` or `unit` were wrong: a (y 103 g RMS)\n"),
        (58.0, -80.0, ""),  # 98.8 g together
        (0.5, 5.5, "1 with a mean above 10 times the vibration around it, as of gravity or a sensor's bias: "
                   "a (y 5.5 g beside 0.5 g RMS)\n"),
        (0.5, -5.5, "1 with a mean above 10 times the vibration around it, as of gravity or a sensor's bias: "
                   "a (y -5.5 g beside 0.5 g RMS)\n"),
        (0.5, -4.5, ""),
    ],
)  # fmt: skip
def test_a_level_that_hardly_any_machine_has_comes_in_with_a_warning(
    level: float, mean: float, message: str, mat: Mat, tmp_path: Path
) -> None:
    signal = noise()
    mat("a.mat", mean + level * (signal - signal.mean()) / signal.std())
    assert told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path) == message


@pytest.mark.parametrize(
    ("limit", "steps", "message"),
    [
        (1.0, 0, "1 with peaks cut off, as if the recorder's range were too small: a (y 0.055 of its samples)\n"),
        (9.0, 0, ""),
        (1.0, 4, ""),  # few values, as of a quiet signal in coarse steps, often have two alike
    ],
)
def test_peaks_that_a_recorder_cut_off_come_in_with_a_warning(
    limit: float, steps: int, message: str, mat: Mat, tmp_path: Path
) -> None:
    cut_off = np.clip(noise(), -limit, limit)
    mat("a.mat", np.round(cut_off * steps) if steps else cut_off)
    assert told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path) == message


HELD = "1 with a stretch of one value, as if padded or the signal lost; from_s and to_s take what is beside it: "


@pytest.mark.parametrize(
    ("value", "start", "stop", "message"),
    [
        (0.0, 1000, 4000, HELD + "a (y 3000 of 4000 samples)\n"),
        (0.3, 100, 300, HELD + "a (y 200 of 4000 samples)\n"),
        (0.3, 100, 190, ""),
    ],
)
def test_a_signal_that_stands_still_for_long_comes_in_with_a_warning(
    value: float, start: int, stop: int, message: str, mat: Mat, tmp_path: Path
) -> None:
    signal = noise(4000)
    signal[start:stop] = value
    mat("a.mat", signal)
    assert told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path) == message


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_times_taken_for_a_vibration_come_in_with_a_warning(sign: float, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", noise(), data=np.stack([sign * np.arange(400) / 1000.0, noise()], axis=1))
    told = told_of('files = "*.mat"\nrate_hz = 1000\ny = "data[:,0]"\n', tmp_path)
    assert told == "1 with samples that only rise or only fall, as times or an angle do and no vibration: a (y)\n"


@pytest.mark.parametrize(
    ("period", "steps", "message"),
    [
        (1500, 0, "a (y after 1500 samples)\n"),
        (3950, 0, ""),  # too few samples are left
        (100, 3, ""),  # of few values
    ],
)
def test_a_buffer_written_twice_comes_in_with_a_warning(
    period: int, steps: int, message: str, mat: Mat, tmp_path: Path
) -> None:
    signal = np.resize(noise(period), 4000)
    mat("a.mat", np.round(signal * steps) if steps else signal)
    told = told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path)
    assert told.endswith(f": {message}" if message else "")
    assert ("comes again exactly" in told) == bool(message)


SLOW = "1 with a shaft slower than 100 rpm, as if `{}` were in Hz: a ({} rpm)\n"


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("speed_hz = 1797", "1 with a shaft faster than 60000 rpm, as if `speed_hz` were in rpm: a (107820 rpm)\n"),
        ("speed_rpm = 107820", "1 with a shaft faster than 60000 rpm: a (107820 rpm)\n"),
        ("speed_hz = 29.95", ""),
        ("speed_rpm = 29.95", SLOW.format("speed_rpm", "29.95")),
        ("nominal_speed_rpm = 29.95", SLOW.format("nominal_speed_rpm", "29.95")),
        ("speed_rpm = 101", ""),
        ("speed_hz = 0.5", ""),
    ],
)
def test_a_speed_that_hardly_any_machine_has_comes_in_with_a_warning(
    setting: str, message: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat", noise(30_000))
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{setting}\n', tmp_path) == message


@pytest.mark.parametrize(
    ("ball", "pitch", "message"),
    [
        (0.3126, 1.537, "1 with a bearing of less than 4 mm pitch diameter, as if in inches: a (1.537 mm)\n"),
        (7.94, 39.04, ""),
    ],
)
def test_a_bearing_stated_in_inches_comes_in_with_a_warning(
    ball: float, pitch: float, message: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    bearing = f"bearing = {{balls = 9, ball_diameter_mm = {ball}, pitch_diameter_mm = {pitch}}}\n"
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{bearing}', tmp_path) == message


@pytest.mark.parametrize(
    ("orders", "message"),
    [
        # A 6203 at 25 Hz: 3.0544 and 4.9456 orders.
        (
            "bpfo = 76.36\nbpfi = 123.64\n",
            "1 with a bearing of more than 60 balls, as if `bpfo` and `bpfi` were in Hz: a (200 balls)\n",
        ),
        ("bpfo = 27.1\nbpfi = 32.9\n", ""),
        (
            "bpfo = 27.1\nbpfi = 33.9\n",
            "1 with a bearing of more than 60 balls, as if `bpfo` and `bpfi` were in Hz: a (61 balls)\n",
        ),
        ("bearing = {balls = 64, ball_diameter_mm = 8, pitch_diameter_mm = 300}\n", ""),
    ],
)
def test_orders_that_may_be_in_hz_come_in_with_a_warning(orders: str, message: str, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{orders}', tmp_path) == message


@pytest.mark.parametrize(
    ("extent_mm", "message"),
    [
        (0, ""),
        (0.007, "1 with a defect shorter than 0.02 mm, as if `extent_mm` were in inches or m: a (0.007 mm)\n"),
        (0.021, ""),
    ],
)
def test_a_defect_shorter_than_anybody_measures_comes_in_with_a_warning(
    extent_mm: float, message: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    bearing = "bearing = {balls = 9, ball_diameter_mm = 7.94, pitch_diameter_mm = 39.04}\n"
    defect = f'location = "outer"\nextent_mm = {extent_mm}\n' if extent_mm else 'location = "none"\n'
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{bearing}{defect}', tmp_path) == message


@pytest.mark.parametrize(
    ("kind", "scale", "message"),
    [
        (np.int16, "", "1 in whole numbers of .wav without `scale`, taken as ±1 g at full scale: a\n"),
        (np.uint8, "", "1 in whole numbers of .wav without `scale`, taken as ±1 g at full scale: a\n"),
        (np.int16, "scale = 1.0\n", ""),
        (np.float32, "", ""),
    ],
)
def test_a_wave_file_whose_full_scale_is_not_stated_comes_in_with_a_warning(
    kind: type, scale: str, message: str, tmp_path: Path
) -> None:
    size, middle = {np.int16: (1000.0, 0.0), np.uint8: (20.0, 128.0), np.float32: (1.0, 0.0)}[kind]
    counts = (middle + size * noise()).astype(kind)
    wavfile.write(tmp_path / "a.wav", 1000, counts)
    assert told_of(f'files = "*.wav"\ny = "data"\n{scale}', tmp_path) == message


TURNS = "the shortest record, a, holds {} turns of the shaft{}\n"


@pytest.mark.parametrize(
    ("speed", "message"),
    [
        ("speed_rpm = 24.5", TURNS.format("0.16", ": is speed_rpm in Hz?")),
        ("nominal_speed_rpm = 24.5", TURNS.format("0.16", ": is nominal_speed_rpm in Hz?")),
        ("speed_rpm = 1400", TURNS.format("9.3", "")),
        ("speed_hz = 4", TURNS.format("1.6", "")),
        ("speed_rpm = 1600", ""),
        ("speed_rpm = 0", ""),
        ("", ""),
    ],
)
def test_a_record_in_which_the_shaft_hardly_turns_comes_in_with_a_warning(
    speed: str, message: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat", noise(400))
    mat("b.mat", noise(500, seed=1))
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{speed}\n', tmp_path) == message


def test_what_killed_imports_of_the_name_left_is_swept_and_nothing_else(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    host = socket.gethostname()
    dead = [tmp_path / f".corpus.{host}.{number}.part" for number in (gone.pid, 10**30)]  # no process has the latter
    others = [
        tmp_path / f".corpus.{host}.{os.getppid()}.part",  # of a process that lives
        tmp_path / f".corpus.elsewhere{host}.{gone.pid}.part",  # of another computer, whose processes are unknown
        tmp_path / f".other.{host}.{gone.pid}.part",
        tmp_path / f".corpus-{host}-{gone.pid}.part",
        tmp_path / f".corpus.{host}.mine.part",
    ]
    for path in (*dead, *others):
        (path / "shards").mkdir(parents=True)
    mat("a.mat")
    bring('[[recording]]\nname = "a"\nfiles = "a.mat"\ny = "sig"\nunit = "g"\nrate_hz = 1000\n')
    assert not any(path.exists() for path in dead)
    assert all(path.is_dir() for path in others)
    assert sorted(tmp_path.glob(".*")) == sorted(others)


def test_what_the_import_of_another_user_fills_is_left(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def forbidden(*_: int) -> None:
        raise PermissionError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(os, "kill", forbidden)
    others = tmp_path / f".corpus.{socket.gethostname()}.{os.getppid()}.part"
    others.mkdir()
    mat("a.mat")
    assert len(bring(SPEC)) == 1
    assert others.is_dir()


def test_what_an_import_of_the_same_number_left_is_in_nobodys_way(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    left = tmp_path / f".corpus.{socket.gethostname()}.{os.getpid()}.part" / "shards"
    left.mkdir(parents=True)
    (left / "shard_000007.nc").write_bytes(b"half")
    mat("a.mat")
    assert len(bring(SPEC)) == 1
    assert not (tmp_path / "corpus" / "shards" / "shard_000007.nc").exists()
    assert not list(tmp_path.glob(".*"))


def test_an_import_fills_the_empty_folder_that_a_link_leads_to(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    (tmp_path / "large disk").mkdir()
    (tmp_path / "corpus").symlink_to(tmp_path / "large disk")
    mat("a.mat")
    assert len(bring(SPEC)) == 1
    assert (tmp_path / "corpus").is_symlink()
    assert (tmp_path / "large disk" / "manifest.json").is_file()


SPEC = '[[recording]]\nname = "a"\nfiles = "a.mat"\ny = "sig"\nunit = "g"\nrate_hz = 1000\n'


def test_a_full_disk_is_told_of_the_folder_that_is_written(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    mat("a.mat")
    monkeypatch.setattr("datagen.corpus_files.shard.write_atomically", full)
    with pytest.raises(BadInput) as problem:
        bring(SPEC)
    assert str(problem.value) == f"{tmp_path / 'corpus'}: --out: cannot write here: No space left on device"
    assert not (tmp_path / "corpus").exists()


def test_a_recording_that_cannot_be_read_again_is_named_and_not_the_folder_that_is_written(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Request] = []

    def read_once(request: Request, _: object = None) -> Iterator[Recorded]:
        asked.append(request)
        if len(asked) > 1:
            raise OSError(errno.EIO, "Input/output error", "a.mat")
        return read_recording(request)

    mat("a.mat")
    for module in ("import_plan", "importing"):
        monkeypatch.setattr(f"datagen.recordings.{module}.read_recording", read_once)
    with pytest.raises(OSError, match=r"Input/output error: 'a\.mat'"):
        bring(SPEC)
    assert len(asked) == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mat", "spec.toml"]


def test_a_recording_that_says_something_else_when_it_is_read_again_is_refused(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read_changed(request: Request, _: object = None) -> Iterator[Recorded]:
        return (replace(record, content="another") for record in read_recording(request))

    mat("a.mat")
    monkeypatch.setattr("datagen.recordings.importing.read_recording", read_changed)
    with pytest.raises(BadInput, match=r"a\.mat: the file changed while it was being imported"):
        bring(SPEC)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mat", "spec.toml"]


def test_a_recording_that_vanishes_before_its_hash_is_taken_is_named(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def vanished(path: Path) -> str:
        path.unlink()
        return file_hash(path)

    mat("a.mat")
    monkeypatch.setattr("datagen.recordings.opened_files.file_hash", vanished)
    with pytest.raises(BadInput) as problem:
        bring(SPEC)
    assert str(problem.value) == f"{tmp_path / 'a.mat'}: cannot be read: No such file or directory"


def test_a_piece_has_the_samples_next_to_its_length(bring: Bring, tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", noise())
    spec = '[[recording]]\nname = "all"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 100\ny = "data"\ncut_s = 0.29\n'
    assert 0.29 * 100 < 29  # in floating point
    assert bring(spec).labels["duration_s"].tolist() == pytest.approx([0.29] * 13)


def test_a_part_begins_and_ends_at_the_samples_next_to_its_times(bring: Bring, tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", noise())
    spec = '[[recording]]\nname = "all"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 100\ny = "data"\n'
    assert 0.29 * 100 < 29 > 0.58 * 100 - 29  # in floating point
    corpus = bring(spec + "from_s = 0.29\nto_s = 0.58\n")
    assert np.array_equal(corpus.signal(0), as_stored(noise()[29:58], G))
    origin = json.loads(corpus.waveform(0, "provenance"))
    assert (origin["first_sample"], origin["samples"]) == (29, 29)
    assert len(bring(spec + "from_s = 0.29\nto_s = 0.45\n", "shortest")) == 1  # of sixteen samples


def test_the_band_of_a_record_is_that_of_its_own_part_and_of_its_y_axis(bring: Bring, tmp_path: Path) -> None:
    quiet = noise(8000)
    high, low = (np.cos(2.0 * np.pi * share * np.arange(4000)) for share in (0.4, 0.1))
    knocks = np.where(np.arange(4000) % 400 < 20, 30.0, 0.0)
    samples = np.stack([quiet, np.roll(quiet, 17)], axis=1)
    samples[:4000, 1] += knocks * low  # y: low in the first half, high in the second; x: the other way round
    samples[4000:, 1] += knocks * high
    samples[:4000, 0] += knocks * high
    samples[4000:, 0] += knocks * low
    np.save(tmp_path / "a.npy", samples)
    spec = (
        '[[recording]]\nname = "all"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 10000\nx = "data[:,0]"\ny = "data[:,1]"\n'
    )
    for part, frequency in (("to_s = 0.4", 1000.0), ("from_s = 0.4", 4000.0)):
        band = bring(f"{spec}{part}\n", part.split()[0]).labels[["envelope_band_low", "envelope_band_high"]]
        low_end, high_end = band.to_numpy()[0]
        assert low_end < frequency < high_end
        assert high_end - low_end < 3000.0


def test_records_of_a_kind_share_a_shard_up_to_its_limit(
    bring: Bring, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    np.save(tmp_path / "a.npy", noise(1000))
    monkeypatch.setattr("datagen.recordings.import_plan.SHARD_BYTES", 1000.0)
    spec = '[[recording]]\nname = "all"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 1000\ny = "data"\ncut_s = 0.1\n'
    corpus = bring(spec)
    sizes = []
    for path in sorted((corpus.folder / "shards").glob("*.nc")):
        with xarray.open_dataset(path) as shard:
            sizes.append(shard.sizes["record"])
    assert sizes == [2] * 5  # two records of 100 samples of four bytes are 800 bytes, three 1200


@pytest.mark.parametrize(("plateau", "doubted"), [(11, False), (12, True)])
def test_a_thousandth_of_the_samples_may_follow_another_at_the_limits(
    plateau: int, doubted: bool, mat: Mat, tmp_path: Path
) -> None:
    signal = noise(10_000)
    signal[500 : 500 + plateau] = 9.0
    mat("a.mat", signal)
    assert ("peaks cut off" in told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path)) == doubted


@pytest.mark.parametrize(("length", "doubted"), [(200, False), (201, True)])
def test_a_hundredth_of_a_long_signal_may_stand_still(length: int, doubted: bool, mat: Mat, tmp_path: Path) -> None:
    signal = noise(20_000)
    signal[500 : 500 + length] = 0.3
    mat("a.mat", signal)
    assert ("stretch of one value" in told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path)) == doubted


def test_files_of_one_name_in_several_folders_have_each_its_hash_in_the_manifest(bring: Bring, mat: Mat) -> None:
    mat("1/a.mat")
    mat("2/a.mat")
    spec = '[[recording]]\nname = "all"\nfiles = "*/a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    hashes = bring(spec + 'recording = "{path}"\n').manifest.recipe["files"]
    assert list(hashes) == ["1/a.mat", "2/a.mat"]
    assert len(set(hashes.values())) == 2


def test_a_shard_is_filled_to_its_limit(bring: Bring, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    np.save(tmp_path / "a.npy", noise(400))
    monkeypatch.setattr("datagen.recordings.import_plan.SHARD_BYTES", 800.0)
    spec = '[[recording]]\nname = "all"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 1000\ny = "data"\ncut_s = 0.1\n'
    assert [entry.records for entry in bring(spec).manifest.shards] == [2, 2]


def test_a_folder_that_somebody_filled_meanwhile_is_refused_and_kept(tmp_path: Path) -> None:
    folder = tmp_path / "corpus"
    with pytest.raises(BadInput, match="--out: cannot write here: Directory not empty"), staged(folder):
        (folder / "mine").mkdir(parents=True)
    assert [*tmp_path.rglob("*")] == [folder, folder / "mine"]


def test_a_folder_that_cannot_be_made_is_refused_by_its_name(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    folder = tmp_path / "file" / "corpus"
    with pytest.raises(BadInput) as refused, staged(folder):
        pytest.fail("was filled")
    assert str(refused.value) == f"{folder}: --out: cannot write here: Not a directory"
