"""Recordings become records: signals, speeds, parts, labels and files."""

from __future__ import annotations

import json
import wave
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray
from imports import Bring, Mat, noise

from datagen.drawing.preview import draw_preview
from datagen.errors import BadInput
from datagen.inspection.check import check_corpus
from datagen.inspection.conformity import violations
from datagen.inspection.info import corpus_info
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
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


def test_a_root_that_is_not_there_is_blamed_on_who_named_it(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    text = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    with pytest.raises(BadInput, match=r'spec\.toml: root = ".*nowhere": no such folder'):
        bring('root = "nowhere"\n' + text)
    with pytest.raises(BadInput, match=r'^--root = "elsewhere": no such folder; allowed: the folder of the recordings'):
        import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "out", "elsewhere")


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
    monkeypatch.setattr("datagen.recordings.import_plan.MOST_SHARD_BYTES", 1000.0)
    spec = '[[recording]]\nname = "all"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 1000\ny = "data"\ncut_s = 0.1\n'
    corpus = bring(spec)
    sizes = []
    for path in sorted((corpus.folder / "shards").glob("*.nc")):
        with xarray.open_dataset(path) as shard:
            sizes.append(shard.sizes["record"])
    assert sizes == [2] * 5  # two records of 100 samples of four bytes are 800 bytes, three 1200


def test_files_of_one_name_in_several_folders_have_each_its_hash_in_the_manifest(bring: Bring, mat: Mat) -> None:
    mat("1/a.mat")
    mat("2/a.mat")
    spec = '[[recording]]\nname = "all"\nfiles = "*/a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    hashes = bring(spec + 'recording = "{path}"\n').manifest.recipe["files"]
    assert list(hashes) == ["1/a.mat", "2/a.mat"]
    assert len(set(hashes.values())) == 2


def test_a_shard_is_filled_to_its_limit(bring: Bring, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    np.save(tmp_path / "a.npy", noise(400))
    monkeypatch.setattr("datagen.recordings.import_plan.MOST_SHARD_BYTES", 800.0)
    spec = '[[recording]]\nname = "all"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 1000\ny = "data"\ncut_s = 0.1\n'
    assert [entry.records for entry in bring(spec).manifest.shards] == [2, 2]
